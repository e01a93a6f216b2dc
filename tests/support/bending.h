#pragma once
#include <array>
#include <vector>

#include "offline/element/shape.h"
#include "offline/track/track.h"

namespace railstep {

/// Whether the element behind or ahead of a place along x is taken. The two differ where a moment
/// acts, and by the mesh's error at element borders.
enum class From { behind, ahead };

inline constexpr int kSlope = 6;  // b_x among a node's unknowns

/// A border belongs to the element ahead of it; From::behind takes the one before.
inline ElementPlace place_from(const Track& track, double x, From from) {
  ElementPlace place = place_on(track, x);
  const bool at_border = place.xi < -1. + 1e-9;
  if (from == From::behind && at_border && place.element > 0) return {place.element - 1, 1.};
  return place;
}

/// Vertical bending moment of a rail about its axis, -E Iy d(b_x)/dx, N m; positive where the foot
/// is in tension. It is exact for a rail bent by forces at its element borders: the rotation b_x is
/// then quadratic in each element.
/// @param displacement  of each line's unknowns, as Statics::solve() gives them
/// Throws Refused off the rail.
inline double bending_moment(const Track& track, const std::vector<Line>& lines,
                             const std::vector<Eigen::VectorXd>& displacement, int rail, double x,
                             From from = From::behind) {
  const auto [element, xi] = place_from(track, x, from);
  const std::array<double, 3> slope = shape_slope(xi);
  double curvature = 0.;  // d(b_x)/d(xi)
  for (std::size_t l = 0; l < lines.size(); ++l)
    for (int i = 0; i < 3; ++i) {
      const int unknown = lines[l].element_unknown(rail, element, i, kSlope);
      if (unknown >= 0)
        curvature += lines[l].rail_factor[static_cast<std::size_t>(rail)] *
                     slope[static_cast<std::size_t>(i)] * displacement[l][unknown];
    }
  const RailBar bar = track.bar(rail);
  return -bar.material.young * bar.section.inertia_y * 2. / track.element_length() * curvature;
}

}  // namespace railstep
