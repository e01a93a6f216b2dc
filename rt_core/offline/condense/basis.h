#pragma once
#include <Eigen/Core>

namespace railstep {

/// A line in fewer coordinates: u = shapes y, with shapes' M shapes = I and
/// shapes' K shapes = diag(omega^2).
struct Basis {
  Eigen::VectorXd omega;   // [kept] rad/s, above 0, ascending
  Eigen::MatrixXd shapes;  // [unknowns of the line][kept]
};

}  // namespace railstep
