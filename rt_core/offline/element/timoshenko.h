#pragma once
#include <Eigen/Core>

#include "offline/element/matrices.h"

namespace railstep {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

/// Exact stiffness of a straight Timoshenko beam between two nodes along x, each with the
/// centroid's displacement and the section's rotation about x, y, z: J. S. Przemieniecki, Theory of
/// Matrix Structural Analysis (1968), table 5.1, Phi = 12 E I/(k G A L^2) in either plane, with the
/// lateral displacement taken at the shear centre, u_y - z_s theta_x. N/m, N, N m. It shares
/// nothing with the ANCF element but the section's constants.
/// @param length  m, > 0
Matrix12 timoshenko_stiffness(const BeamSection& section, const Material& material, double length);

/// Nodal forces of 1 N/m in +z on the centroid, m and m2; exact too.
Vector12 timoshenko_line_load(double length);

}  // namespace railstep
