#include "offline/analysis/modes.h"

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "offline/analysis/massless.h"
#include "offline/analysis/rigid.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMostDenseUnknowns = 4000;  // a dense solution takes some n^3 10 flops

/// The first `rigid` of ascending eigenvalues are 0. Another eigenvalue below 0 has no frequency.
Modes of_squares(const Eigen::VectorXd& squares, const Eigen::MatrixXd& shapes,
                 Eigen::Index rigid) {
  Modes result{Eigen::VectorXd(squares.size()), shapes};
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    if (i >= rigid && squares[i] < 0.)
      refuse("E-MODES-09",
             "the stiffness of the track is not positive, so that a mode would grow without bound; "
             "expected less compression, or the default [rail.rule]");
    result.frequency[i] = i < rigid ? 0. : std::sqrt(squares[i]) / (2. * kPi);
    Eigen::Index largest = 0;
    result.shape.col(i).cwiseAbs().maxCoeff(&largest);
    if (result.shape(largest, i) < 0.) result.shape.col(i) *= -1.;
  }
  return result;
}

/// Eigenvalues of K - square M below zero, by Sylvester's law from the pivots of its factor.
int below(const MassiveLine& line, double square) {
  const Eigen::SparseMatrix<double> shifted = line.stiffness - square * line.mass;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(shifted);
  if (factor.info() != Eigen::Success) return -1;
  return static_cast<int>((factor.vectorD().array() < 0.).count());
}

/// (K - shift M)^-1 with the rigid modes R sent from eigenvalue 0 up to `far`, out of the way:
/// Lanczos from one vector would meet only one of those that share an eigenvalue. On them it is
/// 1/(-shift), so that R (1/(-shift) - 1/(far - shift)) R' is taken off.
class Inverse {
 public:
  using Scalar = double;
  Inverse(const MassiveLine& line, Eigen::MatrixXd rigid, double far)
      : line_(line), rigid_(std::move(rigid)), far_(far) {}
  Eigen::Index rows() const { return line_.stiffness.rows(); }
  Eigen::Index cols() const { return rows(); }
  void set_shift(double shift) {
    lost_ = 1. / -shift - 1. / (far_ - shift);
    factor_.compute(Eigen::SparseMatrix<double>(line_.stiffness - shift * line_.mass));
    if (factor_.info() != Eigen::Success)
      refuse("E-TRACK-37",
             "the stiffness of the track cannot be factored; expected stiffnesses that differ by "
             "fewer orders of magnitude");
  }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    Eigen::Map<Eigen::VectorXd> y(out, rows());
    y = factor_.solve(x);
    if (rigid_.cols() > 0) y -= lost_ * (rigid_ * (rigid_.transpose() * x));
  }

 private:
  const MassiveLine& line_;
  Eigen::MatrixXd rigid_;
  double far_, lost_ = 0.;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// The largest relative residual of the forces of undamped modes.
double largest_residual(const MassiveLine& line, const Eigen::VectorXd& squares,
                        const Eigen::MatrixXd& shapes) {
  const Eigen::MatrixXd elastic = line.stiffness * shapes;
  const Eigen::MatrixXd inertia = line.mass * shapes * squares.asDiagonal();
  const Eigen::VectorXd left = (elastic - inertia).colwise().norm();
  const Eigen::VectorXd size = elastic.colwise().norm() + inertia.colwise().norm();
  return left.cwiseQuotient(size).maxCoeff();
}

/// Lanczos for `count` modes above the rigid ones, ascending; nothing if it does not converge or if
/// the pivots show that it left one out. @param room dimension of the Krylov space
std::optional<Modes> lanczos(const MassiveLine& line, const Eigen::MatrixXd& rigid, int count,
                             int room) {
  const Eigen::Index held = rigid.cols();
  const double highest = Eigen::VectorXd(line.stiffness.diagonal())
                             .cwiseQuotient(Eigen::VectorXd(line.mass.diagonal()))
                             .maxCoeff();
  Inverse inverse(line, rigid, highest);
  Spectra::SparseSymMatProd<double> product(line.mass);
  const double shift = -std::pow(2. * kPi, 2);  // -(1 Hz)^2: a free line can be factored too
  Spectra::SymGEigsShiftSolver<Inverse, Spectra::SparseSymMatProd<double>,
                               Spectra::GEigsMode::ShiftInvert>
      solver(inverse, product, count, room, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-12);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  Eigen::VectorXd squares = solver.eigenvalues();
  Eigen::MatrixXd shapes = solver.eigenvectors();
  // Rounding leaves some 1e-16 of the forces in single elements: 1e-7 in long waves.
  if (!(largest_residual(line, squares, shapes) < 1e-5)) return std::nullopt;
  if (squares[0] > squares[count - 1]) {
    squares.reverseInPlace();
    shapes = shapes.rowwise().reverse().eval();
  }
  const double last = squares[count - 1], gap = 1e-9 * std::abs(last);
  const auto found = (squares.array() < last - gap).count() + held;
  if (below(line, last - gap) != static_cast<int>(found)) return std::nullopt;
  Eigen::VectorXd all_squares(held + count);
  Eigen::MatrixXd all_shapes(shapes.rows(), held + count);
  all_squares << Eigen::VectorXd::Zero(held), squares;
  all_shapes << rigid, shapes;
  return of_squares(all_squares, line.follow * all_shapes, held);
}

}  // namespace

Modes modes(const Line& line) {
  const MassiveLine massive = without_massless(line);
  if (massive.mass.rows() == 0) return {Eigen::VectorXd(0), Eigen::MatrixXd(line.unknowns(), 0)};
  const Eigen::MatrixXd K(massive.stiffness), M(massive.mass);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  if (solver.info() != Eigen::Success)
    refuse("E-MODES-11",
           "the modes of the track were not found; expected masses and inertias that are not "
           "negative");
  Eigen::Index rigid = 0;
  while (rigid < K.rows() && is_rigid(massive.stiffness, solver.eigenvectors().col(rigid))) ++rigid;
  return of_squares(solver.eigenvalues(), massive.follow * solver.eigenvectors(), rigid);
}

Modes lowest_modes(const Line& line, int count) {
  const MassiveLine massive = without_massless(line);
  const int n = static_cast<int>(massive.mass.rows());
  const auto first = [count](const Modes& all) {
    const Eigen::Index kept = std::min<Eigen::Index>(count, all.frequency.size());
    return Modes{all.frequency.head(kept), all.shape.leftCols(kept)};
  };
  if (count < 1 || 4 * count > n) return first(modes(line));
  const Eigen::MatrixXd rigid = rigid_modes(massive.stiffness, massive.mass);
  const int sought = std::max(1, count - static_cast<int>(rigid.cols()));
  for (const int room : {2 * sought + 20, 5 * sought + 60})
    if (const auto found = lanczos(massive, rigid, sought, std::min(n, room))) return first(*found);
  if (n > kMostDenseUnknowns)
    fail("E-MODES-12",
         "the lowest " + std::to_string(count) + " modes of a line of " + std::to_string(n) +
             " unknowns were not all found; ask for fewer modes or shorten the track");
  return first(modes(line));
}

int modes_below(const Line& line, double frequency) {
  const MassiveLine massive = without_massless(line);
  const double square = std::pow(2. * kPi * frequency, 2);
  const int count = below(massive, square);
  return count >= 0 ? count : below(massive, square * (1. + 1e-9));
}

}  // namespace railstep
