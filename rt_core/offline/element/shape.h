#pragma once
#include <Eigen/Core>
#include <array>

namespace railstep {

using Vector27 = Eigen::Matrix<double, 27, 1>;

/// Shape functions N1, N2, N3 of Eq. 22 at xi in [-1, 1], and their derivatives by xi.
std::array<double, 3> shape(double xi);
std::array<double, 3> shape_slope(double xi);

/// The 27 coefficients that give component `direction` (0 x, 1 y, 2 z) of the position (of the
/// unknowns as positions) or displacement of the material point (xi, y, z), y and z in m from the
/// reference line.
Vector27 point_row(double xi, double y, double z, int direction);

}  // namespace railstep
