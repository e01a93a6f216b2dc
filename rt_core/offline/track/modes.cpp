#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "offline/track/statics.h"

namespace railstep {

Modes modes(const Line& line) {
  const Eigen::MatrixXd K(line.stiffness), M(line.mass);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  if (solver.info() != Eigen::Success)
    throw std::invalid_argument("the modes of a line were not found: is a mass zero or negative?");
  Modes result{Eigen::VectorXd(K.rows()), solver.eigenvectors()};
  const double pi = 3.14159265358979323846;
  for (int i = 0; i < K.rows(); ++i) {
    const double square = solver.eigenvalues()[i];
    // Rigid modes come as rounding noise of the largest eigenvalue.
    const bool rigid = square < 1e-12 * solver.eigenvalues()[K.rows() - 1];
    result.frequency[i] = rigid ? 0. : std::sqrt(square) / (2. * pi);
    int largest = 0;
    result.shape.col(i).cwiseAbs().maxCoeff(&largest);
    if (result.shape(largest, i) < 0.) result.shape.col(i) *= -1.;
  }
  return result;
}

}  // namespace railstep
