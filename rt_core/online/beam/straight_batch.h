#pragma once
#include "online/beam/straight_nodes.h"
#include "online/beam/straight_point.h"

namespace RAILSTEP_KERNELS::straight {

// Elements of a row side by side in the lanes, spatial or planar.

static_assert(kStraightLanes % kWide == 0);

/// Elements from `first` on as lanes; lanes after the last element repeat it.
struct Group {
  int first, count;  // of the batch
  int element(int lane) const noexcept { return first + lane < count ? first + lane : count - 1; }
};

/// Where part `part` of N numbers begins, kWide numbers in each. The last part begins early enough
/// to end with the last number, and so repeats some of the part before.
template <int N>
constexpr int part_first(int part) noexcept {
  return kWide * (part + 1) <= N ? kWide * part : N - kWide;
}
template <int N>
inline constexpr int kParts = (N + kWide - 1) / kWide;

/// Even and odd part of V.
template <class Kind>
struct LaneVectors {
  Wide even[kComponentsOf<Kind>], odd[kComponentsOf<Kind>];

  [[gnu::always_inline]] void set(const StraightBeam& beam, const Group& group,
                                  const double* q) noexcept {
    constexpr int W = Kind::kUnknowns;
    Wide nodes[3 * W];
    unrolled<kParts<3 * W>>([&](auto part) __attribute__((always_inline)) {
      constexpr int c = part_first<3 * W>(part);
      unrolled<kWide>([&](auto l) __attribute__((always_inline)) {
        nodes[c + l] = load(q + 2 * W * group.element(l) + c);
      });
      transpose(nodes + c);
    });
    split<Kind>(beam.per_length, nodes, nodes + W, nodes + 2 * W, even, odd);
  }
  /// V at +g or -g.
  [[gnu::always_inline]] void point(bool plus, Wide* V) const noexcept {
    for (int c = 0; c < kComponentsOf<Kind>; ++c) V[c] = plus ? even[c] + odd[c] : even[c] - odd[c];
  }
};

/// V of the nodes, and of half their change.
template <class Kind, bool kHalf>
struct LaneMotion {
  LaneVectors<Kind> of[kHalf ? 2 : 1];

  [[gnu::always_inline]] LaneMotion(const StraightBeam& beam, const Group& group, const double* q,
                                    const double* half_change) noexcept {
    of[0].set(beam, group, q);
    if constexpr (kHalf) of[1].set(beam, group, half_change);
  }
  /// V and the stress at a point.
  [[gnu::always_inline]] void point(const StraightBeam& beam, bool plus, Wide* V,
                                    Wide* stress) const noexcept {
    Wide s[kProducts];
    of[0].point(plus, V);
    strains<Kind>(V, s);
    if constexpr (kHalf) {
      Wide D[kComponentsOf<Kind>];
      of[1].point(plus, D);
      add_products<Kind>(D, s);
    }
    stresses<Kind>(beam, s, stress);
  }
};

/// x, y become x + y, x - y.
template <int N>
[[gnu::always_inline]] inline void sum_difference(Wide* x, Wide* y) noexcept {
  for (int c = 0; c < N; ++c) {
    const Wide difference = x[c] - y[c];
    x[c] += y[c];
    y[c] = difference;
  }
}

/// Adds the points' forces to the nodes, element after element; a node's first element sets it.
/// @param F  at +g and -g, overwritten
template <class Kind>
[[gnu::always_inline]] inline void add_lanes(const StraightBeam& beam, const Group& group, Wide* F,
                                             Wide* F_minus, double* force) noexcept {
  constexpr int W = Kind::kUnknowns;
  Wide nodes[3 * W];
  sum_difference<kComponentsOf<Kind>>(F, F_minus);
  gather<Kind>(beam.per_length, F, F_minus, nodes, nodes + W, nodes + 2 * W);
  double of[kWide][3 * W];
  unrolled<kParts<3 * W>>([&](auto part) __attribute__((always_inline)) {
    constexpr int c = part_first<3 * W>(part);
    Wide transposed[kWide];
    unrolled<kWide>([&](auto i) __attribute__((always_inline)) { transposed[i] = nodes[c + i]; });
    transpose(transposed);
    unrolled<kWide>([&](auto l)
                        __attribute__((always_inline)) { store(transposed[l], of[l] + c); });
  });
  for (int l = 0; l < kWide && group.first + l < group.count; ++l) {
    double* at = force + 2 * W * (group.first + l);
    if (group.first + l > 0)
      for (int c = 0; c < W; ++c) at[c] += of[l][c];
    else
      for (int c = 0; c < W; ++c) at[c] = of[l][c];
    for (int c = W; c < 3 * W; ++c) at[c] = of[l][c];
  }
}

template <class Kind, bool kHalf>
void group_forces(const StraightBeam& beam, const Group& group, const double* q,
                  const double* half_change, double* force) noexcept {
  constexpr int components = kComponentsOf<Kind>;
  const LaneMotion<Kind, kHalf> motion(beam, group, q, half_change);
  Wide F[2][components];
  for (int point = 0; point < 2; ++point) {
    Wide V[components], stress[kProducts];
    motion.point(beam, point == 0, V, stress);
    vector_forces<Kind>(stress, V, F[point]);
  }
  add_lanes<Kind>(beam, group, F[0], F[1], force);
}

/// Forces on V and its tangent at one point.
template <class Kind, bool kHalf>
void group_point(const StraightBeam& beam, const LaneMotion<Kind, kHalf>& motion, bool plus,
                 Wide* F, Wide* K) noexcept {
  Wide V[kComponentsOf<Kind>], stress[kProducts];
  motion.point(beam, plus, V, stress);
  vector_forces<Kind>(stress, V, F);
  vector_tangent<Kind>(beam, stress, V, K);
}

/// Adds the transposes that the upper triangle needs.
template <class Kind>
[[gnu::always_inline]] inline void add_transposes(Wide* matrices) noexcept {
  unrolled<kUpperMatrices - kProducts>([&](auto k) __attribute__((always_inline)) {
    constexpr int matrix = kProducts + k;
    constexpr int rows = matrix_rows_of<Kind>(matrix), columns = matrix_columns_of<Kind>(matrix);
    const Wide* from = matrices + matrix_first<Kind>(kTransposeOf[k]);
    for (int c = 0; c < rows * columns; ++c)
      matrices[matrix_first<Kind>(matrix) + c] = from[rows * (c % columns) + c / columns];
  });
}

/// @param out  the group's tangents, from the first of these lanes on
template <class Kind, int kPair>
void set_lane_fields(const Coefficients& k, const Wide* even, const Wide* odd,
                     double* out) noexcept {
  constexpr int W = Kind::kUnknowns, f = kFieldPair[kPair].row, g = kFieldPair[kPair].column;
  constexpr int rows = Kind::kSize[f], columns = Kind::kSize[g];
  const auto set = [out](int m, int n, int i, int j, const Wide& entry) {
    const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
    __builtin_memcpy(out + ((W * pair + i) * W + j) * kStraightLanes, &entry, sizeof entry);
  };
  for (int c = 0; c < rows * columns; ++c) {
    const int i = c / columns, j = c % columns;
    const int row = field_first<Kind>(f) + i, column = field_first<Kind>(g) + j;
    const auto entry = [c](int matrix) __attribute__((always_inline)) {
      return matrix_first<Kind>(matrix) + c;
    };
    const NodePairs<Wide> K = node_pairs<kPair>(k, even, odd, entry);
    unrolled<9>([&](auto nodes) __attribute__((always_inline)) {
      constexpr int m = nodes / 3, n = nodes % 3;
      if constexpr (f == g && n < m) return;
      if (f == g && m == n && i > j) return;
      if constexpr (m <= n) set(m, n, row, column, K.of[m][n]);
      if constexpr (m >= n)
        if (f != g || i != j) set(n, m, column, row, K.of[m][n]);
    });
  }
}

template <class Kind, bool kHalf>
void group_tangents(const StraightBeam& beam, const Group& group, const double* q,
                    const double* half_change, double* force, double* out) noexcept {
  const LaneMotion<Kind, kHalf> motion(beam, group, q, half_change);
  Wide F[2][kComponentsOf<Kind>], K[2][matrix_first<Kind>(kUpperMatrices)];
  for (int point = 0; point < 2; ++point) group_point(beam, motion, point == 0, F[point], K[point]);
  add_lanes<Kind>(beam, group, F[0], F[1], force);

  sum_difference<matrix_first<Kind>(kProducts)>(K[0], K[1]);
  for (Wide* part : K) add_transposes<Kind>(part);
  const Coefficients k = coefficients(beam.per_length);
  unrolled<kUpperPairs>([&](auto pair) { set_lane_fields<Kind, pair>(k, K[0], K[1], out); });
}

template <class Kind, bool kHalf>
void all_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                double* force) noexcept {
  for (int first = 0; first < n; first += kWide)
    group_forces<Kind, kHalf>(beam, {first, n}, q, half_change, force);
}

template <class Kind, bool kHalf>
void all_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                  double* force, double* tangent) noexcept {
  constexpr long group = kStraightPairs * Kind::kUnknowns * Kind::kUnknowns * kStraightLanes;
  for (int first = 0; first < kStraightLanes * straight_groups(n); first += kWide)
    group_tangents<Kind, kHalf>(
        beam, {first, n}, q, half_change, force,
        tangent + (first / kStraightLanes) * group + first % kStraightLanes);
}

/// straight_forces() of a kind.
template <class Kind>
void batch_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                  double* force) noexcept {
  if (half_change != nullptr)
    all_forces<Kind, true>(beam, n, q, half_change, force);
  else
    all_forces<Kind, false>(beam, n, q, half_change, force);
}

/// straight_tangents() of a kind.
template <class Kind>
void batch_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                    double* force, double* tangent) noexcept {
  if (half_change != nullptr)
    all_tangents<Kind, true>(beam, n, q, half_change, force, tangent);
  else
    all_tangents<Kind, false>(beam, n, q, half_change, force, tangent);
}

}  // namespace RAILSTEP_KERNELS::straight
