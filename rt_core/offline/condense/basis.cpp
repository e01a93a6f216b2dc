#include "offline/condense/basis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kIndependent = 1e-10;  // of the largest eigenvalue of a Gram matrix
constexpr double kLeastHz = 1e-3;       // below it a mode is rigid

/// Orthonormal over the mass, of shapes of norm 1 or 0 there.
Eigen::MatrixXd independent(const Line& line, const Eigen::MatrixXd& shapes) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(shapes.transpose() *
                                                            (line.mass * shapes));
  const double largest = gram.eigenvalues().maxCoeff();
  Eigen::Index first = largest > 0. ? 0 : shapes.cols();
  while (first < shapes.cols() && gram.eigenvalues()[first] < kIndependent * largest) ++first;
  const Eigen::Index rank = shapes.cols() - first;
  Eigen::MatrixXd result = shapes * gram.eigenvectors().rightCols(rank);
  result *= gram.eigenvalues().tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  return result;
}

Eigen::VectorXd norms(const Line& line, const Eigen::MatrixXd& shapes) {
  return shapes.cwiseProduct(line.mass * shapes).colwise().sum().cwiseSqrt().transpose();
}

}  // namespace

Eigen::MatrixXd Basis::static_response(const Eigen::MatrixXd& forces) const {
  if (flexibility.size() > 0) return flexibility * forces;
  return omega.cwiseAbs2().cwiseInverse().asDiagonal() * forces;
}

Eigen::VectorXd Basis::modelled(const Eigen::VectorXd& y) const {
  if (flexibility.size() == 0) return y;
  return flexibility * omega.cwiseAbs2().cwiseProduct(y);
}

Basis with_springs(Basis basis, const Eigen::SparseMatrix<double>& springs) {
  if (springs.norm() == 0.) return basis;
  // Over omega y, in which the lines' own stiffness is 1: sizes that differ by far cancel nothing.
  const Eigen::MatrixXd unit = basis.shapes.dense() * basis.omega.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd held = unit.transpose() * (springs * unit);
  const auto n = held.rows();
  const Eigen::MatrixXd flexible =
      (Eigen::MatrixXd::Identity(n, n) + held).llt().solve(Eigen::MatrixXd::Identity(n, n));
  const auto scale = basis.omega.cwiseInverse().asDiagonal();
  basis.flexibility = scale * (.5 * (flexible + flexible.transpose())) * scale;
  return basis;
}

void refuse_free_mode(double lowest_hz) {
  if (!(lowest_hz >= kLeastHz))
    refuse("E-TRACK-35",
           "the track has a free rigid mode; expected a support or a held end in every direction "
           "in which it moves");
}

Basis ritz_basis(const Line& line, const Eigen::MatrixXd& shapes) {
  Eigen::VectorXd scale = norms(line, shapes);
  for (double& s : scale) s = s > 0. ? 1. / s : 0.;
  const Eigen::MatrixXd kept =
      shapes.cols() > 0 ? independent(line, shapes * scale.asDiagonal()) : shapes;
  if (kept.cols() == 0)
    refuse("E-CONDENSE-02",
           "a condensed line without dampers has no mode left; expected one mode or more: raise "
           "condense.modes_per_bay or condense.highest_hz");
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      kept.transpose() * (line.stiffness * kept), kept.transpose() * (line.mass * kept));
  refuse_free_mode(std::sqrt(std::max(0., solver.eigenvalues()[0])) / (2. * M_PI));
  return {solver.eigenvalues().cwiseSqrt(), kept * solver.eigenvectors()};
}

Eigen::MatrixXd added_static_shapes(const Line& line, const Eigen::MatrixXd& kept,
                                    const Eigen::MatrixXd& forces) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(line.stiffness);
  Eigen::MatrixXd shapes = factor.solve(forces);
  if (shapes.cols() == 0) return shapes;
  for (int twice = 0; twice < 2; ++twice) {
    const Eigen::VectorXd before = norms(line, shapes);
    shapes -= kept * (kept.transpose() * (line.mass * shapes));
    const Eigen::VectorXd after = norms(line, shapes);
    for (Eigen::Index j = 0; j < shapes.cols(); ++j)  // a kept shape leaves only rounding
      shapes.col(j) *= after[j] > 1e-8 * before[j] ? 1. / after[j] : 0.;
  }
  return independent(line, shapes);
}

Eigen::MatrixXd filled_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index rows) {
  std::vector<Eigen::VectorXd> found;
  for (int j = 0; j < A.outerSize(); ++j)
    if (A.col(j).norm() > 0.) found.emplace_back(A.col(j));
  Eigen::MatrixXd result(rows, static_cast<Eigen::Index>(found.size()));
  for (std::size_t j = 0; j < found.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = found[j];
  return result;
}

Eigen::MatrixXd damper_forces(const Line& line) {
  return filled_columns(line.damping - line.end_damping, line.unknowns());
}

}  // namespace railstep
