#pragma once
#include "online/beam/straight_point.h"

namespace RAILSTEP_KERNELS::straight {

// From nodes to the two Gauss points xi = -+g and back: V = e + o at +g and e - o at -g, and the
// same of forces and tangents. Written over a number type T as the point itself.

inline constexpr double kG = 0.57735026918962576451;  // 1 / sqrt 3

/// The parts of V that are even and odd in xi.
/// @param n1, n2, n3  the nodes
template <class Kind, class T>
[[gnu::always_inline]] inline void split(double h, const T* n1, const T* n2, const T* n3, T* even,
                                         T* odd) noexcept {
  constexpr int unknowns = Kind::kUnknowns, position = Kind::kSize[0];
  const double bend = 2. * kG * h;
  for (int c = 0; c < unknowns; ++c) {
    even[c] = h * (n3[c] - n1[c]);
    odd[c] = bend * ((n3[c] + n1[c]) - 2. * n2[c]);
  }
  for (int c = position; c < unknowns; ++c) {
    even[unknowns - position + c] = (1. / 6.) * (n3[c] + n1[c]) + (2. / 3.) * n2[c];
    odd[unknowns - position + c] = (.5 * kG) * (n3[c] - n1[c]);
  }
}

/// Nodal forces of the sum and the difference of the points' forces on V: the transpose of split().
template <class Kind, class T>
[[gnu::always_inline]] inline void gather(double h, const T* even, const T* odd, T* n1, T* n2,
                                          T* n3) noexcept {
  constexpr int unknowns = Kind::kUnknowns, position = Kind::kSize[0];
  const double bend = 2. * kG * h;
  for (int c = 0; c < unknowns; ++c) {
    const T stretch = h * even[c], rotation = bend * odd[c];
    n1[c] = rotation - stretch;
    n2[c] = -2. * rotation;
    n3[c] = rotation + stretch;
  }
  for (int c = position; c < unknowns; ++c) {
    const T& sum = even[unknowns - position + c];
    const T mean = (1. / 6.) * sum, tilt = (.5 * kG) * odd[unknowns - position + c];
    n1[c] += mean - tilt;
    n2[c] += (2. / 3.) * sum;
    n3[c] += mean + tilt;
  }
}

/// Coefficients of a tangent's even and odd part in its node pairs: products of the rows of
/// split().
struct Coefficients {
  double slopes[5];  // of two slopes, 1/m2
  double even[3];    // of a slope and a value, 1/m
  double odd[5];
};
constexpr Coefficients coefficients(double h) noexcept {
  return {{7. / 3. * (h * h), 1. / 3. * (h * h), 8. / 3. * (h * h), 16. / 3. * (h * h),
           4. * kG * (h * h)},
          {1. / 2. * h, 2. / 3. * h, 1. / 6. * h},
          {5. / 6. * (kG * h), 4. / 3. * (kG * h), 1. / 6. * (kG * h), 2. / 3. * (kG * h),
           8. / 3. * (kG * h)}};
}

/// One entry of the nine blocks [node m][node n], m the row.
template <class T>
struct NodePairs {
  T of[3][3];

  [[gnu::always_inline]] void operator+=(const NodePairs& other) noexcept {
    unrolled<9>([&](auto nodes) __attribute__((always_inline)) {
      of[nodes / 3][nodes % 3] += other.of[nodes / 3][nodes % 3];
    });
  }
};

/// Slopes of both nodes; symmetric in m and n.
template <class T>
[[gnu::always_inline]] inline void set_slopes(const Coefficients& k, const T& even, const T& odd,
                                              NodePairs<T>& K) noexcept {
  const T end = k.slopes[0] * even, mid = k.slopes[2] * even, o = k.slopes[4] * odd;
  K.of[0][0] = end - o;
  K.of[0][1] = K.of[1][0] = o - mid;
  K.of[0][2] = K.of[2][0] = k.slopes[1] * even;
  K.of[1][1] = k.slopes[3] * even;
  K.of[1][2] = K.of[2][1] = -(mid + o);
  K.of[2][2] = end + o;
}

/// Slope of node m, value of node n; or, of the transposed block, value of m and slope of n.
template <bool kTransposed, class T>
[[gnu::always_inline]] inline NodePairs<T> mixed(const Coefficients& k, const T& even,
                                                 const T& odd) noexcept {
  NodePairs<T> K;
  const auto at = [&K](int m, int n) __attribute__((always_inline))->T& {
    return kTransposed ? K.of[n][m] : K.of[m][n];
  };
  const T half = k.even[0] * even, two = k.even[1] * even, sixth = k.even[2] * even;
  const T o5 = k.odd[0] * odd, o4 = k.odd[1] * odd, o1 = k.odd[2] * odd, o2 = k.odd[3] * odd;
  at(0, 0) = o5 - half;
  at(0, 1) = o4 - two;
  at(0, 2) = sixth - o1;
  at(1, 0) = two - o2;
  at(1, 1) = -(k.odd[4] * odd);
  at(1, 2) = -(two + o2);
  at(2, 0) = -(sixth + o1);
  at(2, 1) = two + o4;
  at(2, 2) = half + o5;
  return K;
}

/// Values of both nodes; symmetric in m and n.
template <class T>
[[gnu::always_inline]] inline void add_values(const T& even, const T& odd,
                                              NodePairs<T>& K) noexcept {
  const T ninth = (1. / 9.) * even, o6 = (kG / 6.) * odd, o3 = (kG / 3.) * odd;
  K.of[0][0] += ninth - o6;
  K.of[2][2] += ninth + o6;
  K.of[1][1] += (4. / 9.) * even;
  const T first = ninth - o3, last = ninth + o3, ends = (1. / 18.) * even;
  K.of[0][1] += first;
  K.of[1][0] += first;
  K.of[1][2] += last;
  K.of[2][1] += last;
  K.of[0][2] -= ends;
  K.of[2][0] -= ends;
}

/// Which matrices make the block of two nodal fields r, a, b; -1 where there is none.
struct FieldPair {
  int row, column;  // fields
  int slopes, mixed, transposed, values;
};
/// The upper triangle first.
inline constexpr int kUpperPairs = 6, kFieldPairs = 9;
inline constexpr FieldPair kFieldPair[kFieldPairs] = {
    {0, 0, 0, -1, -1, -1},  {0, 1, 1, 6, -1, -1},   {0, 2, 2, 7, -1, -1},
    {1, 1, 3, 8, 15, 12},   {1, 2, 4, 9, 16, 13},   {2, 2, 5, 11, 17, 14},
    {1, 0, 18, -1, 21, -1}, {2, 0, 19, -1, 22, -1}, {2, 1, 20, 10, 23, 24}};

/// One entry, or row, of a field pair; a block and its mirror image have the same bits.
/// @param at  where that entry of a matrix is in `even` and `odd`, at(matrix)
template <int kPair, class T, class At>
[[gnu::always_inline]] inline NodePairs<T> node_pairs(const Coefficients& k, const T* even,
                                                      const T* odd, const At& at) noexcept {
  constexpr FieldPair p = kFieldPair[kPair];
  NodePairs<T> K;
  set_slopes(k, even[at(p.slopes)], odd[at(p.slopes)], K);
  if constexpr (p.mixed >= 0 && p.transposed >= 0) {
    NodePairs<T> both = mixed<false>(k, even[at(p.mixed)], odd[at(p.mixed)]);
    both += mixed<true>(k, even[at(p.transposed)], odd[at(p.transposed)]);
    K += both;
  } else if constexpr (p.mixed >= 0) {
    K += mixed<false>(k, even[at(p.mixed)], odd[at(p.mixed)]);
  } else if constexpr (p.transposed >= 0) {
    K += mixed<true>(k, even[at(p.transposed)], odd[at(p.transposed)]);
  }
  if constexpr (p.values >= 0) add_values(even[at(p.values)], odd[at(p.values)], K);
  return K;
}

}  // namespace RAILSTEP_KERNELS::straight
