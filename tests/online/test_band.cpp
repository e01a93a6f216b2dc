#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "offline/pack/band_factor.h"
#include "online/math/dense.h"
#include "online/math/diagonals.h"
#include "online/model/caps.h"

// The references use long double on purpose; clang warns of these promotions.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

constexpr double kEps = 0x1p-52;

/// Random symmetric band matrix with a diagonal that makes it positive definite by `margin` times
/// the row sum (Gershgorin), rows and columns then scaled over six decades like forces and slopes.
Eigen::MatrixXd random_band(int n, int bandwidth, double margin, std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - bandwidth); j < i; ++j) A(i, j) = A(j, i) = entry(random);
  for (int i = 0; i < n; ++i) A(i, i) = (1.0 + margin) * A.row(i).cwiseAbs().sum() + 1e-3;
  Eigen::VectorXd scale(n);
  for (int i = 0; i < n; ++i) scale(i) = i % 3 == 0 ? 1e3 : 1.0;
  return scale.asDiagonal() * A * scale.asDiagonal();
}

std::vector<double> padded(const Eigen::VectorXd& b, int panels) {
  std::vector<double> x(static_cast<std::size_t>(panels * kLanes), 0.0);
  std::copy(b.data(), b.data() + b.size(), x.begin());
  return x;
}

/// Componentwise backward error max |A x - b|_i / (|A| |x| + |b|)_i, in units of eps.
double backward_error(const Eigen::MatrixXd& A, const Eigen::VectorXd& x,
                      const Eigen::VectorXd& b) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    long double residual = -b(i), size = std::abs(b(i));
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      residual += static_cast<long double>(A(i, j)) * x(j);
      size += std::abs(A(i, j) * x(j));
    }
    worst = std::max(worst, static_cast<double>(std::abs(residual) / size) / kEps);
  }
  return worst;
}

}  // namespace

TEST_CASE("the band solve is backward stable for every size and bandwidth", "[band]") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double worst = 0.0, worst_dense = 0.0;
  for (int n : {1, 2, 7, 8, 9, 15, 16, 17, 31, 64, 65, 100, 168, 203})
    for (int bandwidth : {0, 1, 3, 7, 8, 9, 17, 26, 40, 250})
      for (double margin : {1e-6, 0.1}) {
        const Eigen::MatrixXd A = random_band(n, bandwidth, margin, random);
        const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
        const BandFactor factor = factor_band(A.sparseView());
        std::vector<double> x = padded(b, factor.panels);
        solve_band(factor.view(), x.data());
        const Eigen::VectorXd got = Eigen::Map<Eigen::VectorXd>(x.data(), n);
        const Eigen::VectorXd dense = A.ldlt().solve(b);
        worst = std::max(worst, backward_error(A, got, b));
        worst_dense = std::max(worst_dense, backward_error(A, dense, b));
        for (std::size_t i = static_cast<std::size_t>(n); i < x.size(); ++i) CHECK(x[i] == 0.0);
        // Both are backward stable, so they differ by a few eps times the condition of these
        // matrices: scaled by rows it is below 2/margin. Width + 8 products are summed per unknown.
        const double scale = dense.cwiseAbs().maxCoeff();
        CHECK((got - dense).cwiseAbs().maxCoeff() <= 2e6 * (bandwidth + 8) * kEps * scale);
      }
  INFO("componentwise backward error / eps: band " << worst << ", Eigen LDLT " << worst_dense);
  // Higham, Accuracy and Stability, th. 9.3 for dominant matrices: a small multiple of the sums'
  // length, at most (203 + 8). Rounding errors do not all add up, so the bound is loose.
  CHECK(worst < 203 + 8);
}

TEST_CASE("a matrix that is not positive definite is refused with the number of its unknown",
          "[band]") {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(20, 20);
  A(13, 13) = -1.0;
  CHECK_THROWS_WITH(factor_band(A.sparseView()),
                    Catch::Contains("unknown 13") && Catch::Contains("E-PACK-02"));
  A(13, 13) = std::nan("");
  CHECK_THROWS_WITH(factor_band(A.sparseView()),
                    Catch::Contains("unknown 13") && Catch::Contains("E-PACK-02"));
  CHECK_THROWS_WITH(factor_band(Eigen::SparseMatrix<double>(2, 3)),
                    Catch::Contains("2 by 3") && Catch::Contains("E-PACK-03"));
}

TEST_CASE("the small solve is exact to rounding and refuses a matrix that is not positive definite",
          "[dense]") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int n = 0; n <= kPorts; ++n) {
    Eigen::MatrixXd A = random_band(n, n, 1e-3, random);
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    Eigen::VectorXd x = b;
    Eigen::MatrixXd work = A;
    REQUIRE(solve_small(work.data(), x.data(), n) == SmallSolve::solved);
    CHECK(backward_error(A, x, b) <= 3 * n);  // Higham, th. 10.4: (3n + 1) eps
    if (n == 0) continue;
    work = A;
    work(n - 1, n - 1) = -1.0;
    CHECK(solve_small(work.data(), x.data(), n) == SmallSolve::indefinite);
    work = A;
    work(n / 2, n / 2) = std::nan("");
    CHECK(solve_small(work.data(), x.data(), n) == SmallSolve::not_finite);
  }
}

TEST_CASE("the product by diagonals is the matrix product, clipped at both ends", "[diagonals]") {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const int n = 40;
  const std::vector<int> offset{-39, -9, -1, 0, 2, 8, 31};
  std::vector<double> value(offset.size() * n), x(n), y(n), want(n);
  for (double& a : value) a = normal(random);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    x[k] = normal(random);
    want[k] = y[k] = normal(random);
  }
  for (int i = 0; i < n; ++i)
    for (std::size_t o = 0; o < offset.size(); ++o) {
      const int j = i + offset[o];
      if (j < 0 || j >= n) {
        value[o * n + static_cast<std::size_t>(i)] = std::nan("");  // must never be read
        continue;
      }
      want[static_cast<std::size_t>(i)] +=
          value[o * n + static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(j)];
    }
  diagonals_multiply_add({n, static_cast<int>(offset.size()), offset.data(), value.data()},
                         x.data(), y.data());
  for (int i = 0; i < n; ++i)
    CHECK(y[static_cast<std::size_t>(i)] == want[static_cast<std::size_t>(i)]);
}
