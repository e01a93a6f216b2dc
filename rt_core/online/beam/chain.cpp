#include "online/beam/chain.h"

#include "online/beam/chain_ends.h"
#include "online/beam/chain_mids.h"

namespace RAILSTEP_KERNELS {

namespace {

using namespace chained;

/// Adds the mass to the blocks of a group's tangents.
/// @param mass_factor  over that of K
template <int W>
void add_mass(const Chain& chain, double mass_factor, double* S) noexcept {
  using At = Layout<W>;
  constexpr int b = W == 9 ? 6 : 3, position = W == 9 ? 3 : 2;
  const double scale = mass_factor / (30. * chain.beam.per_length);
  const auto add = [S](int pair, int i, int j, double m) {
    for (int lane = 0; lane < kStraightLanes; lane += kWide) {
      double* at = S + At::tangent(pair, i, j) + lane;
      store(load(at) + m, at);
    }
  };
  for (int m = 0; m < 3; ++m)
    for (int n = m; n < 3; ++n) {
      const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
      const double P = scale * kMassPairs[m][n];
      const double of[4] = {P * chain.mass[0], P * chain.mass[1], P * chain.mass[2],
                            P * chain.mass[3]};
      for (int i = 0; i < W; ++i) add(pair, i, i, of[field_of<W>(i)]);
      for (int i = 0; i < position; ++i) {
        add(pair, i, b + i, of[3]);
        add(pair, b + i, i, of[3]);
      }
    }
}

/// Row and column of an unknown of an element's node become those of the identity.
template <int W>
void fix(double* S, int node, int unknown) noexcept {
  using At = Layout<W>;
  for (int other = 0; other < 3; ++other) {
    const int m = node < other ? node : other, n = node < other ? other : node;
    const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
    for (int j = 0; j < W; ++j) {
      if (node <= other) S[At::tangent(pair, unknown, j)] = 0.;
      if (node >= other) S[At::tangent(pair, j, unknown)] = 0.;
    }
    if (node == other) S[At::tangent(pair, unknown, unknown)] = 1.;
  }
}

template <int W>
void fix_all(const Chain& chain, double* S) noexcept {
  const auto in_element = [&](int element, int node, int unknown) {
    if (element < 0 || element >= chain.elements) return;
    fix<W>(S + element / kStraightLanes * Layout<W>::kTangents + element % kStraightLanes, node,
           unknown);
  };
  for (int h = 0; h < chain.held_count; ++h) {
    const int node = chain.held[h] / W, unknown = chain.held[h] % W;
    in_element(node / 2, node % 2, unknown);
    if (node % 2 == 0) in_element(node / 2 - 1, 2, unknown);
  }
}

}  // namespace

template <int W>
void chain_inertia(const Chain& chain, const double* g, double* force) noexcept {
  constexpr int b = W == 9 ? 6 : 3, position = W == 9 ? 3 : 2;
  const double scale = 1. / (30. * chain.beam.per_length);
  double mass[W];
  for (int i = 0; i < W; ++i) mass[i] = chain.mass[field_of<W>(i)];
  for (int e = 0; e < chain.elements; ++e) {
    double Q[3][W];
    for (int n = 0; n < 3; ++n) {
      const double* at = g + (2 * e + n) * W;
#pragma omp simd
      for (int i = 0; i < W; ++i) Q[n][i] = mass[i] * at[i];
      if (chain.mass[3] == 0.) continue;  // the axis is through the centroids
      for (int i = 0; i < position; ++i) {
        Q[n][i] += chain.mass[3] * at[b + i];
        Q[n][b + i] += chain.mass[3] * at[i];
      }
    }
    for (int m = 0; m < 3; ++m) {
      double* to = force + (2 * e + m) * W;
#pragma omp simd
      for (int i = 0; i < W; ++i)
        to[i] += scale * ((kMassPairs[m][0] * Q[0][i] + kMassPairs[m][1] * Q[1][i]) +
                          kMassPairs[m][2] * Q[2][i]);
    }
  }
}

template <int W>
int chain_factor(const Chain& chain, double mass_factor, double k_factor, double* tangents,
                 double* factor) noexcept {
  using At = Layout<W>;
  const int groups = straight_groups(chain.elements);
  // S / k_factor is factored, and 1 / D divided by k_factor: no entry of K is touched for it.
  const double k = k_factor == 0. ? 1. : k_factor, inverse_k = 1. / k;
  if (k_factor == 0.)
    for (long i = 0; i < groups * At::kTangents; ++i) tangents[i] = 0.;
  for (int group = 0; group < groups; ++group)
    add_mass<W>(chain, mass_factor * inverse_k, tangents + group * At::kTangents);
  fix_all<W>(chain, tangents);

  double* nodes = factor + At::nodes(chain.elements);
  EndNodes<W> ends(nodes, inverse_k);
  int bad = 0;
  for (int group = 0; group < groups; ++group) {
    const int first = kStraightLanes * group, left = chain.elements - first;
    const int count = left < kStraightLanes ? left : kStraightLanes;
    double* S = tangents + group * At::kTangents;
    bad += condense_group<W>(count, inverse_k, S, factor + group * At::kMids);
    add_condensed<W>(first, count, S, nodes);
    for (int e = first; e < first + count; ++e) bad += ends.eliminate(e);
  }
  return bad + ends.eliminate_last(chain.elements);
}

template void chain_inertia<9>(const Chain&, const double*, double*) noexcept;
template void chain_inertia<5>(const Chain&, const double*, double*) noexcept;
template int chain_factor<9>(const Chain&, double, double, double*, double*) noexcept;
template int chain_factor<5>(const Chain&, double, double, double*, double*) noexcept;

}  // namespace RAILSTEP_KERNELS
