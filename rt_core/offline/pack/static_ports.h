#pragma once
#include <Eigen/Core>

namespace railstep {

/// Forces of one-sided springs at rest, N; dampers carry nothing.
/// @param compliance  [n][n] between the springs, m/N
/// @param stiffness   [n] N/m
/// @param free        [n] closing of each without these forces, m
/// Throws Refused if no equilibrium is found.
Eigen::VectorXd static_port_forces(const Eigen::MatrixXd& compliance,
                                   const Eigen::VectorXd& stiffness, const Eigen::VectorXd& free);

}  // namespace railstep
