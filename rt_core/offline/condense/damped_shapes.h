#pragma once
#include <Eigen/Core>
#include <complex>

namespace railstep {

/// Rates and shapes of damped modes, as DampedModes (modal.h) has them.
struct DampedShapes {
  Eigen::VectorXcd rate;   // [modes] 1/s, slowest first
  Eigen::MatrixXcd shape;  // [kept][modes]
};

/// Damped modes of y'' + D y' + Omega^2 y = 0 from the eigenvalues and eigenvectors of its
/// first-order form over (Omega y, y'), normalised, but not yet checked.
///
/// Rates that differ by no more than the errors of an eigen solver count as equal and get their
/// mean. Any mixture of their shapes is a shape as well. The solver's shapes may be parallel, or
/// their products with themselves may be 0. They are combined so that shape' (2 rate + D) shape = I
/// or 2 I among them.
/// @param omega    [kept] 1/s
/// @param damping  [kept][kept] D, 1/s, symmetric
/// @param rates    [2 kept] 1/s
/// @param vectors  [2 kept][2 kept]
DampedShapes damped_shapes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& damping,
                           const Eigen::VectorXcd& rates, const Eigen::MatrixXcd& vectors);

}  // namespace railstep
