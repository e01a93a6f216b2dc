#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector3d;

namespace {

constexpr double kLength = 1., kMass = 1., kSide = .05;
constexpr double kStart[2] = {0., .6};  // rad from x towards z

/// Two rods on hinges, released at rest.
System double_pendulum(bool planar) {
  System s;
  s.planar = planar;
  const RigidBody first = rod_body(Vector3d::Zero(), kLength, kStart[0], kMass, kSide);
  const Vector3d B(kLength * std::cos(kStart[0]), 0., kLength * std::sin(kStart[0]));
  s.bodies = {first, rod_body(B, kLength, kStart[1], kMass, kSide)};
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar),
              hinge(body(0), body(1), B, planar)};
  return s;
}

/// Rates of angles and of their rates by Lagrange's equations, with the rods' section inertia.
Eigen::VectorXd slope(double, const Eigen::VectorXd& y) {
  const double inertia = kMass * (kLength * kLength + kSide * kSide) / 12.;
  const double own = inertia + kMass * kLength * kLength / 4.;
  const double couple = kMass * kLength * kLength / 2.;
  const double turn = y[0] - y[1];
  Eigen::Matrix2d M;
  M << own + kMass * kLength * kLength, couple * std::cos(turn), couple * std::cos(turn), own;
  const Eigen::Vector2d force(
      -couple * std::sin(turn) * y[3] * y[3] - 1.5 * kMass * kGravity * kLength * std::cos(y[0]),
      couple * std::sin(turn) * y[2] * y[2] - .5 * kMass * kGravity * kLength * std::cos(y[1]));
  Eigen::VectorXd d(4);
  d << y[2], y[3], M.inverse() * force;
  return d;
}

struct Ends {
  Vector3d B, C;
};

Ends known() {
  static const HighOrder solution = [] {
    Eigen::VectorXd y(4);
    y << kStart[0], kStart[1], 0., 0.;
    return high_order(slope, y, {0., 1.}, .02);
  }();
  INFO("own error " << solution.own_error);
  REQUIRE(solution.own_error < 1e-11);
  const Eigen::VectorXd& y = solution.y[1];
  const Vector3d B(kLength * std::cos(y[0]), 0., kLength * std::sin(y[0]));
  return {B, B + kLength * Vector3d(std::cos(y[1]), 0., std::sin(y[1]))};
}

/// Positions of B and C at 1 s.
Ends run(bool planar, const SystemOptions& options) {
  SystemRun r(double_pendulum(planar), options);
  r.until(1.);
  CHECK(r.seen == Status::ok);
  const Vector3d hinge_at = r.system.joints[1].point;
  const Vector3d along(std::cos(kStart[1]), 0., std::sin(kStart[1]));
  return {r.point_of_body(0, hinge_at), r.point_of_body(1, hinge_at + kLength * along)};
}

double error(bool planar, const SystemOptions& options) {
  const Ends found = run(planar, options), right = known();
  return std::max((found.B - right.B).norm(), (found.C - right.C).norm());
}

}  // namespace

TEST_CASE("a rigid double pendulum converges with the order of its scheme", "[system]") {
  const bool planar = GENERATE(true, false);
  struct Case {
    const char* name;
    Scheme (*scheme)(double);
    double order, bound;
  };
  // The fastest rotation is w = 9 rad/s. Second order: an oscillation at that rate errs by w^3 t
  // h^2/12, at 1 ms 6e-5 rad, on an arm of 2 m; times 5, as two pendulums diverge in 1 s. First
  // order: w^2 t h/2, 4e-2 rad, in the same way.
  const Case cases[] = {
      {"generalised-alpha .9", [](double h) { return generalised_alpha(h, .9); }, 2., 6e-4},
      {"generalised-alpha .5", [](double h) { return generalised_alpha(h, .5); }, 2., 6e-4 * 4.},
      {"energy-momentum", [](double h) { return energy_momentum(h); }, 2., 6e-4},
      {"backward Euler", [](double h) { return backward_euler(h); }, 1., .4}};
  for (const Case& c : cases) {
    const double coarse = error(planar, sharp(c.scheme(1e-3)));
    const double middle = error(planar, sharp(c.scheme(5e-4)));
    const double fine = error(planar, sharp(c.scheme(2.5e-4)));
    INFO((planar ? "planar, " : "spatial, ")
         << c.name << ": " << coarse << " " << middle << " " << fine << " m at 1, .5, .25 ms");
    CHECK(coarse < c.bound);
    // The next term is of relative order w h: 2e-3 at .25 ms for schemes of even powers, and 10 %
    // with the coefficient of a first-order scheme.
    CHECK_THAT(order(middle, fine), WithinAbs(c.order, .1));
  }
}

TEST_CASE("a double pendulum moves alike in its plane and in space", "[system]") {
  for (const Scheme& scheme :
       {generalised_alpha(1e-3, .9), energy_momentum(1e-3), backward_euler(1e-3)}) {
    const Ends plane = run(true, sharp(scheme)), space = run(false, sharp(scheme));
    // Rotations about one axis add up, so the steps are the same. Newton's tolerance is left, 1e-11
    // of the force over 1 s^2, doubled 5 times (see above).
    CHECK(largest(plane.B - space.B) < 1e-9);
    CHECK(largest(plane.C - space.C) < 1e-9);
  }
}

TEST_CASE("each constraint method gives the same double pendulum", "[system]") {
  const ConstraintMethod hold =
      GENERATE(ConstraintMethod::augmented_lagrangian, ConstraintMethod::baumgarte,
               ConstraintMethod::gear_gupta_leimkuhler, ConstraintMethod::direct);
  const bool planar = GENERATE(true, false);
  const double middle = error(planar, sharp(generalised_alpha(5e-4, .9), hold));
  const double fine = error(planar, sharp(generalised_alpha(2.5e-4, .9), hold));
  INFO("hold " << static_cast<int>(hold) << (planar ? ", planar " : ", spatial ") << middle << " "
               << fine);
  CHECK(middle < 6e-4);
  CHECK_THAT(order(middle, fine), WithinAbs(2., .1));
}
