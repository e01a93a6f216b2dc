#pragma once
#include <utility>

#include "online/beam/straight.h"
#include "online/beam/wide.h"

namespace RAILSTEP_KERNELS::straight {

// The spatial and the planar element differ in the number of components of each field of a node.
// All else of both is written once.

/// each(0), ..., each(N - 1), the index a constant of its type.
template <class Each, int... I>
[[gnu::always_inline]] inline void unrolled(std::integer_sequence<int, I...>, const Each& each) {
  (each(std::integral_constant<int, I>{}), ...);
}
template <int N, class Each>
[[gnu::always_inline]] inline void unrolled(const Each& each) {
  unrolled(std::make_integer_sequence<int, N>{}, each);
}

/// Unknowns of a node, and how many of them are of its fields [r, a, b].
struct Spatial {
  static constexpr int kUnknowns = 9;
  static constexpr int kSize[3] = {3, 3, 3};
};
/// In the plane x-z: r and b along x and z, a along y.
struct Planar {
  static constexpr int kUnknowns = 5;
  static constexpr int kSize[3] = {2, 1, 2};
};

inline constexpr int kVectors = 5;  // V = [r', a', b', a, b]

/// First unknown of a field in its node.
template <class Kind>
constexpr int field_first(int field) noexcept {
  return (field > 0 ? Kind::kSize[0] : 0) + (field > 1 ? Kind::kSize[1] : 0);
}
/// Components of a vector of V, and where its first one is.
template <class Kind>
constexpr int vector_size(int vector) noexcept {
  return Kind::kSize[vector < 3 ? vector : vector - 2];
}
template <class Kind>
constexpr int vector_first(int vector) noexcept {
  int first = 0;
  for (int v = 0; v < vector; ++v) first += vector_size<Kind>(v);
  return first;
}
template <class Kind>
inline constexpr int kComponentsOf = vector_first<Kind>(kVectors);

/// True for vectors along the same axes; the product of others is 0 in every motion. Sizes tell the
/// axes: in the plane 2 is x and z, 1 is y.
template <class Kind>
constexpr bool along_same(int i, int j) noexcept {
  return vector_size<Kind>(i) == vector_size<Kind>(j);
}
template <class Kind>
constexpr bool has_product(int k) noexcept {
  return along_same<Kind>(kProductOf[k][0], kProductOf[k][1]);
}

/// Matrices of a tangent: the blocks of V in the order of kProductOf, then transposes of some. The
/// first three of these are all that the fields' upper triangle needs.
inline constexpr int kTransposeOf[] = {8, 10, 11, 1, 2, 4, 6, 7, 9, 13};
inline constexpr int kUpperMatrices = kProducts + 3, kMatrices = kProducts + 10;

template <class Kind>
constexpr int matrix_rows_of(int matrix) noexcept {
  return vector_size<Kind>(matrix < kProducts ? kProductOf[matrix][0]
                                              : kProductOf[kTransposeOf[matrix - kProducts]][1]);
}
template <class Kind>
constexpr int matrix_columns_of(int matrix) noexcept {
  return vector_size<Kind>(matrix < kProducts ? kProductOf[matrix][1]
                                              : kProductOf[kTransposeOf[matrix - kProducts]][0]);
}
/// Where the entries of a matrix begin, all matrices one after the other, row after row.
template <class Kind>
constexpr int matrix_first(int matrix) noexcept {
  int first = 0;
  for (int m = 0; m < matrix; ++m) first += matrix_rows_of<Kind>(m) * matrix_columns_of<Kind>(m);
  return first;
}

}  // namespace RAILSTEP_KERNELS::straight
