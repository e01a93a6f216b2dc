#pragma once
#include <vector>

#include "offline/condense/basis.h"

namespace railstep {

/// Rational Krylov shapes (Grimme 1997): the motions of the line under a wheel's unit forces, (K +
/// i w C - w^2 M)^-1 b, with its full damping, at the expansion points. The forces stand over every
/// seat and in the middle of every bay. Re and Im are shapes of their own. The `most` directions
/// that hold the most strain energy of these shapes (singular vectors) are kept: the error of
/// Galerkin's coordinates in a place's static compliance is the strain energy that they leave out.
/// Away from statics this is a measure and not a bound; a motion far softer than those at the
/// expansion points holds little strain energy.
/// @param hz    expansion points, above 0
/// @param most  columns of the result; it has fewer where fewer are independent
/// Throws Refused if the line resonates without damping at an expansion point.
Eigen::MatrixXd rational_krylov_shapes(const Track& track, const Line& line,
                                       const std::vector<double>& hz, int most);

}  // namespace railstep
