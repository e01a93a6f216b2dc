#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/condense/damped_shapes.h"
#include "offline/condense/modal.h"
#include "support/condensed_tracks.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Value = std::complex<double>;

/// Lines of the tracks under test, but for those without stiffness along x.
std::vector<Line> lines_under_test() {
  std::vector<Line> all;
  for (const Track& track : {peers_pair(1), s1_track(8, 2), paper_track()})
    for (Line& line : assemble(track)) all.push_back(std::move(line));
  return all;
}

Basis basis_of(const Line& line, int modes) { return modal_basis(line, {modes, kUnlimited}); }

/// Part of a shape outside the span of a basis, over its size, in norms over the mass.
double outside(const Line& line, const Basis& basis, const Eigen::VectorXd& shape) {
  const Eigen::VectorXd within = basis.shapes.displacement(basis.shapes.project(line.mass * shape));
  const Eigen::VectorXd left = shape - within;
  return std::sqrt(left.dot(line.mass * left) / shape.dot(line.mass * shape));
}

/// Largest relative residual of (rate^2 + rate D + Omega^2) shape = 0.
double residual(const Basis& basis, const DampedModes& modes) {
  const Eigen::MatrixXcd D = modes.damping.cast<Value>();
  const Eigen::VectorXd stiffness = basis.omega.cwiseAbs2();
  double largest = 0.;
  for (Eigen::Index k = 0; k < modes.rate.size(); ++k) {
    const Value rate = modes.rate[k];
    const Eigen::VectorXcd x = modes.shape.col(k);
    const Eigen::VectorXcd inertia = rate * rate * x, damper = rate * (D * x),
                           spring = stiffness.cast<Value>().cwiseProduct(x);
    largest = std::max(largest, (inertia + damper + spring).norm() /
                                    (inertia.norm() + damper.norm() + spring.norm()));
  }
  return largest;
}

/// Largest error of Re sum shape shape' = 0 and Re sum rate shape shape' = I.
double incompleteness(const DampedModes& modes) {
  const Eigen::MatrixXd position = (modes.shape * modes.shape.transpose()).real();
  const Eigen::MatrixXd velocity =
      (modes.shape * modes.rate.asDiagonal() * modes.shape.transpose()).real();
  const auto identity = Eigen::MatrixXd::Identity(velocity.rows(), velocity.cols());
  return std::max((velocity - identity).cwiseAbs().maxCoeff(),
                  std::abs(modes.rate[0]) * position.cwiseAbs().maxCoeff());
}

/// Modes of one coordinate y'' + c y' + omega^2 y.
DampedModes one_coordinate(double omega, double c) {
  Eigen::SparseMatrix<double> damping(1, 1);
  damping.insert(0, 0) = c;
  return damped_modes({Eigen::VectorXd::Constant(1, omega), Eigen::MatrixXd::Identity(1, 1)},
                      damping);
}

}  // namespace

TEST_CASE("the basis is orthonormal over the mass and makes the stiffness diagonal", "[modal]") {
  for (const Line& line : lines_under_test()) {
    const Basis basis = basis_of(line, 8);
    const auto m = basis.omega.size();
    CHECK(basis.omega.minCoeff() > 0.);
    CHECK(std::is_sorted(basis.omega.begin(), basis.omega.end()));
    const Eigen::MatrixXd S = basis.shapes.dense();
    const Eigen::MatrixXd mass = S.transpose() * (line.mass * S);
    const Eigen::MatrixXd stiffness = S.transpose() * (line.stiffness * S);
    const Eigen::MatrixXd square = basis.omega.cwiseAbs2().asDiagonal();
    // Sums of some hundred terms of size 1, with room of 1e4 for cancellation within shapes.
    CHECK((mass - Eigen::MatrixXd::Identity(m, m)).cwiseAbs().maxCoeff() < 1e-10);
    // The same, over the largest of the basis.
    CHECK((stiffness - square).cwiseAbs().maxCoeff() < 1e-10 * square.maxCoeff());
  }
}

TEST_CASE("the basis spans the lowest modes and the shapes that dampers need", "[modal]") {
  for (const Line& line : lines_under_test()) {
    const Basis basis = basis_of(line, 8);
    const Modes all = modes(line);
    for (Eigen::Index k = 0; k < 8; ++k)
      CHECK(outside(line, basis, all.shape.col(k)) < 1e-7);  // rounding as a root of 1e-14
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(line.stiffness);
    const Basis bare{2. * M_PI * all.frequency.head(8), all.shape.leftCols(8)};
    double most_by_modes = 0.;
    for (int j = 0; j < line.damping.outerSize(); ++j) {
      if (line.damping.col(j).norm() == 0.) continue;
      const Eigen::VectorXd shape = factor.solve(Eigen::VectorXd(line.damping.col(j)));
      most_by_modes = std::max(most_by_modes, outside(line, bare, shape));
      // Directions below 1e-10 of the largest Gram eigenvalue are dropped: 1e-5 of a shape.
      CHECK(outside(line, basis, shape) < 1e-5);
    }
    // The lowest modes must miss ten times what the basis may miss, or the test asks nothing.
    if (line.damping.norm() > 0.) CHECK(most_by_modes > 1e-4);
  }
}

TEST_CASE("each damper adds one shape", "[modal]") {
  // 17 seats of one rail of 16 bays; with sleepers, a pad and the ballast at each.
  CHECK(basis_of(assemble(peers_pair(1))[0], 16).omega.size() == 16 + 17);
  Track sleepers = s1_track(16, 1);
  sleepers.unknowns = Unknowns::vertical;
  sleepers.support.damping = {0., 0., 20e3};  // on the foot a damper along x would meet slopes
  CHECK(basis_of(assemble(sleepers)[0], 16).omega.size() == 16 + 34);
}

TEST_CASE("damped modes are complete and solve their equation", "[modal]") {
  bool overdamped = false;
  for (const Line& line : lines_under_test()) {
    const Basis basis = basis_of(line, 8);
    const DampedModes modes = damped_modes(basis, line.damping);
    // The eigen solver is backward stable: some hundred eps times the spread of the rates, 1e4.
    CHECK(residual(basis, modes) < 1e-9);
    CHECK(incompleteness(modes) < 1e-9);
    CHECK(modes.rate.real().maxCoeff() <= 1e-9 * modes.rate.cwiseAbs().maxCoeff());
    for (const Value rate : modes.rate) overdamped = overdamped || rate.imag() == 0.;
  }
  CHECK(overdamped);  // dampers of 29e6 N s/m are among them
}

TEST_CASE("modes of a line without dampers do not decay", "[modal]") {
  Track track = peers_pair(1);
  track.support.damping = {};
  const Line line = assemble(track)[0];
  const Basis basis = basis_of(line, 16);
  CHECK(basis.omega.size() == 16);
  const DampedModes modes = damped_modes(basis, line.damping);
  REQUIRE(modes.rate.size() == 16);
  for (Eigen::Index k = 0; k < 16; ++k) {
    // Backward error of a skew matrix: eps times its norm, with room for its size.
    CHECK(std::abs(modes.rate[k].real()) < 1e-12 * basis.omega[15]);
    CHECK_THAT(modes.rate[k].imag(), WithinAbs(basis.omega[k], 1e-12 * basis.omega[15]));
  }
}

TEST_CASE("one coordinate has the rates and shapes of the textbook", "[modal]") {
  const double omega = 300.;
  const DampedModes under = one_coordinate(omega, 2. * .3 * omega);
  REQUIRE(under.rate.size() == 1);
  CHECK_THAT(under.rate[0].real(), WithinRel(-.3 * omega, 1e-12));
  CHECK_THAT(under.rate[0].imag(), WithinRel(std::sqrt(1. - .09) * omega, 1e-12));
  const DampedModes over = one_coordinate(omega, 2. * 1.25 * omega);
  REQUIRE(over.rate.size() == 2);  // omega (1.25 -+ .75)
  CHECK_THAT(over.rate[0].real(), WithinRel(-.5 * omega, 1e-12));
  CHECK_THAT(over.rate[1].real(), WithinRel(-2. * omega, 1e-12));
}

TEST_CASE("displacement under forces and velocity are recovered from the modes", "[modal]") {
  for (const Line& line : lines_under_test()) {
    const Basis basis = basis_of(line, 8);
    const DampedModes modes = damped_modes(basis, line.damping);
    const auto m = modes.shape.rows();
    Eigen::VectorXd force(m), velocity(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      force[i] = 1e4 * std::sin(1. + 3. * static_cast<double>(i));
      velocity[i] = 100. * std::cos(2. + 5. * static_cast<double>(i));
    }
    const Eigen::VectorXcd z = modes.from(force, velocity);
    const Eigen::VectorXd y = force.cwiseQuotient(Eigen::VectorXd(basis.omega.cwiseAbs2())),
                          back = (modes.shape * z).real(),
                          rate = (modes.shape * modes.rate.cwiseProduct(z)).real();
    // y = -[Re sum shape shape' / rate] f + [Re sum shape shape'] y', and y' the same with one more
    // rate: a completeness of 1e-9 counts relative to these terms.
    const double slowest = std::abs(modes.rate[0]);
    CHECK((back - y).norm() < 1e-9 * (y.norm() + velocity.norm() / slowest));
    CHECK((rate - velocity).norm() < 1e-9 * (force.norm() / slowest + velocity.norm()));
    // Without velocity, each mode rests where its force holds it.
    const Eigen::VectorXcd held = modes.from(force, Eigen::VectorXd::Zero(m)),
                           forces = modes.shape.transpose() * force;
    CHECK((modes.rate.cwiseProduct(held) + forces).norm() < 1e-14 * forces.norm());
  }
}

TEST_CASE("completeness separates slow real roots that cluster", "[modal]") {
  // Dampers of 29e6 N s/m on 60 equal seats have 61 roots near -k/c = -48.3 1/s. The eigen solver's
  // vectors of the cluster are no longer orthogonal, and completeness errs by 1e-5 and more.
  Track track = peers_pair(2);
  track.bays = 60;
  track.support.stiffness[2] = 1.4e9;
  track.support.damping[2] = 29e6;
  const Line line = assemble(track)[0];
  const Basis basis = basis_of(line, 60);
  REQUIRE(basis.omega.size() == 60 + 61);
  const DampedModes modes = damped_modes(basis, line.damping);
  CHECK(incompleteness(modes) < 1e-9);
  // A mix of shapes whose rates agree to 1e-8 leaves a residual of 1e-8 times the mix.
  CHECK(residual(basis, modes) < 1e-9);
}

TEST_CASE("equal rates have separate shapes", "[modal]") {
  // Five of six directions have the same mass, stiffness and damping; the seventh is uncoupled. Any
  // mixture of their shapes is a shape, and some mixtures have a zero product with themselves.
  for (const double c : {0., 60., 900.}) {
    Eigen::VectorXd omega = Eigen::VectorXd::Constant(7, 300.), along(7);
    omega[6] = 500.;
    along << .3, -.5, .2, .6, -.4, .1, 0.;
    const Eigen::MatrixXd D = c * Eigen::MatrixXd::Identity(7, 7) + 40. * along * along.transpose();
    const DampedModes modes =
        damped_modes({omega, Eigen::MatrixXd::Identity(7, 7)}, D.sparseView());
    CAPTURE(c);
    CHECK(modes.rate.size() == (c == 900. ? 13 : 7));
    CHECK(incompleteness(modes) < 1e-9);
    CHECK(residual({omega, Eigen::MatrixXd::Identity(7, 7)}, modes) < 1e-9);
  }
}

TEST_CASE("equal cells in any mixture have the rates of one cell, each once per cell", "[modal]") {
  // Two coupled coordinates, whose dampers do not share the springs' shapes, have two pairs, one
  // pair and two real rates, or four real ones, by the dampers' strength. A rotation mixes cells.
  constexpr int kCells = 16, kSize = 2 * kCells;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd any =
      Eigen::MatrixXd::NullaryExpr(kSize, kSize, [&] { return normal(random); });
  const Eigen::MatrixXd Q = any.householderQr().householderQ();
  for (const double strength : {1., 30., 1e3, 1e5}) {
    Eigen::Matrix2d spring, damper;
    spring << 9e4, -2e4, -2e4, 4e4;
    damper << 40., 15., 15., 20.;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(kSize, kSize), D = K;
    for (int c = 0; c < kCells; ++c) {
      K.block<2, 2>(2 * c, 2 * c) = spring;
      D.block<2, 2>(2 * c, 2 * c) = strength * damper;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Q * K * Q.transpose()),
        one_solver(spring);
    const auto basis_of_solver = [](const auto& s) {
      return Basis{s.eigenvalues().cwiseSqrt(),
                   Eigen::MatrixXd::Identity(s.eigenvalues().size(), s.eigenvalues().size())};
    };
    const auto in = [](const auto& s,
                       const Eigen::MatrixXd& matrix) -> Eigen::SparseMatrix<double> {
      const Eigen::MatrixXd own = s.eigenvectors().transpose() * matrix * s.eigenvectors();
      return own.sparseView();
    };
    const Basis basis = basis_of_solver(solver);
    const DampedModes all = damped_modes(basis, in(solver, Q * D * Q.transpose())),
                      one = damped_modes(basis_of_solver(one_solver),
                                         in(one_solver, strength * damper));
    CAPTURE(strength, one.rate.transpose());
    REQUIRE(all.rate.size() == kCells * one.rate.size());
    CHECK(incompleteness(all) < 1e-9);
    const double fastest = one.rate.cwiseAbs().maxCoeff();
    // Slow rates have the round-off of the fastest rate.
    CHECK(residual(basis, all) < 1e-9 + 2.3e-16 * fastest / std::abs(one.rate[0]));
    for (Eigen::Index k = 0; k < all.rate.size(); ++k)
      CHECK(std::abs(all.rate[k] - one.rate[k / kCells]) < 1e-11 * fastest);
  }
}

TEST_CASE("shapes that the solver leaves parallel are computed again", "[modal]") {
  // Two of three coordinates are equal. The solver's second shape of these is the first one, with
  // round-off along the third coordinate.
  const Eigen::Vector3d omega(300., 300., 500.), c(60., 60., 80.);
  Eigen::VectorXcd rates(6);
  Eigen::MatrixXcd vectors = Eigen::MatrixXcd::Zero(6, 6);
  for (Eigen::Index k = 0; k < 3; ++k) {
    rates[2 * k] = {-.5 * c[k], std::sqrt(omega[k] * omega[k] - .25 * c[k] * c[k])};
    rates[2 * k + 1] = std::conj(rates[2 * k]);
    for (const Eigen::Index column : {2 * k, 2 * k + 1}) {
      vectors(k == 2 ? 2 : 0, column) = 1.;
      if (k == 1) vectors(2, column) = 1e-13;
    }
  }
  const DampedShapes found = damped_shapes(omega, c.asDiagonal(), rates, vectors);
  const DampedModes modes{found.rate, found.shape, c.asDiagonal()};
  REQUIRE(modes.rate.size() == 3);
  CHECK(incompleteness(modes) < 1e-9);
  CHECK(residual({omega, Eigen::MatrixXd::Identity(3, 3)}, modes) < 1e-9);
}

TEST_CASE("slow rates are right beside very fast ones", "[modal]") {
  // -Omega^2 x / (D x): slow rates 8e-5 1/s apart beside rates of 1e8, of which 1e-12 is more.
  Eigen::Matrix2d D;
  D << .7e8, .2e8, .2e8, 1e8;
  const DampedModes modes =
      damped_modes({Eigen::Vector2d(100., 110.), Eigen::MatrixXd::Identity(2, 2)}, D.sparseView());
  REQUIRE(modes.rate.size() == 4);
  const Eigen::Matrix2d spring = Eigen::Vector2d(1e4, 1.21e4).asDiagonal();
  const Eigen::VectorXd slow =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(spring, D).eigenvalues();
  for (Eigen::Index k = 0; k < 2; ++k) CHECK_THAT(-modes.rate[k].real(), WithinRel(slow[k], 1e-4));
}

TEST_CASE("near critical damping the answer is right or the line is refused", "[modal]") {
  CHECK_THROWS_WITH(one_coordinate(300., 600.), Contains("E-CONDENSE-15"));
  const double omega = 300., t = 2. / omega;
  int accepted = 0;
  for (const double off : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, -1e-2, -1e-5, -1e-9}) {
    DampedModes modes;
    try {
      modes = one_coordinate(omega, 2. * omega * (1. + off));
    } catch (const std::invalid_argument&) {
      continue;
    }
    ++accepted;
    const Eigen::VectorXcd z =
        modes.from(Eigen::VectorXd::Constant(1, omega * omega), Eigen::VectorXd::Zero(1));
    double y = 0.;
    for (Eigen::Index k = 0; k < z.size(); ++k)
      y += (modes.shape(0, k) * std::exp(modes.rate[k] * t) * z[k]).real();
    // Critical: y = (1 + omega t) e^(-omega t), which differs by (omega t)^3/3 e^(-omega t) = .36
    // per unit of `off`. A completeness wrong by 1e-7 counts as much.
    CHECK_THAT(y, WithinAbs(3. * std::exp(-2.), std::abs(off) + 1e-6));
  }
  CHECK(accepted >= 4);  // 1e-2, 1e-4 and their negatives leave 14 and 12 digits
}

TEST_CASE("lines without modes to keep are refused in a sentence", "[modal]") {
  Track free = peers_pair(1);
  free.support.stiffness[2] = 0.;
  CHECK_THROWS_WITH(basis_of(assemble(free)[0], 8), Contains("E-TRACK-35"));
  Track long_track = peers_pair(1);
  long_track.bays = 1000;  // 2001 nodes of 2 unknowns
  CHECK_THROWS_WITH(basis_of(assemble(long_track)[0], 8),
                    Contains("E-CONDENSE-16") && Contains("4002") && Contains("4000"));
  Track undamped = peers_pair(1);
  undamped.support.damping = {};
  CHECK_THROWS_WITH(basis_of(assemble(undamped)[0], 0), Contains("E-CONDENSE-02"));
  // Shapes of dampers are a basis on their own, and a limit in Hz works as one in modes.
  CHECK(basis_of(assemble(peers_pair(1))[0], 0).omega.size() == 17);
  const Line line = assemble(undamped)[0];
  const Modes all = modes(line);
  const Basis cut = modal_basis(line, {1000, .5 * (all.frequency[4] + all.frequency[5])});
  CHECK(cut.omega.size() == 5);
}
