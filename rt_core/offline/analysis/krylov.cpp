#include "offline/analysis/krylov.h"

#include <algorithm>

#include "offline/analysis/rigid.h"
#include "offline/math/complex.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kExhausted = 1e-13;  // part of a vector that is only rounding
constexpr double kInfinite = 1e-12;   // of the largest |nu| = 1/|rate - shift|: rounding of 0

}  // namespace

Eigen::SparseMatrix<ComplexNumber> dynamic_stiffness(const Line& line, ComplexNumber rate) {
  Eigen::SparseMatrix<ComplexNumber> Q = line.stiffness.cast<ComplexNumber>();
  Q += rate * line.damping.cast<ComplexNumber>();
  Q += rate * rate * line.mass.cast<ComplexNumber>();
  return Q;
}

Krylov::Krylov(const Line& line, ComplexNumber shift)
    : line_(line), shift_(shift), scale_(std::abs(shift)) {
  factor_.compute(dynamic_stiffness(line, shift));
  if (factor_.info() != Eigen::Success)
    fail("E-MODES-07",
         "the dynamic stiffness of the track cannot be factored; expected stiffnesses and masses "
         "that differ by fewer orders of magnitude");
  basis_ = start_block(2 * line.unknowns(), 1).cast<ComplexNumber>();
  basis_ /= basis_.norm();
  projection_.resize(1, 0);
}

/// [x, y] with (A - shift) [x, y] = [u, v]: y = shift x + u, Q(shift) x = -(M v + C u + shift M u).
Eigen::VectorXcd Krylov::apply(const Eigen::VectorXcd& state) const {
  const Eigen::Index n = line_.unknowns();
  const Eigen::VectorXcd u = state.head(n), v = scale_ * state.tail(n);
  const Eigen::VectorXcd moved = v + shift_ * u;
  const Eigen::VectorXcd force =
      -(line_.mass.cast<ComplexNumber>() * moved + line_.damping.cast<ComplexNumber>() * u);
  Eigen::VectorXcd result(2 * n);
  result.head(n) = factor_.solve(force);
  result.tail(n) = (shift_ * result.head(n) + u) / scale_;
  return result;
}

void Krylov::grow(Eigen::Index size) {
  const Eigen::Index most = std::min<Eigen::Index>(size, basis_.rows());
  if (complete_ || most <= size_) return;
  basis_.conservativeResize(Eigen::NoChange, most + 1);
  Eigen::MatrixXcd projection = Eigen::MatrixXcd::Zero(most + 1, most);
  projection.topLeftCorner(size_ + 1, size_) = projection_.topLeftCorner(size_ + 1, size_);
  projection_ = std::move(projection);
  for (; size_ < most; ++size_) {
    const auto known = basis_.leftCols(size_ + 1);
    Eigen::VectorXcd next = apply(basis_.col(size_));
    const double before = next.norm();
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXcd part = known.adjoint() * next;
      next -= known * part;
      projection_.col(size_).head(size_ + 1) += part;
    }
    const double left = next.norm();
    complete_ = left <= kExhausted * before || size_ + 1 == basis_.rows();
    if (complete_) {
      ++size_;
      return;
    }
    projection_(size_ + 1, size_) = left;
    basis_.col(size_ + 1) = next / left;
  }
}

std::vector<Krylov::Ritz> Krylov::within(double radius) const {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(projection_.topLeftCorner(size_, size_));
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  const double outside = complete_ ? 0. : projection_(size_, size_ - 1).real();
  std::vector<Ritz> found;
  for (Eigen::Index i = 0; i < size_; ++i) {
    const ComplexNumber nu = solver.eigenvalues()[i];
    if (std::abs(nu) * radius < 1. || std::abs(nu) < kInfinite * largest) continue;
    const ComplexNumber rate = shift_ + 1. / nu;
    const auto weights = solver.eigenvectors().col(i);
    Eigen::VectorXcd shape = basis_.topLeftCorner(line_.unknowns(), size_) * weights;
    shape /= shape.norm();
    const double error = outside * std::abs(weights[size_ - 1]) / std::norm(nu) / std::abs(rate);
    found.push_back({rate, std::move(shape), error});
  }
  return found;
}

}  // namespace railstep
