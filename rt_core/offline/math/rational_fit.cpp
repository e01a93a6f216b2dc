#include "offline/math/rational_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <limits>

namespace railstep {

namespace {

/// A vector whose product with the matrix is nearly 0, by inverse iteration on the triangle of its
/// QR.
Eigen::VectorXcd null_vector(const Eigen::MatrixXcd& of) {
  const Eigen::Index n = of.cols();
  Eigen::MatrixXcd triangle = Eigen::HouseholderQR<Eigen::MatrixXcd>(of).matrixQR().topRows(n);
  const double least =
      std::numeric_limits<double>::epsilon() * triangle.diagonal().cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i)
    if (std::abs(triangle(i, i)) < least) triangle(i, i) = least;
  const auto upper = triangle.triangularView<Eigen::Upper>();
  Eigen::VectorXcd found = Eigen::VectorXcd::Ones(n);
  for (int twice = 0; twice < 2; ++twice) {
    found = upper.solve(upper.adjoint().solve(found));
    found /= found.norm();
  }
  return found;
}

}  // namespace

RationalFit::RationalFit(const std::vector<double>& places, const Eigen::MatrixXcd& values,
                         int first) {
  std::vector<Eigen::Index> met, fitted;
  for (Eigen::Index i = 0; i < values.cols(); ++i) (i % 2 == first ? met : fitted).push_back(i);
  values_ = values(Eigen::all, met);
  for (const Eigen::Index i : met) places_.push_back(places[static_cast<std::size_t>(i)]);
  const Eigen::Index functions = values.rows(), n = values_.cols();
  // sum_j w_j (f_i - f_j) / (x_i - x_j) = 0, of every function over its own largest
  Eigen::MatrixXcd loewner(
      std::max<Eigen::Index>(functions * static_cast<Eigen::Index>(fitted.size()), n), n);
  loewner.setZero();
  const Eigen::VectorXd sizes = values.cwiseAbs().rowwise().maxCoeff();
  Eigen::Index row = 0;
  for (const Eigen::Index i : fitted)
    for (Eigen::Index f = 0; f < functions; ++f, ++row) {
      if (sizes[f] == 0.) continue;
      for (Eigen::Index j = 0; j < n; ++j)
        loewner(row, j) =
            (values(f, i) - values_(f, j)) / sizes[f] /
            (places[static_cast<std::size_t>(i)] - places_[static_cast<std::size_t>(j)]);
    }
  weights_ = null_vector(loewner);
}

Eigen::VectorXcd RationalFit::at(double x) const {
  Eigen::VectorXcd parts(weights_.size());
  for (Eigen::Index j = 0; j < parts.size(); ++j) {
    const double off = x - places_[static_cast<std::size_t>(j)];
    if (off == 0.) return values_.col(j);
    parts[j] = weights_[j] / off;
  }
  return values_ * parts / parts.sum();
}

}  // namespace railstep
