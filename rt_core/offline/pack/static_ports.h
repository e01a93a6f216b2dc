#pragma once
#include <Eigen/Core>

namespace railstep {

/// Forces of one-sided springs at rest, N; dampers carry nothing.
/// @param compliance  [n][n] between the springs, m/N
/// @param stiffness   [n] N/m
/// @param free        [n] how far each would be closed without these forces, m
/// Throws std::invalid_argument where no equilibrium is found.
Eigen::VectorXd static_port_forces(const Eigen::MatrixXd& compliance,
                                   const Eigen::VectorXd& stiffness, const Eigen::VectorXd& free);

}  // namespace railstep
