#pragma once

#include <array>
#include <vector>

#include "offline/section/half_polygon.h"

namespace railstep {

/// Conforming triangles of a section, or of its right half.
struct SectionMesh {
  std::vector<std::array<double, 2>> points;  // (y, z), m; of a half y is exactly 0 on the axis
  std::vector<std::array<int, 3>> triangles;  // corners, counter-clockwise
};

/// Ruppert's Delaunay refinement (1995, J. Algorithms 18, 548): boundary pieces with a point in
/// their diametral circle are halved, and triangles too flat (circumradius over 1.5 times the
/// shortest edge) or too large get their circumcentre as a new point. Every vertex of `half` is a
/// mesh point. The same input gives the same mesh.
/// @param half  from right_half
/// @param size  widest triangle, m; shrinks to size/100 at re-entrant corners (over 200 degrees),
///              growing with 0.3 times the distance, because the gradients there are singular
/// @throws Refused when it needs more than 200000 points, or 20000 on the outline: sides too short,
///         or a part too narrow
SectionMesh mesh_half(const HalfPolygon& half, double size);

/// The same for a whole outline, which may be unsymmetric: simple, counter-clockwise.
SectionMesh mesh_whole(const std::vector<std::array<double, 2>>& polygon, double size);

}  // namespace railstep
