#include "online/beam/straight.h"

#include "online/beam/straight_nodes.h"

namespace railstep {

namespace {

using namespace straight;

constexpr int kComponents = kComponentsOf<Spatial>;
constexpr int kEntries = 9 * kProducts;  // of V's tangent, in [3][3] blocks

/// V at both points as the two lanes.
[[gnu::always_inline]] inline void point_vectors(const StraightBeam& beam, const double* q,
                                                 Two* V) noexcept {
  double even[kComponents], odd[kComponents];
  split<Spatial>(beam.per_length, q, q + 9, q + 18, even, odd);
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
  vector_forces<Spatial>(stress, V, F);
  double even[kComponents], odd[kComponents];
  even_odd<kComponents>(F, even, odd);
  gather<Spatial>(beam.per_length, even, odd, force, force + 9, force + 18);
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
      const auto row = [=](int matrix) __attribute__((always_inline)) {
        return kRow * (3 * matrix + i) + part;
      };
      const NodePairs<Wide> K = node_pairs<kPair>(k, even, odd, row);
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n)
          __builtin_memcpy(at + kBeamUnknowns * 9 * m + 9 * n, &K.of[m][n],
                           columns * sizeof(double));
    });
}

}  // namespace

void straight_force(const StraightBeam& beam, const double* q, double* force) noexcept {
  Two V[kComponents], s[kProducts], stress[kProducts];
  point_vectors(beam, q, V);
  strains<Spatial>(V, s);
  stresses<Spatial>(beam, s, stress);
  nodal_force(beam, stress, V, force);
}

void straight_tangent(const StraightBeam& beam, const double* q, double* force,
                      double* tangent) noexcept {
  Two V[kComponents], s[kProducts], stress[kProducts], K[kEntries];
  point_vectors(beam, q, V);
  strains<Spatial>(V, s);
  stresses<Spatial>(beam, s, stress);
  nodal_force(beam, stress, V, force);
  vector_tangent<Spatial>(beam, stress, V, K);

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

}  // namespace railstep
