#include "offline/condense/modal.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/condense/damped_shapes.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kMostIncomplete = 1e-7;  // largest accepted error
constexpr double kMostResidual = 1e-6;    // of a mode's equation, over the sizes of its terms
constexpr double kOrthogonal = 1e-9;      // beyond it the eigen solver's vectors are worked on
constexpr int kMostIterations = 6;        // each squares what is missed: 1e-2 becomes 1e-16 in 3
constexpr double kSquared = 1e-6;         // missed before the last turn

/// Error of Re sum shape shape' = 0 and Re sum rate shape shape' = I.
double incompleteness(const DampedModes& modes) {
  const Eigen::MatrixXd position = (modes.shape * modes.shape.transpose()).real();
  const Eigen::MatrixXd velocity =
      (modes.shape * modes.rate.asDiagonal() * modes.shape.transpose()).real();
  const auto n = velocity.rows();
  if (!position.allFinite() || !velocity.allFinite()) return HUGE_VAL;
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
  double before = HUGE_VAL;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    Eigen::MatrixXcd AV(2 * m, 2 * m);
    AV.topRows(m) = modes.damping * V.topRows(m) + V.bottomRows(m);
    AV.bottomRows(m) = V.topRows(m);
    const Eigen::MatrixXcd W = V.transpose() * AV;
    const double missed =
        (W - Eigen::MatrixXcd::Identity(2 * m, 2 * m)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!(missed < before)) return;  // it leads away
    before = missed;
    V = (1.5 * V - .5 * (V * W)).eval();
    if (missed < kSquared) break;
  }
  for (Eigen::Index k = 0; k < kept; ++k)
    modes.shape.col(k) = V.col(k).head(m) / (modes.rate[k].imag() > 0. ? half : 1.);
}

/// Largest residual of (rate^2 + rate D + Omega^2) shape = 0 over its terms' sizes. It does not
/// include the round-off of the fastest rate, which any eigen solver leaves in the others.
double residual(const DampedModes& modes, const Eigen::VectorXd& omega) {
  const Eigen::MatrixXcd damped = modes.damping * modes.shape;
  const double round_off =
      64. * std::numeric_limits<double>::epsilon() * modes.rate.cwiseAbs().maxCoeff();
  double most = 0.;
  for (Eigen::Index k = 0; k < modes.rate.size(); ++k) {
    const std::complex<double> rate = modes.rate[k];
    const auto x = modes.shape.col(k);
    const Eigen::VectorXcd inertia = rate * rate * x, damper = rate * damped.col(k),
                           spring = omega.cwiseAbs2().cwiseProduct(x);
    const double terms = inertia.norm() + damper.norm() + spring.norm();
    const double unknown = round_off * (2. * rate * x + damped.col(k)).norm();
    most = std::max(most, ((inertia + damper + spring).norm() - unknown) / terms);
  }
  return most;
}

/// Throws Refused if modes share a shape, so that they are not complete.
void complete(DampedModes& modes, const Eigen::VectorXd& omega) {
  if (!(incompleteness(modes) < kOrthogonal) && modes.shape.allFinite()) orthogonalise(modes);
  const double error = incompleteness(modes), off = residual(modes, omega);
  if (error < kMostIncomplete && off < kMostResidual) return;
  std::ostringstream text;
  text << "modes share one shape, because their damping is near to critical (completeness is "
          "missed by "
       << std::setprecision(2) << error << ", their equation by " << off
       << "); change the number of modes, or use condense.kind = \"full\"";
  refuse("E-CONDENSE-15", text.str());
}

}  // namespace

Basis modal_basis(const Line& line, const ModalLimit& limit,
                  const Eigen::SparseMatrix<double>& rows) {
  if (line.unknowns() > kMostModalUnknowns)
    refuse("E-CONDENSE-16",
           "a line of " + std::to_string(line.unknowns()) +
               " unknowns cannot be condensed; expected at most " +
               std::to_string(kMostModalUnknowns) +
               ": use condense.kind = \"full\", a shorter track, or track.length = \"endless\"");
  int count = std::min(limit.most, line.unknowns());
  if (std::isfinite(limit.highest_hz)) count = std::min(count, modes_below(line, limit.highest_hz));
  const Modes lowest = lowest_modes(line, std::max(count, 1));
  refuse_free_mode(lowest.frequency[0]);
  // Unknowns without mass have no modes.
  const Eigen::MatrixXd kept =
      lowest.shape.leftCols(std::min<Eigen::Index>(count, lowest.shape.cols()));
  const Eigen::MatrixXd dampers = damper_forces(line),
                        others = filled_columns(rows, line.unknowns());
  Eigen::MatrixXd forces(line.unknowns(), dampers.cols() + others.cols());
  forces << dampers, others;
  const Eigen::MatrixXd added = added_static_shapes(line, kept, forces);
  Eigen::MatrixXd both(line.unknowns(), kept.cols() + added.cols());
  both << kept, added;
  return ritz_basis(line, both);
}

DampedModes damped_modes(const Basis& basis, const Eigen::SparseMatrix<double>& damping) {
  const auto m = basis.omega.size();
  const Eigen::MatrixXd S = basis.shapes.dense();
  const Eigen::MatrixXd D = S.transpose() * (damping * S);
  // First-order form over (omega y, y'), whose blocks are of one size.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * m, 2 * m);
  A.topRightCorner(m, m).diagonal() = basis.omega;
  A.bottomLeftCorner(m, m).diagonal() = -basis.omega;
  A.bottomRightCorner(m, m) = -D;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    refuse("E-CONDENSE-17",
           "the damped modes of a line were not found; use another condense.kind, or more modes");
  DampedShapes found = damped_shapes(basis.omega, D, solver.eigenvalues(), solver.eigenvectors());
  DampedModes result{std::move(found.rate), std::move(found.shape), D};
  complete(result, basis.omega);
  return result;
}

DampedModes slowest(const DampedModes& all, Eigen::Index most) {
  constexpr double kOneSpeed = 1e-9;
  Eigen::Index count = std::min(most, all.rate.size());
  while (count > 0 && count < all.rate.size() &&
         std::abs(all.rate[count]) <= (1. + kOneSpeed) * std::abs(all.rate[count - 1]))
    --count;
  return {all.rate.head(count), all.shape.leftCols(count), all.damping};
}

Eigen::MatrixXd flexibility_of(const DampedModes& modes) {
  const Eigen::MatrixXd F =
      -(modes.shape * modes.rate.cwiseInverse().asDiagonal() * modes.shape.transpose()).real();
  return .5 * (F + F.transpose());
}

Eigen::MatrixXd at_once_of(const DampedModes& modes) {
  return (modes.shape * modes.shape.transpose()).real();
}

Eigen::VectorXcd DampedModes::from(const Eigen::VectorXd& force,
                                   const Eigen::VectorXd& velocity) const {
  return shape.transpose() * velocity - (shape.transpose() * force).cwiseQuotient(rate);
}

}  // namespace railstep
