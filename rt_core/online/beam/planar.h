#pragma once
#include "online/beam/straight.h"

namespace railstep {

// The straight element in the plane x-z: unknowns of a node [r_x, r_z, a_y, b_x, b_z], the others
// of [r, a, b] are 0. With a section symmetric in y the spatial element has no force out of it, so
// this one has the spatial one's forces and tangents in these unknowns, with the same constants.

inline constexpr int kPlanarUnknowns = 5;
/// The spatial unknown of each.
inline constexpr int kPlanarOf[kPlanarUnknowns] = {0, 2, 4, 6, 8};
/// Doubles of one group of kStraightLanes tangents: [pair][row 5][column 5][lane].
inline constexpr int kPlanarGroup =
    kStraightPairs * kPlanarUnknowns * kPlanarUnknowns * kStraightLanes;

/// straight_forces() in the plane.
/// @param n            at least 1
/// @param q            [2n + 1][5], positions
/// @param half_change  [2n + 1][5]; nullptr for none
/// @param force        [2n + 1][5], overwritten; N for r, N m for slopes; no alias
/// Cannot fail: NaN in, NaN out. Same work for every q.
void planar_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                   double* force) noexcept;

/// straight_tangents() in the plane.
/// @param tangent  [straight_groups(n)][kPlanarGroup], overwritten; must not alias q or force
void planar_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                     double* force, double* tangent) noexcept;

/// Entry (i, j) of [15][15] of an element in a batch's tangents.
constexpr double planar_entry(const double* tangent, int element, int i, int j) noexcept {
  constexpr int W = kPlanarUnknowns;
  const int m = i / W, n = j / W;
  if (m > n) return planar_entry(tangent, element, j, i);
  const int pair = 3 * m - m * (m - 1) / 2 + (n - m);
  return tangent[(element / kStraightLanes) * kPlanarGroup +
                 ((W * pair + i % W) * W + j % W) * kStraightLanes + element % kStraightLanes];
}

}  // namespace railstep
