#pragma once
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Residual flexibility G_exact(x, x) - G_model(x, x) of a rail under a vertical force on it: what
/// the quadratic element misses between its end nodes.
///
/// Exact is the same track with every element divided into `points` elements, taken at their ends,
/// where the element is exact: each divided element is condensed to its two end nodes, its static
/// shapes and its inner flexibility with the ends held, so that the cost grows with the track's
/// nodes only. Zero at the end nodes (to the exactness of the element there) and never negative
/// between them.
/// @param point  rail, and y, z over the section, m, from the axis; x and direction are not read
/// @param points intervals per element, >= 3; the table is read by cubic interpolation
/// @returns [elements][points + 1] m/N, at equal steps of x
/// Throws std::invalid_argument if the track has a free rigid mode.
std::vector<double> residual_flexibility(const Track& track, const std::vector<Line>& lines,
                                         const RailPoint& point, int points);

}  // namespace railstep
