#include "offline/condense/modal.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "offline/track/statics.h"

namespace railstep {

namespace {

/// Eigenvalues to keep, one of each conjugate pair, slowest first.
std::vector<Eigen::Index> kept(const Eigen::VectorXcd& rates) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < rates.size(); ++i)
    if (rates[i].imag() >= 0.) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(rates[a]) < std::abs(rates[b]);
  });
  return order;
}

constexpr double kMostIncomplete = 1e-7;  // what is accepted
constexpr double kOrthogonal = 1e-9;      // beyond it the eigen solver's vectors are worked on
constexpr int kMostTurns = 6;             // each squares what is missed: 1e-2 becomes 1e-16 in 3
constexpr double kSquared = 1e-6;         // missed before the last turn

/// What Re sum shape shape' = 0 and Re sum rate shape shape' = I are missed by.
double incompleteness(const DampedModes& modes) {
  const Eigen::MatrixXd position = (modes.shape * modes.shape.transpose()).real();
  const Eigen::MatrixXd velocity =
      (modes.shape * modes.rate.asDiagonal() * modes.shape.transpose()).real();
  const auto n = velocity.rows();
  return std::max((velocity - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(),
                  std::abs(modes.rate[0]) * position.cwiseAbs().maxCoeff());
}

/// Makes shapes of rates that nearly coincide orthogonal to one another. Over all modes, conjugates
/// too and each with norm 1, V = [x; rate x] has V' A V = I with A = [D I; I 0] and the plain
/// transpose; Newton's iteration V (3 I - V' A V) / 2 leads to the nearest V that has it.
void orthogonalise(DampedModes& modes) {
  const Eigen::Index m = modes.shape.rows(), kept = modes.rate.size();
  const double half = std::sqrt(.5);
  Eigen::MatrixXcd V(2 * m, 2 * m);
  Eigen::Index column = kept;
  for (Eigen::Index k = 0; k < kept; ++k) {
    const bool pair = modes.rate[k].imag() > 0.;
    V.col(k).head(m) = modes.shape.col(k) * (pair ? half : 1.);
    V.col(k).tail(m) = modes.rate[k] * V.col(k).head(m);
    if (pair) V.col(column++) = V.col(k).conjugate();
  }
  for (int turn = 0; turn < kMostTurns; ++turn) {
    Eigen::MatrixXcd AV(2 * m, 2 * m);
    AV.topRows(m) = modes.damping * V.topRows(m) + V.bottomRows(m);
    AV.bottomRows(m) = V.topRows(m);
    const Eigen::MatrixXcd W = V.transpose() * AV;
    V = (1.5 * V - .5 * (V * W)).eval();
    if ((W - Eigen::MatrixXcd::Identity(2 * m, 2 * m)).cwiseAbs().maxCoeff() < kSquared) break;
  }
  for (Eigen::Index k = 0; k < kept; ++k)
    modes.shape.col(k) = V.col(k).head(m) / (modes.rate[k].imag() > 0. ? half : 1.);
}

/// Throws where modes share a shape, so that the others cannot be all.
void complete(DampedModes& modes) {
  if (!(incompleteness(modes) < kOrthogonal) && modes.shape.allFinite()) orthogonalise(modes);
  const double error = incompleteness(modes);
  if (!(error < kMostIncomplete))
    throw std::invalid_argument(
        "the damping brings modes so near to critical that they share one shape (completeness is "
        "missed by " +
        std::to_string(error) + "); change the number of modes or step the full track");
}

/// Columns of a matrix that hold anything, none of one without entries.
Eigen::MatrixXd filled_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index rows) {
  std::vector<Eigen::VectorXd> found;
  for (int j = 0; j < A.outerSize(); ++j)
    if (A.col(j).norm() > 0.) found.emplace_back(A.col(j));
  Eigen::MatrixXd result(rows, static_cast<Eigen::Index>(found.size()));
  for (std::size_t j = 0; j < found.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = found[j];
  return result;
}

/// What the static shapes of the dampers and of other rows add to shapes that are kept; orthonormal
/// over the mass.
Eigen::MatrixXd local_shapes(const Line& line, const Eigen::MatrixXd& kept,
                             const Eigen::SparseMatrix<double>& rows) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(line.stiffness);
  // Zones at the ends have as many dampers as unknowns, each too weak to have a shape of its own.
  const Eigen::SparseMatrix<double> of_seats = line.damping - line.end_damping;
  const Eigen::MatrixXd dampers = filled_columns(of_seats, line.unknowns()),
                        others = filled_columns(rows, line.unknowns());
  Eigen::MatrixXd forces(line.unknowns(), dampers.cols() + others.cols());
  forces.leftCols(dampers.cols()) = dampers;
  forces.rightCols(others.cols()) = others;
  Eigen::MatrixXd shapes = factor.solve(forces);
  if (shapes.cols() == 0) return shapes;
  const auto norms = [&]() -> Eigen::VectorXd {
    return shapes.cwiseProduct(line.mass * shapes).colwise().sum().cwiseSqrt().transpose();
  };
  for (int twice = 0; twice < 2; ++twice) {
    const Eigen::VectorXd before = norms();
    shapes -= kept * (kept.transpose() * (line.mass * shapes));
    const Eigen::VectorXd after = norms();
    for (Eigen::Index j = 0; j < shapes.cols(); ++j)  // what is left of a kept shape is rounding
      shapes.col(j) *= after[j] > 1e-8 * before[j] ? 1. / after[j] : 0.;
  }
  // The columns of C have the rank of its dampers; what is left of the others is rounding.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(shapes.transpose() *
                                                            (line.mass * shapes));
  const double largest = gram.eigenvalues().maxCoeff();
  Eigen::Index first = largest > 0. ? 0 : shapes.cols();
  while (first < shapes.cols() && gram.eigenvalues()[first] < 1e-10 * largest) ++first;
  const Eigen::Index rank = shapes.cols() - first;
  Eigen::MatrixXd result = shapes * gram.eigenvectors().rightCols(rank);
  result *= gram.eigenvalues().tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  return result;
}

}  // namespace

Basis modal_basis(const Line& line, const ModalLimit& limit,
                  const Eigen::SparseMatrix<double>& rows) {
  if (line.unknowns() > kMostModalUnknowns)
    throw std::invalid_argument("modes of a line of " + std::to_string(line.unknowns()) +
                                " unknowns; accepted are " + std::to_string(kMostModalUnknowns) +
                                ": step the full track or cut it shorter");
  int count = std::min(limit.most, line.unknowns());
  if (std::isfinite(limit.highest_hz)) count = std::min(count, modes_below(line, limit.highest_hz));
  const Modes lowest = lowest_modes(line, std::max(count, 1));
  if (lowest.frequency[0] < 1e-3)
    throw std::invalid_argument(
        "a condensed track is held in every direction in which it is moved: this one has a free "
        "rigid mode");
  const Eigen::MatrixXd kept = lowest.shape.leftCols(count);
  const Eigen::MatrixXd added = local_shapes(line, kept, rows);
  Eigen::MatrixXd both(line.unknowns(), kept.cols() + added.cols());
  both.leftCols(kept.cols()) = kept;
  both.rightCols(added.cols()) = added;
  if (both.cols() == 0)
    throw std::invalid_argument("a condensed line without dampers keeps one mode or more");
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      both.transpose() * (line.stiffness * both), both.transpose() * (line.mass * both));
  return {solver.eigenvalues().cwiseSqrt(), both * solver.eigenvectors()};
}

DampedModes damped_modes(const Basis& basis, const Eigen::SparseMatrix<double>& damping) {
  const auto m = basis.omega.size();
  DampedModes result;
  result.damping = basis.shapes.transpose() * (damping * basis.shapes);
  // First-order form over (omega y, y'), whose blocks are of one size.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * m, 2 * m);
  A.topRightCorner(m, m).diagonal() = basis.omega;
  A.bottomLeftCorner(m, m).diagonal() = -basis.omega;
  A.bottomRightCorner(m, m) = -result.damping;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw std::invalid_argument("the damped modes of a line were not found");
  const std::vector<Eigen::Index> order = kept(solver.eigenvalues());
  const auto count = static_cast<Eigen::Index>(order.size());
  result.rate.resize(count);
  result.shape.resize(m, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::complex<double> rate = solver.eigenvalues()[order[static_cast<std::size_t>(i)]];
    Eigen::VectorXcd x = solver.eigenvectors()
                             .col(order[static_cast<std::size_t>(i)])
                             .head(m)
                             .cwiseQuotient(basis.omega.cast<std::complex<double>>());
    const std::complex<double> norm = (x.transpose() * (2. * rate * x + result.damping * x))(0, 0);
    result.rate[i] = rate;
    result.shape.col(i) = x * std::sqrt((rate.imag() > 0. ? 2. : 1.) / norm);
  }
  complete(result);
  return result;
}

Eigen::VectorXcd DampedModes::from(const Eigen::VectorXd& y,
                                   const Eigen::VectorXd& velocity) const {
  const Eigen::VectorXd momentum = damping * y + velocity;
  return rate.cwiseProduct(shape.transpose() * y) + shape.transpose() * momentum;
}

}  // namespace railstep
