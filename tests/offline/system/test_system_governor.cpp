#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector3d;

namespace {

// The stiff flyball governor, IFToMM benchmark A05, as Tagliapietra, Vivian, Ceseracciu and
// Reggiani (MBS-BOS, 2015) model it. A shaft of 1 m has two rods of 1 m hinged 5 cm beside its top,
// with balls of 5 kg at their ends. A cube of .1 m slides on it; springs and dampers join its sides
// to the rods' middles. Steel would be stiff; these have 8e5 N/m and 4e4 N s/m.
constexpr double kDensity = 3000., kRodSide = .01, kCube = .1, kBall = 5.;
constexpr double kStiffness = 8e5, kDamping = 4e4, kSpringLength = .5, kBeside = .05;
constexpr double kRodMass = kDensity * kRodSide * kRodSide,
                 kCubeMass = kDensity * kCube * kCube * kCube;
constexpr double kAcross = kRodMass * (1. + kRodSide * kRodSide) / 12.;
constexpr double kAlong = kRodMass * kRodSide * kRodSide / 6.;
const double kSpin = 8. * std::atan(1.), kRodAngle = kSpin / 6.;  // rad/s; rad from straight down

/// A rod with its ball: the centre is `arm` from the hinge.
struct RodAndBall {
  double mass = kRodMass + kBall;
  double arm = (.5 * kRodMass + kBall) / mass;
  double across = kAcross + kRodMass * (arm - .5) * (arm - .5) + kBall * (1. - arm) * (1. - arm);
};

System governor() {
  System s;
  const Vector3d spin(0., 0., kSpin);
  RigidBody shaft, cube;
  shaft.mass = kRodMass;
  shaft.inertia = Vector3d(kAcross, kAcross, kAlong).asDiagonal();
  shaft.position = {0., 0., .5};
  cube.mass = kCubeMass;
  cube.inertia = kCubeMass * kCube * kCube / 6. * Eigen::Matrix3d::Identity();
  cube.position = {0., 0., .5};
  shaft.angular_velocity = cube.angular_velocity = spin;
  s.bodies = {shaft, cube};
  s.joints = {{.kind = JointKind::revolute, .a = ground(), .b = body(0), .axis = Vector3d::UnitZ()},
              {.kind = JointKind::prismatic,
               .a = body(0),
               .b = body(1),
               .point = cube.position,
               .axis = Vector3d::UnitZ()}};
  const RodAndBall rod;
  for (const double side : {1., -1.}) {
    const Vector3d top(side * kBeside, 0., 1.);
    const Vector3d down(side * std::sin(kRodAngle), 0., -std::cos(kRodAngle));
    RigidBody b;
    b.mass = rod.mass;
    b.inertia = Vector3d(rod.across, rod.across, kAlong).asDiagonal();
    b.position = top + rod.arm * down;
    b.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), down);
    b.angular_velocity = spin;
    b.velocity = spin.cross(b.position);
    const int own = static_cast<int>(s.bodies.size());
    s.bodies.push_back(b);
    s.joints.push_back({.kind = JointKind::revolute,
                        .a = body(0),
                        .b = body(own),
                        .point = top,
                        .axis = Vector3d::UnitY()});
    s.springs.push_back({.a = body(1),
                         .b = body(own),
                         .point_a = {side * kBeside, 0., .5},
                         .point_b = top + .5 * down,
                         .stiffness = kStiffness,
                         .damping = kDamping,
                         .length = kSpringLength});
  }
  return s;
}

/// Inertia about the shaft, and its derivative by the rods' angle.
struct About {
  double value, slope;
};
About about_shaft(double angle) {
  const double c = std::cos(angle), s = std::sin(angle), middle = kBeside + .5 * s,
               end = kBeside + s;
  return {
      kAlong + kCubeMass * kCube * kCube / 6. +
          2. * (kRodMass * middle * middle + kAlong * c * c + kAcross * s * s + kBall * end * end),
      2. * (kRodMass * middle * c + 2. * (kAcross - kAlong) * s * c + 2. * kBall * end * c)};
}

/// State: rod angle, height of the cube, their rates; the spin follows from the angular momentum L.
Eigen::VectorXd slope(const Eigen::VectorXd& y, double L) {
  const double c = std::cos(y[0]), s = std::sin(y[0]);
  const About J = about_shaft(y[0]);
  const double spin = L / J.value;
  const Eigen::Vector2d d(.5 * s, 1. - .5 * c - y[1]);  // spring, from the cube to the rod
  const double length = d.norm();
  const double by_angle = d.dot(Eigen::Vector2d(.5 * c, .5 * s)) / length;
  const double by_height = -d[1] / length;
  const double force =
      kStiffness * (length - kSpringLength) + kDamping * (by_angle * y[2] + by_height * y[3]);
  const double swing = 2. * (.25 * kRodMass + kAcross + kBall);
  const double weight = 2. * kGravity * s * (.5 * kRodMass + kBall);
  Eigen::VectorXd result(4);
  result << y[2], y[3], (.5 * J.slope * spin * spin - weight - 2. * force * by_angle) / swing,
      -kGravity - 2. * force * by_height / kCubeMass;
  return result;
}

}  // namespace

TEST_CASE("a stiff flyball governor settles as its three equations do", "[system]") {
  const double L = about_shaft(kRodAngle).value * kSpin;
  Eigen::VectorXd y(4);
  y << kRodAngle, .5, 0., 0.;
  // The dampers' fastest rate is 2 c / 3 kg = 2e4 1/s. The extrapolated step is stable up to some
  // 30 of it and exact to 1e-12 at a third of that.
  const HighOrder known = high_order(
      [L](double, const Eigen::VectorXd& at) { return slope(at, L); }, y, {0., .2, .5}, 4e-4);
  REQUIRE(known.own_error < 1e-10);
  INFO("cube at " << known.y[1][1] << " and " << known.y[2][1] << " m");
  CHECK(std::abs(known.y[2][1] - .5) > .02);  // it does move
  struct Case {
    const char* name;
    Scheme (*scheme)(double);
    double order;
  };
  const Case cases[] = {
      {"generalised-alpha", [](double h) { return generalised_alpha(h, .6); }, 2.},
      {"energy-momentum", [](double h) { return energy_momentum(h); }, 2.},
      {"backward Euler", [](double h) { return backward_euler(h); }, 1.}};
  for (const Case& c : cases) {
    const auto error = [&](double h) {
      SystemRun r(governor(), sharp(c.scheme(h)));
      r.until(.2);
      const double early = std::abs(r.body_position(1).z() - known.y[1][1]);
      r.until(.5);
      CHECK(r.seen == Status::ok);
      const double late = std::abs(r.body_position(1).z() - known.y[2][1]);
      const double spin = L / about_shaft(known.y[2][0]).value;
      return Eigen::Vector2d(std::max(early, late), std::abs(r.body_spin(0).z() - spin));
    };
    const Eigen::Vector2d coarse = error(2e-3), fine = error(1e-3);
    INFO(c.name << ": " << coarse[0] << " " << fine[0] << " m, " << coarse[1] << " " << fine[1]
                << " rad/s at 2 and 1 ms");
    CHECK(fine[0] < (c.order > 1.5 ? 1e-4 : 1e-2));  // 1e-4 of the shaft's length
    for (const int k : {0, 1}) CHECK_THAT(order(coarse[k], fine[k]), WithinAbs(c.order, .2));
  }
}
