#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "offline/track/statics.h"

namespace railstep {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Eigenvalues ascending; those that rounding of the largest one makes are rigid modes.
Modes of_squares(const Eigen::VectorXd& squares, const Eigen::MatrixXd& shapes, double rounding) {
  Modes result{Eigen::VectorXd(squares.size()), shapes};
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    result.frequency[i] = squares[i] < rounding ? 0. : std::sqrt(squares[i]) / (2. * kPi);
    Eigen::Index largest = 0;
    result.shape.col(i).cwiseAbs().maxCoeff(&largest);
    if (result.shape(largest, i) < 0.) result.shape.col(i) *= -1.;
  }
  return result;
}

/// Eigenvalues of K - square M below zero, by Sylvester's law from the pivots of its factor.
int below(const Line& line, double square) {
  const Eigen::SparseMatrix<double> shifted = line.stiffness - square * line.mass;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(shifted);
  if (factor.info() != Eigen::Success) return -1;
  return static_cast<int>((factor.vectorD().array() < 0.).count());
}

}  // namespace

Modes modes(const Line& line) {
  const Eigen::MatrixXd K(line.stiffness), M(line.mass);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  if (solver.info() != Eigen::Success)
    throw std::invalid_argument("the modes of a line were not found: is a mass zero or negative?");
  return of_squares(solver.eigenvalues(), solver.eigenvectors(),
                    1e-12 * solver.eigenvalues()[K.rows() - 1]);
}

Modes lowest_modes(const Line& line, int count) {
  const int n = line.unknowns();
  const auto dense = [&] {
    const Modes all = modes(line);
    const Eigen::Index kept = std::min<Eigen::Index>(count, all.frequency.size());
    return Modes{all.frequency.head(kept), all.shape.leftCols(kept)};
  };
  if (count < 1 || 4 * count > n) return dense();
  using Invert = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
  using Product = Spectra::SparseSymMatProd<double>;
  Invert invert(line.stiffness, line.mass);
  Product product(line.mass);
  const double shift = -std::pow(2. * kPi, 2);  // -(1 Hz)^2: a free line can be factored too
  Spectra::SymGEigsShiftSolver<Invert, Product, Spectra::GEigsMode::ShiftInvert> solver(
      invert, product, count, std::min(n, 2 * count + 20), shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-12);
  if (solver.info() != Spectra::CompInfo::Successful) return dense();
  const Eigen::VectorXd squares = solver.eigenvalues().reverse();
  const double gap = 1e-9 * std::abs(squares[count - 1]);
  const double first = squares.minCoeff(), last = squares.maxCoeff();
  const auto found = static_cast<int>((squares.array() < last - gap).count());
  if (below(line, last - gap) != found) return dense();
  const bool ascending = squares[0] == first;
  const Eigen::MatrixXd shapes = solver.eigenvectors();
  return ascending ? of_squares(squares, shapes.rowwise().reverse(), 1e-12 * last)
                   : of_squares(squares.reverse(), shapes, 1e-12 * last);
}

int modes_below(const Line& line, double frequency) {
  const double square = std::pow(2. * kPi * frequency, 2);
  const int count = below(line, square);
  return count >= 0 ? count : below(line, square * (1. + 1e-9));
}

}  // namespace railstep
