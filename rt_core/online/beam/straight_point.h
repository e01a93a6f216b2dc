#pragma once
#include <utility>

#include "online/beam/straight.h"

namespace railstep::straight {

// One Gauss point of a straight element, written once over a number type T: its lanes are the two
// points of one element, or elements. No sum runs across lanes, so every width gives the same bits.
// Loops are unrolled by templates, so that the places where C is 0 cost nothing.

inline constexpr int kVectors = 5, kComponents = 15;  // V = [r', a', b', a, b], and its components

/// each(0), ..., each(N - 1), the index a constant of its type.
template <class Each, int... I>
[[gnu::always_inline]] inline void unrolled(std::integer_sequence<int, I...>, const Each& each) {
  (each(std::integral_constant<int, I>{}), ...);
}
template <int N, class Each>
[[gnu::always_inline]] inline void unrolled(const Each& each) {
  unrolled(std::make_integer_sequence<int, N>{}, each);
}

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
constexpr Partners partners(int i, int block) noexcept {
  Partners found;
  for (int k = 0; k < kVectors; ++k)
    if (kStraightBlock[product_of(i, k)] == block) found.vector[found.count++] = k;
  return found;
}

/// The first block of C that couples products of vector i with some of vector j.
constexpr int first_block(int i, int j) noexcept {
  int block = 0;
  while (partners(i, block).count == 0 || partners(j, block).count == 0) ++block;
  return block;
}

/// Change of the products from the straight rest, where r'r' = aa = bb = 1 and others are 0.
template <class T>
[[gnu::always_inline]] inline void strains(const T* V, T* s) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    constexpr int i = kProductOf[k][0], j = kProductOf[k][1];
    s[k] = (V[3 * i] * V[3 * j] + V[3 * i + 1] * V[3 * j + 1]) + V[3 * i + 2] * V[3 * j + 2];
    if constexpr (i == j) s[k] *= .5;
    if constexpr (i == j && (i == 0 || i > 2)) s[k] -= .5;
  });
}

/// dU/ds = p0 + C s.
template <class T>
[[gnu::always_inline]] inline void stresses(const StraightBeam& beam, const T* s,
                                            T* stress) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    constexpr int own = straight_constant(k, k), p = straight_preload(k);
    stress[k] = beam.stiffness[own] * s[k];
    if constexpr (p >= 0) stress[k] += beam.preload[p];
    unrolled<kProducts>([&](auto l) __attribute__((always_inline)) {
      constexpr int other = straight_constant(k, l);
      if constexpr (other >= 0 && other != own) stress[k] += beam.stiffness[other] * s[l];
    });
  });
}

/// dU/dV: each product's stress times the other vector.
template <class T>
[[gnu::always_inline]] inline void vector_forces(const T* stress, const T* V, T* F) noexcept {
  unrolled<kVectors>([&](auto i) __attribute__((always_inline)) {
    unrolled<3>([&](auto c) __attribute__((always_inline)) {
      T sum = stress[product_of(i, 0)] * V[c];
      unrolled<kVectors - 1>([&](auto j) __attribute__((always_inline)) {
        sum += stress[product_of(i, j + 1)] * V[3 * (j + 1) + c];
      });
      F[3 * i + c] = sum;
    });
  });
}

/// K += x y', [3][3]; of a block on the diagonal the upper triangle.
template <bool kFirst, bool kDiagonal, class T>
[[gnu::always_inline]] inline void add_outer(const T* x, const T* y, T* K) noexcept {
  unrolled<9>([&](auto c) __attribute__((always_inline)) {
    constexpr int row = c / 3, column = c % 3;
    if constexpr (kDiagonal && row > column)
      return;
    else if constexpr (kFirst)
      K[c] = x[row] * y[column];
    else
      K[c] += x[row] * y[column];
  });
}

/// w = sum of C(ik, jl) V_l over the l that C couples with the product ik.
template <int I, int K, int J, int kBlock, class T>
[[gnu::always_inline]] inline void weighted(const StraightBeam& beam, const T* V, T* w) noexcept {
  constexpr Partners of = partners(J, kBlock);
  unrolled<of.count>([&](auto n) __attribute__((always_inline)) {
    constexpr int l = of.vector[n];
    const double C = beam.stiffness[straight_constant(product_of(I, K), product_of(J, l))];
    unrolled<3>([&](auto c) __attribute__((always_inline)) {
      if constexpr (n == 0)
        w[c] = C * V[3 * l + c];
      else
        w[c] += C * V[3 * l + c];
    });
  });
}

/// d2U/dV_i dV_j, [3][3]: the sum of C(ik, jl) V_k V_l', and the stress on the identity. Of a block
/// of C the side with fewer vectors makes the outer products.
template <int I, int J, class T>
[[gnu::always_inline]] inline void tangent_block(const StraightBeam& beam, const T* stress,
                                                 const T* V, T* K) noexcept {
  constexpr bool diagonal = I == J;
  unrolled<kStraightBlocks>([&](auto block) __attribute__((always_inline)) {
    constexpr Partners left = partners(I, block), right = partners(J, block);
    constexpr bool by_left = left.count <= right.count;
    constexpr bool first = block == first_block(I, J);
    if constexpr (left.count > 0 && right.count > 0)
      unrolled<by_left ? left.count : right.count>([&](auto n) __attribute__((always_inline)) {
        T w[3];
        if constexpr (by_left) {
          weighted<I, left.vector[n], J, block>(beam, V, w);
          add_outer<first && n == 0, diagonal>(V + 3 * left.vector[n], w, K);
        } else {
          weighted<J, right.vector[n], I, block>(beam, V, w);
          add_outer<first && n == 0, diagonal>(w, V + 3 * right.vector[n], K);
        }
      });
  });
  for (int c = 0; c < 9; c += 4) K[c] += stress[product_of(I, J)];
  if constexpr (diagonal) {
    K[3] = K[1];
    K[6] = K[2];
    K[7] = K[5];
  }
}

/// d2U/dV2, [15 pairs of vectors as kProductOf][3][3].
template <class T>
[[gnu::always_inline]] inline void vector_tangent(const StraightBeam& beam, const T* stress,
                                                  const T* V, T* K) noexcept {
  unrolled<kProducts>([&](auto k) __attribute__((always_inline)) {
    tangent_block<kProductOf[k][0], kProductOf[k][1]>(beam, stress, V, K + 9 * k);
  });
}

}  // namespace railstep::straight
