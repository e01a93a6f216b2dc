// Stiffness of suspensions with preloads against their energy with finite rotations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "offline/runner/suspension.h"

// The energy is in long double on purpose; clang warns of these promotions.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;
using Motions = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

Vector vector(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

Matrix turned_about(const Vector& rotation) {
  const Real angle = rotation.norm();
  if (angle == 0) return Matrix::Identity();
  return Eigen::AngleAxis<Real>(angle, rotation / angle).toRotationMatrix();
}

/// Pose of a body: where a point of it is, and how it is turned.
struct Pose {
  Matrix rotation;
  Vector point;
};

/// The axle boxes of a wheelset do not spin: they are turned by yaw and then by roll.
Pose pose_of(const Runner& runner, int body, const std::array<double, 3>& point, const Motions& q) {
  const RunnerBody& b = runner.bodies[static_cast<std::size_t>(body)];
  const Vector moved = q.segment<3>(kMotions * body), by = q.segment<3>(kMotions * body + 3);
  const Matrix rotation = b.is_wheelset()
                              ? Matrix(turned_about({0, 0, by[2]}) * turned_about({by[0], 0, 0}))
                              : turned_about(by);
  return {rotation, vector(b.centre) + moved + rotation * (vector(point) - vector(b.centre))};
}

Real mid_frame_energy(const RunnerElement& e, const Pose& a, const Pose& b) {
  const Eigen::AngleAxis<Real> between(Matrix(b.rotation.transpose() * a.rotation));
  const Vector turned = between.angle() * between.axis();
  const Matrix middle = b.rotation * turned_about(turned / 2);
  const Vector moved = middle.transpose() * (a.point - b.point);
  Real sum = 0;
  for (int d = 0; d < 3; ++d) {
    const auto i = static_cast<std::size_t>(d);
    sum += Real(e.stiffness[i]) / 2 * moved[d] * moved[d] - Real(e.preload[i]) * moved[d] +
           Real(e.stiffness[i + 3]) / 2 * turned[d] * turned[d];
  }
  return sum;
}

Real line_energy(const RunnerElement& e, const Pose& a, const Pose& b) {
  const Real longer = (b.point - a.point).norm() - (vector(e.point_b) - vector(e.point_a)).norm();
  return Real(e.stiffness[0]) / 2 * longer * longer + Real(e.preload[0]) * longer;
}

Real energy(const Runner& runner, const Motions& q) {
  Real sum = 0;
  for (const RunnerElement& e : runner.elements) {
    const Pose a = pose_of(runner, e.a, e.point_a, q), b = pose_of(runner, e.b, e.point_b, q);
    sum += e.kind == RunnerElement::Kind::line ? line_energy(e, a, b) : mid_frame_energy(e, a, b);
  }
  return sum;
}

/// Second difference of the energy, of fourth order in its step.
Eigen::MatrixXd second_difference(const Runner& runner) {
  const auto n = static_cast<Eigen::Index>(kMotions * runner.bodies.size());
  constexpr Real kStep = 1e-3L;
  const auto mixed = [&](Eigen::Index i, Eigen::Index j, Real h) {
    Real sum = 0;
    for (const int a : {-1, 1})
      for (const int b : {-1, 1}) {
        Motions q = Motions::Zero(n);
        q[i] += a * h;
        q[j] += b * h;
        sum += a * b * energy(runner, q);
      }
    return sum / (4 * h * h);
  };
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      K(i, j) = static_cast<double>((4 * mixed(i, j, kStep) - mixed(i, j, 2 * kStep)) / 3);
  return K;
}

/// A body over a wheelset and a second body beside it, with an element of each kind.
Runner drawn(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1., 1.);
  const auto three = [&](double scale) {
    return std::array<double, 3>{scale * unit(random), scale * unit(random), scale * unit(random)};
  };
  Runner r;
  r.bodies = {{"body", 1000., {100., 200., 300.}, three(1.)},
              {"wheelset", 1500., {900., 100., 900.}, three(1.), .46},
              {"other", 500., {50., 60., 70.}, three(1.)}};
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {2, 1}}) {
    RunnerElement e{};
    e.kind = RunnerElement::Kind::mid_frame;
    e.a = a;
    e.b = b;
    e.point_a = e.point_b = three(1.);
    for (double& k : e.stiffness) k = 1e6 * (1. + unit(random));
    for (std::size_t d = 0; d < 3; ++d) e.preload[d] = 1e5 * unit(random);
    r.elements.push_back(e);
    e.kind = RunnerElement::Kind::line;
    e.point_b = three(2.);
    r.elements.push_back(e);
  }
  return r;
}

}  // namespace

TEST_CASE("stiffness is the second derivative of the energy", "[runner]") {
  std::mt19937 random(7);
  for (int i = 0; i < 5; ++i) {
    const Runner runner = drawn(random);
    const Eigen::MatrixXd K = runner_matrices(runner, 9.81).stiffness;
    const Eigen::MatrixXd wanted = second_difference(runner);
    const double largest = K.cwiseAbs().maxCoeff();
    CHECK((K - wanted).cwiseAbs().maxCoeff() < 1e-9 * largest);
    CHECK((K - K.transpose()).cwiseAbs().maxCoeff() < 1e-14 * largest);
    // The preloads are seen: without them the stiffness is another one.
    Runner unloaded = runner;
    for (RunnerElement& e : unloaded.elements) e.preload = {};
    CHECK((runner_matrices(unloaded, 9.81).stiffness - K).cwiseAbs().maxCoeff() > 1e-3 * largest);
  }
}

TEST_CASE("forces at rest are the first derivative of the energy", "[runner]") {
  std::mt19937 random(11);
  const Runner runner = drawn(random);
  const Eigen::VectorXd rest = runner_matrices(runner, 0.).rest;
  constexpr Real kStep = 1e-4L;
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    Motions q = Motions::Zero(rest.size());
    const auto slope = [&](Real h) {
      q[i] = h;
      const Real ahead = energy(runner, q);
      q[i] = -h;
      return (ahead - energy(runner, q)) / (2 * h);
    };
    const auto wanted = static_cast<double>(-(4 * slope(kStep) - slope(2 * kStep)) / 3);
    CHECK(std::fabs(rest[i] - wanted) < 1e-9 * rest.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("preloads that are not given carry the weight", "[runner]") {
  Runner r;
  r.bodies = {{"body", 1000., {100., 200., 300.}, {0., 0., 1.}},
              {"front", 1500., {900., 100., 900.}, {1., 0., .5}, .5},
              {"rear", 1500., {900., 100., 900.}, {-3., 0., .5}, .5}};
  for (const auto& [set, x] : {std::pair{1, 1.}, {2, -3.}})
    for (const double y : {1., -1.}) {
      RunnerElement e{};
      e.kind = RunnerElement::Kind::mid_frame;
      e.b = set;
      e.point_a = e.point_b = {x, y, .5};
      e.stiffness = {1e6, 1e6, 2e6, 0., 0., 0.};
      r.elements.push_back(e);
    }
  balance_preloads(r, 9.81);
  // The levers are 1 m and 3 m: the front springs carry three quarters.
  CHECK(r.elements[0].preload[2] == Approx(.375 * 9810.).epsilon(1e-12));
  CHECK(r.elements[3].preload[2] == Approx(.125 * 9810.).epsilon(1e-12));
  const Eigen::VectorXd rest = runner_matrices(r, 9.81).rest;
  CHECK(rest.head(6).cwiseAbs().maxCoeff() < 1e-8);
  CHECK(rest.sum() == Approx(-9.81 * 4000.));
  // Preloads that are too small leave a body without balance.
  for (RunnerElement& e : r.elements) e.preload[2] *= .9;
  CHECK_THROWS_AS(balance_preloads(r, 9.81), std::invalid_argument);
}
