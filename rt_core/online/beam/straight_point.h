#pragma once
#include "online/beam/straight_kind.h"

namespace RAILSTEP_KERNELS::straight {

// One Gauss point of a straight element, written once over a number type T: its lanes are the two
// points of one element, or elements. No sum runs across lanes, so every width gives the same bits.
// Loops are unrolled by templates, so that the places where C is 0 cost nothing.

/// The product of vectors i and j, either order.
constexpr int product_of(int i, int j) noexcept {
  for (int k = 0; k < kProducts; ++k)
    if ((kProductOf[k][0] == i && kProductOf[k][1] == j) ||
        (kProductOf[k][0] == j && kProductOf[k][1] == i))
      return k;
  return -1;
}

/// The vectors whose products with vector i are in a block.
struct Partners {
  int count = 0;
  int vector[kVectors] = {};
};
template <class Kind>
constexpr Partners partners(int i, int block) noexcept {
  Partners found;
  for (int k = 0; k < kVectors; ++k)
    if (along_same<Kind>(i, k) && kStraightBlock[product_of(i, k)] == block)
      found.vector[found.count++] = k;
  return found;
}

/// The first block of C that couples products of vector i with some of vector j.
template <class Kind>
constexpr int first_block(int i, int j) noexcept {
  int block = 0;
  while (partners<Kind>(i, block).count == 0 || partners<Kind>(j, block).count == 0) ++block;
  return block;
}

/// Product k of the vectors, halved if of one with itself.
template <class Kind, int k, class T>
[[gnu::always_inline]] inline T product(const T* V) noexcept {
  constexpr int i = kProductOf[k][0], j = kProductOf[k][1];
  const T* x = V + vector_first<Kind>(i);
  const T* y = V + vector_first<Kind>(j);
  T sum = x[0] * y[0];
  unrolled<vector_size<Kind>(i) - 1>([&](auto c) __attribute__((always_inline)) {
    sum += x[c + 1] * y[c + 1];
  });
  if constexpr (i == j) sum *= .5;
  return sum;
}

/// Change of the products from the straight rest, where r'r' = aa = bb = 1 and others are 0.
template <class Kind, class T>
[[gnu::always_inline]] inline void strains(const T* V, T* s) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    constexpr int i = kProductOf[k][0], j = kProductOf[k][1];
    if constexpr (has_product<Kind>(k)) {
      s[k] = product<Kind, k>(V);
      if constexpr (i == j && (i == 0 || i > 2)) s[k] -= .5;
    }
  });
}

/// s += the products of half a change D of V: the mean strain of V - D and V + D.
template <class Kind, class T>
[[gnu::always_inline]] inline void add_products(const T* D, T* s) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    if constexpr (has_product<Kind>(k)) s[k] += product<Kind, k>(D);
  });
}

/// dU/ds = p0 + C s.
template <class Kind, class T>
[[gnu::always_inline]] inline void stresses(const StraightBeam& beam, const T* s,
                                            T* stress) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    constexpr int own = straight_constant(k, k), p = straight_preload(k);
    if constexpr (has_product<Kind>(k)) {
      stress[k] = beam.stiffness[own] * s[k];
      if constexpr (p >= 0) stress[k] += beam.preload[p];
      unrolled<kProducts>([&](auto l) __attribute__((always_inline)) {
        constexpr int other = straight_constant(k, l);
        if constexpr (has_product<Kind>(l) && other >= 0 && other != own)
          stress[k] += beam.stiffness[other] * s[l];
      });
    }
  });
}

/// dU/dV: each product's stress times the other vector.
template <class Kind, class T>
[[gnu::always_inline]] inline void vector_forces(const T* stress, const T* V, T* F) noexcept {
  unrolled<kVectors>([&](auto i) __attribute__((always_inline)) {
    constexpr int size = vector_size<Kind>(i), at = vector_first<Kind>(i);
    constexpr int first = along_same<Kind>(i, 0) ? 0 : 1;
    unrolled<size>([&](auto c) __attribute__((always_inline)) {
      T sum = stress[product_of(i, first)] * V[vector_first<Kind>(first) + c];
      unrolled<kVectors - 1 - first>([&](auto other) __attribute__((always_inline)) {
        constexpr int j = other + 1 + first;
        if constexpr (along_same<Kind>(i, j))
          sum += stress[product_of(i, j)] * V[vector_first<Kind>(j) + c];
      });
      F[at + c] = sum;
    });
  });
}

/// K += x y', row after row; of a block on the diagonal the upper triangle.
template <int kRows, int kColumns, bool kFirst, bool kDiagonal, class T>
[[gnu::always_inline]] inline void add_outer(const T* x, const T* y, T* K) noexcept {
  unrolled<kRows * kColumns>([&](auto c) __attribute__((always_inline)) {
    constexpr int row = c / kColumns, column = c % kColumns;
    if constexpr (kDiagonal && row > column)
      return;
    else if constexpr (kFirst)
      K[c] = x[row] * y[column];
    else
      K[c] += x[row] * y[column];
  });
}

/// w = sum of C(ik, jl) V_l over the l that C couples with the product ik.
template <class Kind, int I, int K, int J, int kBlock, class T>
[[gnu::always_inline]] inline void weighted(const StraightBeam& beam, const T* V, T* w) noexcept {
  constexpr Partners of = partners<Kind>(J, kBlock);
  unrolled<of.count>([&](auto n) __attribute__((always_inline)) {
    constexpr int l = of.vector[n];
    const double C = beam.stiffness[straight_constant(product_of(I, K), product_of(J, l))];
    unrolled<vector_size<Kind>(J)>([&](auto c) __attribute__((always_inline)) {
      if constexpr (n == 0)
        w[c] = C * V[vector_first<Kind>(l) + c];
      else
        w[c] += C * V[vector_first<Kind>(l) + c];
    });
  });
}

/// d2U/dV_i dV_j: the sum of C(ik, jl) V_k V_l', and the stress on the identity. The side of
/// a block of C with fewer vectors makes the outer products.
template <class Kind, int I, int J, class T>
[[gnu::always_inline]] inline void tangent_block(const StraightBeam& beam, const T* stress,
                                                 const T* V, T* K) noexcept {
  constexpr bool diagonal = I == J;
  constexpr int rows = vector_size<Kind>(I), columns = vector_size<Kind>(J);
  unrolled<kStraightBlocks>([&](auto block) __attribute__((always_inline)) {
    constexpr Partners left = partners<Kind>(I, block), right = partners<Kind>(J, block);
    constexpr bool by_left = left.count <= right.count;
    constexpr bool first = block == first_block<Kind>(I, J);
    if constexpr (left.count > 0 && right.count > 0)
      unrolled<by_left ? left.count : right.count>([&](auto n) __attribute__((always_inline)) {
        T w[3];
        if constexpr (by_left) {
          constexpr int k = left.vector[n];
          weighted<Kind, I, k, J, block>(beam, V, w);
          add_outer<rows, columns, first && n == 0, diagonal>(V + vector_first<Kind>(k), w, K);
        } else {
          constexpr int k = right.vector[n];
          weighted<Kind, J, k, I, block>(beam, V, w);
          add_outer<rows, columns, first && n == 0, diagonal>(w, V + vector_first<Kind>(k), K);
        }
      });
  });
  if constexpr (along_same<Kind>(I, J))
    for (int c = 0; c < rows * rows; c += rows + 1) K[c] += stress[product_of(I, J)];
  if constexpr (diagonal)
    unrolled<rows * rows>([&](auto c) __attribute__((always_inline)) {
      constexpr int row = c / rows, column = c % rows;
      if constexpr (row > column) K[c] = K[rows * column + row];
    });
}

/// d2U/dV2, the 15 pairs of vectors as kProductOf.
template <class Kind, class T>
[[gnu::always_inline]] inline void vector_tangent(const StraightBeam& beam, const T* stress,
                                                  const T* V, T* K) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    tangent_block<Kind, kProductOf[k][0], kProductOf[k][1]>(beam, stress, V,
                                                            K + matrix_first<Kind>(k));
  });
}

}  // namespace RAILSTEP_KERNELS::straight
