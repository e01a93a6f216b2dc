#include "online/beam/chain.h"

#include "online/beam/chain_ends.h"
#include "online/beam/chain_mids.h"

namespace railstep {

namespace {

using namespace chained;

/// Blocks of S = k K + m M in the place of the tangents of a group, before what is held.
template <int W>
void add_mass(const Chain& chain, double mass_factor, double k_factor, double* S) noexcept {
  using At = Layout<W>;
  if (k_factor == 0.)
    for (long i = 0; i < At::kTangents; ++i) S[i] = 0.;
  else if (k_factor != 1.)
    for (long i = 0; i < At::kTangents; ++i) S[i] *= k_factor;
  const double scale = mass_factor / (30. * chain.beam.per_length);
  const double of_field[3] = {chain.mass[0], chain.mass[1], chain.mass[2]};
  const auto add = [S](int pair, int i, int j, double m) {
    for (int lane = 0; lane < kStraightLanes; ++lane) S[At::tangent(pair, i, j) + lane] += m;
  };
  constexpr int b = W == 9 ? 6 : 3, position = W == 9 ? 3 : 2;
  for (int m = 0; m < 3; ++m)
    for (int n = m; n < 3; ++n) {
      const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
      const double P = scale * kMassPairs[m][n];
      for (int i = 0; i < W; ++i) add(pair, i, i, P * of_field[field_of<W>(i)]);
      for (int i = 0; i < position; ++i) {
        add(pair, i, b + i, P * chain.mass[3]);
        add(pair, b + i, i, P * chain.mass[3]);
      }
    }
}

/// Row and column of an unknown of an element's node become those of the identity.
template <int W>
void hold(double* S, int node, int unknown) noexcept {
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
void hold_all(const Chain& chain, double* S) noexcept {
  const auto in_element = [&](int element, int node, int unknown) {
    if (element < 0 || element >= chain.elements) return;
    hold<W>(S + element / kStraightLanes * Layout<W>::kTangents + element % kStraightLanes, node,
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
  for (int e = 0; e < chain.elements; ++e) {
    double Q[3][W];
    for (int n = 0; n < 3; ++n) {
      const double* at = g + (2 * e + n) * W;
      for (int i = 0; i < W; ++i) Q[n][i] = chain.mass[field_of<W>(i)] * at[i];
      for (int i = 0; i < position; ++i) {
        Q[n][i] += chain.mass[3] * at[b + i];
        Q[n][b + i] += chain.mass[3] * at[i];
      }
    }
    for (int m = 0; m < 3; ++m)
      for (int i = 0; i < W; ++i)
        force[(2 * e + m) * W + i] +=
            scale * ((kMassPairs[m][0] * Q[0][i] + kMassPairs[m][1] * Q[1][i]) +
                     kMassPairs[m][2] * Q[2][i]);
  }
}

template <int W>
int chain_factor(const Chain& chain, double mass_factor, double k_factor, double* tangents,
                 double* factor) noexcept {
  using At = Layout<W>;
  const int groups = straight_groups(chain.elements);
  double* nodes = factor + At::nodes(chain.elements);
  for (int group = 0; group < groups; ++group)
    add_mass<W>(chain, mass_factor, k_factor, tangents + group * At::kTangents);
  hold_all<W>(chain, tangents);
  for (long i = 0; i < At::kNode; ++i) nodes[i] = 0.;
  int bad = 0;
  for (int group = 0; group < groups; ++group) {
    const int first = kStraightLanes * group, left = chain.elements - first;
    const int count = left < kStraightLanes ? left : kStraightLanes;
    double* S = tangents + group * At::kTangents;
    bad += condense_group<W>(count, S, factor + group * At::kMids);
    add_condensed<W>(first, count, S, nodes);
    for (int e = first; e < first + count; ++e)
      bad += eliminate_node<W>(nodes + e * At::kNode, nodes + (e + 1) * At::kNode);
  }
  return bad + eliminate_node<W>(nodes + chain.elements * At::kNode, nullptr);
}

namespace {

/// Rows [L' (own columns), next blocks of W columns] of a node.
/// @param stride  doubles from one column to the next
template <int W, int kNext, int kSides>
void forward(const double* L, int row, int stride, double* x, double* const* next) noexcept {
  double y[W][kSides];
  for (int k = 0; k < W; ++k)
    for (int s = 0; s < kSides; ++s) {
      y[k][s] = x[kSides * k + s];
      for (int j = 0; j < k; ++j) y[k][s] -= L[j * row + k * stride] * y[j][s];
    }
  for (int block = 0; block < kNext; ++block)
    for (int i = 0; i < W; ++i)
      for (int s = 0; s < kSides; ++s)
        for (int k = 0; k < W; ++k)
          next[block][kSides * i + s] -= L[k * row + (W * (block + 1) + i) * stride] * y[k][s];
  for (int k = 0; k < W; ++k)
    for (int s = 0; s < kSides; ++s) x[kSides * k + s] = y[k][s] * L[k * row + k * stride];
}

template <int W, int kNext, int kSides>
void backward(const double* L, int row, int stride, double* x, double* const* next) noexcept {
  for (int k = W - 1; k >= 0; --k)
    for (int s = 0; s < kSides; ++s) {
      double sum = x[kSides * k + s];
      for (int block = 0; block < kNext; ++block)
        for (int i = 0; i < W; ++i)
          sum -= L[k * row + (W * (block + 1) + i) * stride] * next[block][kSides * i + s];
      for (int j = k + 1; j < W; ++j) sum -= L[k * row + j * stride] * x[kSides * j + s];
      x[kSides * k + s] = sum;
    }
}

template <int W, int kSides>
void solve(const Chain& chain, const double* factor, double* x) noexcept {
  using At = Layout<W>;
  constexpr long step = long{W} * kSides;
  const double* nodes = factor + At::nodes(chain.elements);
  const auto mid = [factor](int e) {
    return factor + e / kStraightLanes * At::kMids + e % kStraightLanes;
  };
  for (int h = 0; h < chain.held_count; ++h)
    for (int s = 0; s < kSides; ++s) x[long{kSides} * chain.held[h] + s] = 0.;
  for (int e = 0; e < chain.elements; ++e) {
    double* first = x + 2 * e * step;
    double* ends[2] = {first, first + 2 * step};
    forward<W, 2, kSides>(mid(e), 3 * W * kStraightLanes, kStraightLanes, first + step, ends);
    forward<W, 1, kSides>(nodes + e * At::kNode, At::kRow, 1, first, ends + 1);
  }
  double* last = x + 2 * chain.elements * step;
  forward<W, 0, kSides>(nodes + chain.elements * At::kNode, At::kRow, 1, last, nullptr);
  backward<W, 0, kSides>(nodes + chain.elements * At::kNode, At::kRow, 1, last, nullptr);
  for (int e = chain.elements - 1; e >= 0; --e) {
    double* first = x + 2 * e * step;
    double* ends[2] = {first, first + 2 * step};
    backward<W, 1, kSides>(nodes + e * At::kNode, At::kRow, 1, first, ends + 1);
    backward<W, 2, kSides>(mid(e), 3 * W * kStraightLanes, kStraightLanes, first + step, ends);
  }
}

}  // namespace

template <int W>
void chain_solve(const Chain& chain, const double* factor, double* x) noexcept {
  solve<W, kChainSides>(chain, factor, x);
}

template <int W>
void chain_solve_one(const Chain& chain, const double* factor, double* x) noexcept {
  solve<W, 1>(chain, factor, x);
}

template void chain_inertia<9>(const Chain&, const double*, double*) noexcept;
template void chain_inertia<5>(const Chain&, const double*, double*) noexcept;
template int chain_factor<9>(const Chain&, double, double, double*, double*) noexcept;
template int chain_factor<5>(const Chain&, double, double, double*, double*) noexcept;
template void chain_solve<9>(const Chain&, const double*, double*) noexcept;
template void chain_solve<5>(const Chain&, const double*, double*) noexcept;
template void chain_solve_one<9>(const Chain&, const double*, double*) noexcept;
template void chain_solve_one<5>(const Chain&, const double*, double*) noexcept;

}  // namespace railstep
