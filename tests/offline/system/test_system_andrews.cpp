#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Andrews' squeezing mechanism: Schiehlen, Multibody Systems Handbook (1990); Hairer and Wanner,
// Solving Ordinary Differential Equations II, section VII.7. Parameters and solution are those of
// Mazzia and Magherini, Test Set for Initial Value Problem Solvers, problem "andrews". Its plane x,
// y is x, z here, so its rotations are about -y.

constexpr double kA[2] = {-.06934, -.00227}, kB[2] = {-.03635, .03273}, kC[2] = {.014, .072};
constexpr double kMasses[7] = {.04325, .00365, .02373, .00706, .07050, .00706, .05498};
constexpr double kInertia[7] = {2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7,
                                1.169e-5, 5.667e-7, 1.912e-5};
constexpr double kD = 28e-3, kDa = 115e-4, kE = 2e-2, kEa = 1421e-5, kRr = 7e-3, kRa = 92e-5;
constexpr double kSs = 35e-3, kSa = 1874e-5, kSb = 1043e-5, kSc = 18e-3, kSd = 2e-2;
constexpr double kTa = 2308e-5, kTb = 916e-5, kU = 4e-2, kUa = 1228e-5, kUb = 449e-5;
constexpr double kZf = 2e-2, kZt = 4e-2, kFa = 1421e-5;
constexpr double kSpring = 4530., kAndrewsSpring = 7785e-5, kTorque = 33e-3;

/// beta, theta, gamma, phi, delta, omega, epsilon
using Angles = std::array<double, 7>;
constexpr Angles kAndrewsStart = {-0.0617138900142764496, 0.,
                                  0.455279819163070380,   0.222668390165885884,
                                  0.487364979543842550,   -0.222668390165885884,
                                  1.23054744454982119};
/// Solution at .03 s by PSIDE at a tolerance of 1e-14, with the rates there.
constexpr Angles kEnd = {0.1581077119629904e+2, -0.1575637105984298e+2, 0.4082224013073101e-1,
                         -0.5347301163226948,   0.5244099658805304,     0.5347301163226948,
                         0.1048080741042263e+1};
constexpr Angles kEndRate = {0.1139920302151208e+4, -0.1424379294994111e+4, 0.1103291221937134e+2,
                             0.1929337464421385e+2, 0.5735699284790808,     -0.1929337464421385e+2,
                             0.3231791658026955};

Vector2d rotated(double angle, double x, double y) {
  return {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y};
}

/// Positions of the seven centres with their rotations, and of the points where bodies meet.
struct Places {
  std::array<Vector2d, 7> centre;
  std::array<double, 7> turn;
  Vector2d crank_end, meet, k4_end, k6_end, spring;
};
Places places(const Angles& q) {
  const Vector2d A(kA[0], kA[1]), B(kB[0], kB[1]);
  Places p;
  p.turn = {q[0], q[0] + q[1], q[2], q[3] + q[4], q[4], q[5] + q[6], q[6]};
  p.crank_end = rotated(p.turn[0], kRr, 0.);
  p.meet = p.crank_end + rotated(p.turn[1], -kD, 0.);
  p.k4_end = A + rotated(p.turn[4], kZt, 0.);
  p.k6_end = A + rotated(p.turn[6], 0., -kU);
  p.spring = B + rotated(p.turn[2], kSd, -kSc);
  p.centre = {rotated(p.turn[0], kRa, 0.),       p.crank_end + rotated(p.turn[1], -kDa, 0.),
              B + rotated(p.turn[2], kSb, -kSa), p.k4_end + rotated(p.turn[3], 0., kEa - kE),
              A + rotated(p.turn[4], kTa, kTb),  p.k6_end + rotated(p.turn[5], kZf - kFa, 0.),
              A + rotated(p.turn[6], -kUa, -kUb)};
  return p;
}

Vector3d in_space(const Vector2d& p) { return {p.x(), 0., p.y()}; }

System squeezer() {
  System s;
  s.planar = true;
  s.gravity.setZero();
  const Places p = places(kAndrewsStart);
  for (std::size_t i = 0; i < 7; ++i) {
    RigidBody b;
    b.mass = kMasses[i];
    b.inertia = kInertia[i] * Eigen::Matrix3d::Identity();
    b.position = in_space(p.centre[i]);
    b.orientation = Eigen::AngleAxisd(-p.turn[i], Vector3d::UnitY());
    s.bodies.push_back(b);
  }
  const auto add = [&](Part a, Part b, const Vector2d& at) {
    s.joints.push_back(hinge(a, b, in_space(at), true));
  };
  const Vector2d A(kA[0], kA[1]), B(kB[0], kB[1]);
  add(ground(), body(0), {0., 0.});
  add(body(0), body(1), p.crank_end);
  add(ground(), body(2), B);
  add(ground(), body(4), A);
  add(ground(), body(6), A);
  add(body(4), body(3), p.k4_end);
  add(body(6), body(5), p.k6_end);
  for (const int other : {2, 3, 5}) add(body(1), body(other), p.meet);
  s.springs = {{.a = ground(),
                .b = body(2),
                .point_a = {kC[0], 0., kC[1]},
                .point_b = in_space(p.spring),
                .stiffness = kSpring,
                .length = kAndrewsSpring}};
  s.forces = {{.on = body(0),
               .direction = -Vector3d::UnitY(),
               .factor = {.polynomial = {kTorque}},
               .moment = true}};
  return s;
}

/// Directions of the bodies, as (cos, sin) of their rotations, and their centres, [7][4].
using Pose7 = Eigen::Matrix<double, 7, 4>;
Pose7 pose(const Places& p) {
  Pose7 result;
  for (int i = 0; i < 7; ++i) {
    const auto k = static_cast<std::size_t>(i);
    result.row(i) << std::cos(p.turn[k]), std::sin(p.turn[k]), p.centre[k].transpose();
  }
  return result;
}
Pose7 pose(const SystemRun& r) {
  Pose7 result;
  for (int i = 0; i < 7; ++i) {
    const Vector3d along = r.body_rotation(i).col(0), at = r.body_position(i);
    result.row(i) << along.x(), along.z(), at.x(), at.z();
  }
  return result;
}

Pose7 at_end(const Scheme& scheme, ConstraintMethod hold) {
  SystemRun r(squeezer(), sharp(scheme, hold));
  r.until(.03);
  CHECK(r.seen == Status::ok);
  return pose(r);
}

}  // namespace

TEST_CASE("the published start and end close the squeezer's loops", "[system]") {
  for (const Angles& q : {kAndrewsStart, kEnd}) {
    const Places p = places(q);
    const Vector2d B(kB[0], kB[1]);
    // The last digit of angles of 15 rad, times arms of 3 cm.
    CHECK((B + rotated(p.turn[2], 0., -kSs) - p.meet).norm() < 1e-15 * 10.);
    CHECK((p.k4_end + rotated(p.turn[3], 0., -kE) - p.meet).norm() < 1e-15 * 10.);
    CHECK((p.k6_end + rotated(p.turn[5], kZf, 0.) - p.meet).norm() < 1e-15 * 10.);
  }
}

TEST_CASE("Andrews' squeezer ends where the published solution does", "[system]") {
  // An energy-momentum step is symmetric, so its error has only even powers of h: two runs,
  // extrapolated, leave h^4.
  const Pose7 right = pose(places(kEnd));
  std::array<Pose7, 3> T;
  for (std::size_t i = 0; i < 3; ++i)
    T[i] = at_end(energy_momentum(1e-5 / (1 << i)), ConstraintMethod::augmented_lagrangian);
  double error[3];
  for (std::size_t i = 0; i < 3; ++i) error[i] = largest(T[i] - right);
  INFO("errors at 10, 5, 2.5 us: " << error[0] << " " << error[1] << " " << error[2]);
  // The crank rotates by w h, at most 20 mrad: w^3 T h^2/12 = 2e-3 of a direction.
  CHECK(error[0] < 2e-3);
  CHECK_THAT(order(error[1], error[2]), WithinAbs(2., .05));
  const Pose7 once = (4. * T[1] - T[0]) / 3., more = (4. * T[2] - T[1]) / 3.;
  INFO("extrapolated " << largest(once - right) << " " << largest(more - right));
  // The next term is (w h)^4 / 80 over the crank's 16 rad: 3e-8, and a sixteenth of that.
  CHECK(largest(once - right) < 3e-8);
  CHECK(largest(more - right) < 3e-8 / 16.);
}

TEST_CASE("Andrews' squeezer converges with each constraint method", "[system]") {
  const Pose7 right = pose(places(kEnd));
  for (const ConstraintMethod hold :
       {ConstraintMethod::augmented_lagrangian, ConstraintMethod::baumgarte,
        ConstraintMethod::gear_gupta_leimkuhler, ConstraintMethod::direct}) {
    const double coarse = largest(at_end(generalised_alpha(1e-5, .9), hold) - right);
    const double fine = largest(at_end(generalised_alpha(5e-6, .9), hold) - right);
    INFO("hold " << static_cast<int>(hold) << ": " << coarse << " " << fine);
    // Baumgarte's rate depends on the step and adds an error of higher order.
    CHECK(order(coarse, fine) > 1.8);
    CHECK(fine < 1e-4);  // a quarter of w^3 T h^2 / 12 (above), halved for its mean
  }
}

TEST_CASE("the squeezer ends with the published rates", "[system]") {
  SystemRun r(squeezer(), sharp(energy_momentum(2.5e-6)));
  r.until(.03);
  // Rates follow the phase: w' = 5e4 rad/s2 times its error of 1e-3 / 16, over 1100 rad/s, and as
  // much again for their own error: 1e-4 of them.
  const double scale = std::abs(kEndRate[1]);
  CHECK_THAT(-r.body_spin(0).y(), WithinAbs(kEndRate[0], 1e-4 * scale));
  CHECK_THAT(-r.body_spin(1).y(), WithinAbs(kEndRate[0] + kEndRate[1], 1e-4 * scale));
  CHECK_THAT(-r.body_spin(2).y(), WithinAbs(kEndRate[2], 1e-4 * scale));
}
