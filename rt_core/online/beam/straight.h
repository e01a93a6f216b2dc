#pragma once
#include "online/beam/beam.h"

namespace railstep {

/// Numbers of C that a straight element with a section symmetric in y has: upper triangles of five
/// blocks of products, row after row, block after block.
inline constexpr int kStraightConstants = 37, kStraightBlocks = 5;
/// Block of each product, in the order of kProductOf, and its place in the block.
///   {r'r', r'b', a'a', b'b', aa, bb}, {r'a', a'b'}, {r'a, a'b, b'a}, {r'b, a'a, b'b}, {ab}
inline constexpr int kStraightBlock[kProducts] = {0, 1, 0, 0, 1, 0, 2, 3, 3, 2, 2, 3, 0, 4, 0};
inline constexpr int kStraightPlace[kProducts] = {0, 0, 1, 2, 1, 3, 0, 0, 1, 1, 2, 2, 4, 0, 5};
inline constexpr int kStraightSize[kStraightBlocks] = {6, 2, 3, 3, 1};
inline constexpr int kStraightFirst[kStraightBlocks] = {0, 21, 24, 30, 36};
/// Products whose preload a uniform axial stress makes, r'r', r'b', a'a', b'b'.
inline constexpr int kStraightPreloads = 4;

/// Index of C(k, l) among the constants; -1 where C is 0.
constexpr int straight_constant(int k, int l) noexcept {
  if (kStraightBlock[k] != kStraightBlock[l]) return -1;
  const int a = kStraightPlace[k], b = kStraightPlace[l], block = kStraightBlock[k];
  const int i = a < b ? a : b, j = a < b ? b : a;
  return kStraightFirst[block] + i * kStraightSize[block] - i * (i - 1) / 2 + (j - i);
}

/// Index of a product among the preloads; -1 where it has none.
constexpr int straight_preload(int k) noexcept {
  return kStraightBlock[k] == 0 && kStraightPlace[k] < kStraightPreloads ? kStraightPlace[k] : -1;
}

/// The element of beam.h that is straight along x at rest, with unit slopes, a section symmetric in
/// y and two Gauss points: both points have the same constants. Made by straight_beam().
struct StraightBeam {
  double per_length;                     // 1/L, 1/m
  double preload[kStraightPreloads];     // p0
  double stiffness[kStraightConstants];  // C; weight and det J in it
};

/// Elements side by side in the tangents of a batch.
inline constexpr int kStraightLanes = 4;
/// Node pairs (1,1) (1,2) (1,3) (2,2) (2,3) (3,3) of a tangent in a batch, each [9][9].
inline constexpr int kStraightPairs = 6;
/// Doubles of one group of kStraightLanes tangents: [pair][row 9][column 9][lane].
inline constexpr int kStraightGroup = kStraightPairs * 81 * kStraightLanes;

/// beam_force() of a straight element, the sums in an order of their own. The same bits for any
/// compiler, level and vector width, and in a batch.
/// @param q      [27], positions as in beam.h
/// @param force  [27], overwritten; N for r, N m for slopes; must not alias q
/// Cannot fail: NaN in, NaN out. Same work for every q.
void straight_force(const StraightBeam& beam, const double* q, double* force) noexcept;

/// Force, and its derivative, symmetric to the bit.
/// @param tangent  [27][27], overwritten; must not alias q or force
void straight_tangent(const StraightBeam& beam, const double* q, double* force,
                      double* tangent) noexcept;

/// Groups of tangents of a batch of n elements: ceil(n / kStraightLanes).
constexpr int straight_groups(int n) noexcept { return (n + kStraightLanes - 1) / kStraightLanes; }

/// Forces of n elements in a row that are alike; element e has the nodes 2e, 2e + 1, 2e + 2.
/// With half a change, d = (q1 - q0) / 2 at q = (q0 + q1) / 2, the stress is the mean of those at
/// q0 and q1, and F . (q1 - q0) = U(q1) - U(q0): every product is quadratic in q, so the mean one
/// is s(q) + s(d), and its change is ds/dq(q) . 2d (Simo and Tarnow 1992, for a quadratic energy).
/// @param n            at least 1
/// @param q            [2n + 1][9]
/// @param half_change  d, [2n + 1][9]; nullptr for none
/// @param force        [2n + 1][9], overwritten: the sum of an inner end node's two elements; no
///                     alias
void straight_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                     double* force) noexcept;

/// Forces, and tangents element by element: element e is lane e % 4 of group e / 4, ready to be
/// condensed to its end nodes lane by lane, or to be added to a band at row and column
/// 18 e + 9 node. Blocks (1,1), (2,2) and (3,3) hold both triangles. Lanes after the last element
/// repeat it. With half a change the tangent is the ordinary one at q under the mean stress: twice
/// dF/dq1 but for the unsymmetric part B' C B(d).
/// @param tangent  [straight_groups(n)][kStraightGroup], overwritten; must not alias q or force
void straight_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                       double* force, double* tangent) noexcept;

/// Entry (i, j) of [27][27] of an element in a batch's tangents.
constexpr double straight_entry(const double* tangent, int element, int i, int j) noexcept {
  const int m = i / 9, n = j / 9;
  if (m > n) return straight_entry(tangent, element, j, i);
  const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
  return tangent[(element / kStraightLanes) * kStraightGroup +
                 ((9 * pair + i % 9) * 9 + j % 9) * kStraightLanes + element % kStraightLanes];
}

}  // namespace railstep
