#pragma once
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Which side of a place an element is taken from: behind or ahead of it along x. They differ
/// where a moment acts, and by the mesh's error at element borders.
enum class From { behind, ahead };

/// Vertical bending moment of a rail about its axis, -E Iy d(b_x)/dx, N m; positive where the foot
/// is in tension. Of a rail bent by forces at its element borders it is exact: the turn b_x then is
/// quadratic in each element.
/// @param displacement  of each line's unknowns, as Statics::solve() gives them
/// Throws std::out_of_range off the rail.
double bending_moment(const Track& track, const std::vector<Line>& lines,
                      const std::vector<Eigen::VectorXd>& displacement, int rail, double x,
                      From from = From::behind);

}  // namespace railstep
