#include "online/beam/straight.h"

#include "online/beam/straight_nodes.h"
#include "online/beam/straight_point.h"

namespace railstep {

namespace {

using namespace straight;

// Vectors of the compiler's own, for speed alone: each lane is rounded as a double by itself.
using Two = double __attribute__((vector_size(16)));
#ifdef __AVX__
using Wide = double __attribute__((vector_size(32)));
#else
using Wide = Two;
#endif
constexpr int kWide = static_cast<int>(sizeof(Wide) / sizeof(double));
static_assert(kStraightLanes % kWide == 0);

constexpr int kEntries = 9 * kProducts;  // of V's tangent, in [3][3] blocks

/// V at both points as the two lanes.
[[gnu::always_inline]] inline void point_vectors(const StraightBeam& beam, const double* q,
                                                 Two* V) noexcept {
  double even[kComponents], odd[kComponents];
  split(beam.per_length, q, q + 9, q + 18, even, odd);
  for (int c = 0; c < kComponents; ++c) V[c] = Two{even[c] + odd[c], even[c] - odd[c]};
}

/// Sum and difference of the two lanes.
template <int N>
[[gnu::always_inline]] inline void even_odd(const Two* points, double* even, double* odd) noexcept {
  for (int c = 0; c < N; ++c) {
    even[c] = points[c][0] + points[c][1];
    odd[c] = points[c][0] - points[c][1];
  }
}

[[gnu::always_inline]] inline void nodal_force(const StraightBeam& beam, const Two* stress,
                                               const Two* V, double* force) noexcept {
  Two F[kComponents];
  vector_forces(stress, V, F);
  double even[kComponents], odd[kComponents];
  even_odd<kComponents>(F, even, odd);
  gather(beam.per_length, even, odd, force, force + 9, force + 18);
}

/// A row of [3][3], a fourth column of 0 beside it, as one or two T.
constexpr int kRow = 4 / kWide;
template <class T>
[[gnu::always_inline]] inline void set_row(double x, double y, double z, T* row) noexcept {
  if constexpr (kRow == 1) {
    row[0] = T{x, y, z, 0.};
  } else {
    row[0] = T{x, y};
    row[1] = T{z, 0.};
  }
}

/// Rows of the sum and the difference of the lanes of [3][3] blocks, and of the transposes.
/// @param even, odd  [kMatrices][3][kRow]
[[gnu::always_inline]] inline void matrix_rows(const Two* K, Wide* even, Wide* odd) noexcept {
  const auto set = [=](int row, const Two& x, const Two& y, const Two& z) {
    Wide plus[kRow], minus[kRow];
    set_row(x[0], y[0], z[0], plus);
    set_row(x[1], y[1], z[1], minus);
    for (int part = 0; part < kRow; ++part) {
      even[kRow * row + part] = plus[part] + minus[part];
      odd[kRow * row + part] = plus[part] - minus[part];
    }
  };
  for (int i = 0; i < 3 * kProducts; ++i) set(i, K[3 * i], K[3 * i + 1], K[3 * i + 2]);
  for (int k = kProducts; k < kMatrices; ++k) {
    const Two* of = K + 9 * kTransposeOf[k - kProducts];
    for (int i = 0; i < 3; ++i) set(3 * k + i, of[i], of[i + 3], of[i + 6]);
  }
}

/// The blocks of two fields, row by row. A row of four doubles spills one into the next column,
/// which is set later: fields come in the order r, a, b, and b's rows end after three.
template <int kPair>
[[gnu::always_inline]] inline void set_fields(const Coefficients& k, const Wide* even,
                                              const Wide* odd, double* tangent) noexcept {
  constexpr int f = kFieldPair[kPair].row, g = kFieldPair[kPair].column;
  for (int i = 0; i < 3; ++i)
    unrolled<kRow>([&](auto part) __attribute__((always_inline)) {
      constexpr int columns = g < 2 || part < kRow - 1 ? kWide : kWide - 1;
      double* at = tangent + kBeamUnknowns * (3 * f + i) + 3 * g + kWide * part;
      const NodePairs<Wide> K = node_pairs<kPair, 3 * kRow>(k, even, odd, kRow * i + part);
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n)
          __builtin_memcpy(at + kBeamUnknowns * 9 * m + 9 * n, &K.of[m][n],
                           columns * sizeof(double));
    });
}

/// Elements `first` and on as lanes; after the last one, the last again.
struct Group {
  int first, count;  // of the batch
  int element(int lane) const noexcept { return first + lane < count ? first + lane : count - 1; }
};

/// Even and odd part of V, [15] each.
[[gnu::always_inline]] inline void lane_vectors(const StraightBeam& beam, const Group& group,
                                                const double* q, Wide* even, Wide* odd) noexcept {
  Wide nodes[kBeamUnknowns];
  for (int l = 0; l < kWide; ++l)
    for (int c = 0; c < kBeamUnknowns; ++c) nodes[c][l] = q[18 * group.element(l) + c];
  split(beam.per_length, nodes, nodes + 9, nodes + 18, even, odd);
}

/// Adds the lanes to the nodes, element after element; a node's first element sets it.
[[gnu::always_inline]] inline void add_lanes(const Group& group, const Wide* element,
                                             double* force) noexcept {
  for (int l = 0; l < kWide && group.first + l < group.count; ++l) {
    double* at = force + 18 * (group.first + l);
    for (int c = 0; c < 9; ++c)
      at[c] = group.first + l == 0 ? element[c][l] : at[c] + element[c][l];
    for (int c = 9; c < kBeamUnknowns; ++c) at[c] = element[c][l];
  }
}

/// V at +g (sign 1) or -g.
[[gnu::always_inline]] inline void lane_point(const Wide* even, const Wide* odd, bool plus,
                                              Wide* V) noexcept {
  for (int c = 0; c < kComponents; ++c) V[c] = plus ? even[c] + odd[c] : even[c] - odd[c];
}

/// x, y become x + y, x - y.
template <int N>
[[gnu::always_inline]] inline void sum_difference(Wide* x, Wide* y) noexcept {
  for (int c = 0; c < N; ++c) {
    const Wide difference = x[c] - y[c];
    x[c] += y[c];
    y[c] = difference;
  }
}

void group_forces(const StraightBeam& beam, const Group& group, const double* q,
                  double* force) noexcept {
  Wide even[kComponents], odd[kComponents], F[2][kComponents], nodes[kBeamUnknowns];
  lane_vectors(beam, group, q, even, odd);
  for (int point = 0; point < 2; ++point) {
    Wide V[kComponents], s[kProducts], stress[kProducts];
    lane_point(even, odd, point == 0, V);
    strains(V, s);
    stresses(beam, s, stress);
    vector_forces(stress, V, F[point]);
  }
  sum_difference<kComponents>(F[0], F[1]);
  gather(beam.per_length, F[0], F[1], nodes, nodes + 9, nodes + 18);
  add_lanes(group, nodes, force);
}

/// Forces on V and its tangent at one point.
void group_point(const StraightBeam& beam, const Wide* even, const Wide* odd, bool plus, Wide* F,
                 Wide* K) noexcept {
  Wide V[kComponents], s[kProducts], stress[kProducts];
  lane_point(even, odd, plus, V);
  strains(V, s);
  stresses(beam, s, stress);
  vector_forces(stress, V, F);
  vector_tangent(beam, stress, V, K);
}

/// Adds the transposes that the upper triangle needs.
[[gnu::always_inline]] inline void add_transposes(Wide* matrices) noexcept {
  for (int k = kProducts; k < kUpperMatrices; ++k)
    for (int c = 0; c < 9; ++c)
      matrices[9 * k + c] = matrices[9 * kTransposeOf[k - kProducts] + 3 * (c % 3) + c / 3];
}

/// @param out  the group's tangents, from the first of these lanes on
template <int kPair>
void set_lane_fields(const Coefficients& k, const Wide* even, const Wide* odd,
                     double* out) noexcept {
  constexpr int f = kFieldPair[kPair].row, g = kFieldPair[kPair].column;
  const auto set = [out](int m, int n, int i, int j, const Wide& entry) {
    const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
    __builtin_memcpy(out + ((9 * pair + i) * 9 + j) * kStraightLanes, &entry, sizeof entry);
  };
  for (int c = 0; c < 9; ++c) {
    const int i = c / 3, j = c % 3, row = 3 * f + i, column = 3 * g + j;
    const NodePairs<Wide> K = node_pairs<kPair, 9>(k, even, odd, c);
    for (int m = 0; m < 3; ++m)
      for (int n = f == g ? m : 0; n < 3; ++n) {
        if (f == g && m == n && i > j) continue;
        if (m <= n) set(m, n, row, column, K.of[m][n]);
        if (m >= n && (f != g || i != j)) set(n, m, column, row, K.of[m][n]);
      }
  }
}

void group_tangents(const StraightBeam& beam, const Group& group, const double* q, double* force,
                    double* out) noexcept {
  Wide even[kComponents], odd[kComponents], F[2][kComponents], nodes[kBeamUnknowns];
  Wide K[2][9 * kUpperMatrices];
  lane_vectors(beam, group, q, even, odd);
  for (int point = 0; point < 2; ++point)
    group_point(beam, even, odd, point == 0, F[point], K[point]);
  sum_difference<kComponents>(F[0], F[1]);
  gather(beam.per_length, F[0], F[1], nodes, nodes + 9, nodes + 18);
  add_lanes(group, nodes, force);

  sum_difference<kEntries>(K[0], K[1]);
  for (Wide* part : K) add_transposes(part);
  const Coefficients k = coefficients(beam.per_length);
  unrolled<kUpperPairs>([&](auto pair) { set_lane_fields<pair>(k, K[0], K[1], out); });
}

}  // namespace

void straight_force(const StraightBeam& beam, const double* q, double* force) noexcept {
  Two V[kComponents], s[kProducts], stress[kProducts];
  point_vectors(beam, q, V);
  strains(V, s);
  stresses(beam, s, stress);
  nodal_force(beam, stress, V, force);
}

void straight_tangent(const StraightBeam& beam, const double* q, double* force,
                      double* tangent) noexcept {
  Two V[kComponents], s[kProducts], stress[kProducts], K[kEntries];
  point_vectors(beam, q, V);
  strains(V, s);
  stresses(beam, s, stress);
  nodal_force(beam, stress, V, force);
  vector_tangent(beam, stress, V, K);

  Wide even[3 * kRow * kMatrices], odd[3 * kRow * kMatrices];
  matrix_rows(K, even, odd);
  const Coefficients k = coefficients(beam.per_length);
  set_fields<0>(k, even, odd, tangent);  // columns of r
  set_fields<6>(k, even, odd, tangent);
  set_fields<7>(k, even, odd, tangent);
  set_fields<1>(k, even, odd, tangent);  // of a
  set_fields<3>(k, even, odd, tangent);
  set_fields<8>(k, even, odd, tangent);
  set_fields<2>(k, even, odd, tangent);  // of b
  set_fields<4>(k, even, odd, tangent);
  set_fields<5>(k, even, odd, tangent);
}

void straight_forces(const StraightBeam& beam, int n, const double* q, double* force) noexcept {
  for (int first = 0; first < n; first += kWide) group_forces(beam, {first, n}, q, force);
}

void straight_tangents(const StraightBeam& beam, int n, const double* q, double* force,
                       double* tangent) noexcept {
  for (int first = 0; first < kStraightLanes * straight_groups(n); first += kWide)
    group_tangents(beam, {first, n}, q, force,
                   tangent + static_cast<long>(first / kStraightLanes) * kStraightGroup +
                       first % kStraightLanes);
}

}  // namespace railstep
