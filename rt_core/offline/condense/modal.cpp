#include "offline/condense/modal.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
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

constexpr double kOneRate = 1e-12;        // of the fastest: rates this close are one
constexpr double kMostIncomplete = 1e-7;  // what is accepted
constexpr double kOrthogonal = 1e-9;      // beyond it the eigen solver's vectors are worked on
constexpr int kMostTurns = 6;             // each squares what is missed: 1e-2 becomes 1e-16 in 3
constexpr double kSquared = 1e-6;         // missed before the last turn

/// Puts rates that are one next to each other, and gives all of them their mean: the solver tells
/// them no better apart.
/// @return  where each group of one rate begins, and the end
std::vector<Eigen::Index> group(const Eigen::VectorXcd& rates, std::vector<Eigen::Index>& order,
                                Eigen::VectorXcd& grouped) {
  const double one = kOneRate * rates.cwiseAbs().maxCoeff();
  std::vector<Eigen::Index> begins;
  grouped.resize(static_cast<Eigen::Index>(order.size()));
  for (auto from = order.begin(); from != order.end();) {
    const std::complex<double> rate = rates[*from];
    const auto to = std::stable_partition(from, order.end(), [&](Eigen::Index i) {
      return std::abs(rates[i] - rate) <= one && (rates[i].imag() > 0.) == (rate.imag() > 0.);
    });
    std::complex<double> sum = 0.;
    for (auto i = from; i != to; ++i) sum += rates[*i];
    begins.push_back(from - order.begin());
    grouped.segment(begins.back(), to - from).setConstant(sum / static_cast<double>(to - from));
    from = to;
  }
  begins.push_back(static_cast<Eigen::Index>(order.size()));
  return begins;
}

/// Q with Q' P Q = I, the plain transpose, of a symmetric P. What has the largest product with
/// itself is taken first, or the sum of two that have a larger one with each other; the rest is
/// freed of it.
Eigen::MatrixXcd unit_congruence(Eigen::MatrixXcd P) {
  const Eigen::Index n = P.rows();
  Eigen::MatrixXcd Q = Eigen::MatrixXcd::Identity(n, n);
  for (Eigen::Index done = 0; done < n; ++done) {
    const auto left = P.bottomRightCorner(n - done, n - done);
    Eigen::Index i = 0, j = 0, own = 0;
    const double most = left.cwiseAbs().maxCoeff(&i, &j);
    const bool alone = left.diagonal().cwiseAbs().maxCoeff(&own) >= .5 * most;
    Eigen::MatrixXcd T = Eigen::MatrixXcd::Identity(n, n);
    if (!alone) T(done + j, done + i) = 1.;
    T.col(done + (alone ? own : i)).swap(T.col(done));
    P = (T.transpose() * P * T).eval();
    const std::complex<double> root = std::sqrt(P(done, done));
    Eigen::MatrixXcd freed = Eigen::MatrixXcd::Identity(n, n);
    freed.row(done).tail(n - done - 1) = -P.row(done).tail(n - done - 1) / P(done, done);
    freed(done, done) = 1. / root;
    P = (freed.transpose() * P * freed).eval();
    Q = (Q * T * freed).eval();
  }
  return Q;
}

/// Mixes shapes X of one rate so that X' (2 rate + D) X = I with the plain transpose. Any mixture
/// of them is a shape as well, and the solver's may have products of 0 with themselves.
void normalise(std::complex<double> rate, const Eigen::MatrixXd& damping,
               Eigen::Ref<Eigen::MatrixXcd> X) {
  if (X.cols() > 1)
    X = Eigen::MatrixXcd(Eigen::HouseholderQR<Eigen::MatrixXcd>(X).householderQ() *
                         Eigen::MatrixXcd::Identity(X.rows(), X.cols()));
  const Eigen::MatrixXcd with = 2. * rate * X + damping * X;
  X = (X * unit_congruence(X.transpose() * with)).eval();
}

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
  if (error < kMostIncomplete) return;
  std::ostringstream text;
  text << "modes share one shape, as their damping is near to critical (completeness is missed "
          "by "
       << std::setprecision(2) << error << "); change the number of modes, or step the full track";
  throw std::invalid_argument(text.str());
}

}  // namespace

Basis modal_basis(const Line& line, const ModalLimit& limit,
                  const Eigen::SparseMatrix<double>& rows) {
  if (line.unknowns() > kMostModalUnknowns)
    throw std::invalid_argument(
        "modes of a line of " + std::to_string(line.unknowns()) + " unknowns; accepted are " +
        std::to_string(kMostModalUnknowns) +
        ": step it in full order, cut it shorter, or drive on a track without end");
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
  DampedModes result;
  const Eigen::MatrixXd S = basis.shapes.dense();
  result.damping = S.transpose() * (damping * S);
  // First-order form over (omega y, y'), whose blocks are of one size.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * m, 2 * m);
  A.topRightCorner(m, m).diagonal() = basis.omega;
  A.bottomLeftCorner(m, m).diagonal() = -basis.omega;
  A.bottomRightCorner(m, m) = -result.damping;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw std::invalid_argument("the damped modes of a line were not found");
  std::vector<Eigen::Index> order = kept(solver.eigenvalues());
  const std::vector<Eigen::Index> begins = group(solver.eigenvalues(), order, result.rate);
  result.shape.resize(m, result.rate.size());
  for (Eigen::Index i = 0; i < result.rate.size(); ++i)
    result.shape.col(i) = solver.eigenvectors()
                              .col(order[static_cast<std::size_t>(i)])
                              .head(m)
                              .cwiseQuotient(basis.omega.cast<std::complex<double>>());
  for (std::size_t g = 0; g + 1 < begins.size(); ++g) {
    auto shapes = result.shape.middleCols(begins[g], begins[g + 1] - begins[g]);
    normalise(result.rate[begins[g]], result.damping, shapes);
    if (result.rate[begins[g]].imag() > 0.) shapes *= std::sqrt(2.);
  }
  complete(result);
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

Eigen::VectorXcd DampedModes::from(const Eigen::VectorXd& y,
                                   const Eigen::VectorXd& velocity) const {
  const Eigen::VectorXd momentum = damping * y + velocity;
  return rate.cwiseProduct(shape.transpose() * y) + shape.transpose() * momentum;
}

}  // namespace railstep
