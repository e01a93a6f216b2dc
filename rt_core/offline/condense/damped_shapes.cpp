#include "offline/condense/damped_shapes.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/math/complex.h"

namespace railstep {

namespace {

/// Largest difference of rates that count as equal: at least the round-off of the fastest, and at
/// most a part of the rate itself, since slow rates beside very fast ones are distinct.
struct OneRate {
  double fastest;

  [[nodiscard]] double within(double size) const {
    constexpr double kOfFastest = 1e-12, kOfOwn = 1e-9;
    const double round_off = 16. * std::numeric_limits<double>::epsilon() * fastest;
    return std::max(round_off, std::min(kOfFastest * fastest, kOfOwn * size));
  }
  /// The solver may return equal real rates as pairs with imaginary parts of round-off.
  [[nodiscard]] bool real(ComplexNumber rate) const {
    return std::abs(rate.imag()) <= within(std::abs(rate));
  }
  [[nodiscard]] bool same(ComplexNumber a, ComplexNumber b) const {
    const double tolerance = (real(b) ? 2. : 1.) * within(std::abs(b));
    return real(a) == real(b) && std::abs(a - b) <= tolerance;
  }
};

/// Eigenvalues to keep, one of each conjugate pair, slowest first.
std::vector<Eigen::Index> kept(const Eigen::VectorXcd& rates, const OneRate& one) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < rates.size(); ++i)
    if (rates[i].imag() > 0. || one.real(rates[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(rates[a]) < std::abs(rates[b]);
  });
  return order;
}

/// Vectors x with (rate^2 + rate D + Omega^2) x = 0, [kept][count]: what a rank-revealing QR of
/// that matrix, scaled on both sides, leaves last.
Eigen::MatrixXcd null_space(ComplexNumber rate, const Eigen::VectorXd& omega,
                            const Eigen::MatrixXd& damping, Eigen::Index count) {
  const Eigen::Index m = omega.size();
  const Eigen::VectorXd scale = (omega.array() + std::abs(rate)).inverse();
  Eigen::MatrixXcd Z = rate * damping;
  Z.diagonal().array() += rate * rate + omega.array().square();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(scale.asDiagonal() * Z *
                                                        scale.asDiagonal());
  Eigen::MatrixXcd last(m, count);
  last.bottomRows(count).setIdentity();
  last.topRows(m - count) = -qr.matrixR()
                                 .topLeftCorner(m - count, m - count)
                                 .triangularView<Eigen::Upper>()
                                 .solve(qr.matrixR().topRightCorner(m - count, count));
  return scale.asDiagonal() * (qr.colsPermutation() * last);
}

/// Whether columns stand well apart from each other.
bool spread(Eigen::MatrixXcd X) {
  constexpr double kParallel = 1e-4;
  X.colwise().normalize();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(X);
  qr.setThreshold(kParallel);
  return qr.rank() == X.cols();
}

/// Q with Q' P Q = I, the plain transpose, of a symmetric P. The column with the largest product
/// with itself is taken first, or the sum of two with a larger product with each other; it is then
/// removed from the rest.
Eigen::MatrixXcd unit_congruence(Eigen::MatrixXcd P) {
  const Eigen::Index n = P.rows();
  Eigen::MatrixXcd Q = Eigen::MatrixXcd::Identity(n, n);
  for (Eigen::Index done = 0; done < n; ++done) {
    const Eigen::Index left = n - done, rest = left - 1;
    const auto open = P.bottomRightCorner(left, left);
    Eigen::Index i = 0, j = 0, own = 0;
    const double most = open.cwiseAbs().maxCoeff(&i, &j);
    if (open.diagonal().cwiseAbs().maxCoeff(&own) >= .5 * most) {
      i = own;
    } else {
      P.row(done + i) += P.row(done + j);
      P.col(done + i) += P.col(done + j);
      Q.col(done + i) += Q.col(done + j);
    }
    P.row(done).swap(P.row(done + i));
    P.col(done).swap(P.col(done + i));
    Q.col(done).swap(Q.col(done + i));
    const Eigen::VectorXcd share = P.col(done).tail(rest) / P(done, done);
    P.bottomRightCorner(rest, rest) -= share * P.row(done).tail(rest);
    Q.rightCols(rest) -= Q.col(done) * share.transpose();
    Q.col(done) /= std::sqrt(P(done, done));
  }
  return Q;
}

/// Shapes of one rate from those of the solver, with shape' (2 rate + D) shape = I.
Eigen::MatrixXcd shapes_of(ComplexNumber rate, const Eigen::VectorXd& omega,
                           const Eigen::MatrixXd& damping, Eigen::MatrixXcd X) {
  const Eigen::Index count = X.cols();
  if (count > 1) {
    if (count <= X.rows() && !spread(X)) X = null_space(rate, omega, damping, count);
    const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(X);
    X = qr.householderQ() * Eigen::MatrixXcd::Identity(X.rows(), count);
  }
  const Eigen::MatrixXcd with = 2. * rate * X + damping * X;
  return X * unit_congruence(X.transpose() * with);
}

}  // namespace

DampedShapes damped_shapes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& damping,
                           const Eigen::VectorXcd& rates, const Eigen::MatrixXcd& vectors) {
  const OneRate one{rates.cwiseAbs().maxCoeff()};
  std::vector<Eigen::Index> order = kept(rates, one);
  const Eigen::Index m = omega.size(), count = static_cast<Eigen::Index>(order.size());
  DampedShapes modes{Eigen::VectorXcd(count), Eigen::MatrixXcd(m, count)};
  for (auto from = order.begin(); from != order.end();) {
    const ComplexNumber first = rates[*from];
    const auto to = std::stable_partition(
        from, order.end(), [&](Eigen::Index i) { return one.same(rates[i], first); });
    const Eigen::Index begin = from - order.begin(), own = to - from;
    Eigen::MatrixXcd X(m, own);
    ComplexNumber rate = 0.;
    for (Eigen::Index c = 0; c < own; ++c, ++from) {
      X.col(c) = vectors.col(*from).head(m).cwiseQuotient(omega.cast<ComplexNumber>());
      rate += rates[*from] / static_cast<double>(own);
    }
    const bool real = one.real(first);
    if (real) rate = rate.real();
    modes.rate.segment(begin, own).setConstant(rate);
    modes.shape.middleCols(begin, own) =
        shapes_of(rate, omega, damping, X) * (real ? 1. : std::sqrt(2.));
  }
  return modes;
}

}  // namespace railstep
