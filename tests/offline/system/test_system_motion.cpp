#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "support/system_run.h"

using namespace railstep;
using Eigen::Vector3d;

namespace {

/// A slider driven by `motion` along the skew line of `axis`.
System driven_slider(bool planar, const Vector3d& axis, const Motion& motion) {
  System s;
  s.planar = planar;
  RigidBody b;
  b.mass = 2.;
  b.inertia = Eigen::Matrix3d::Identity();
  b.position = {.1, 0., .2};
  s.bodies = {b};
  s.joints = {{.kind = JointKind::prismatic,
               .a = ground(),
               .b = body(0),
               .point = b.position,
               .axis = axis},
              {.kind = JointKind::translation,
               .a = ground(),
               .b = body(0),
               .point = b.position,
               .axis = axis,
               .motion = motion}};
  return s;
}

/// Natural cubic spline through (0, 0), (1, 1), (2, 0): its second derivative in the middle is -3.
double spline(double t) {
  if (t >= 2.) return 0.;
  const double u = t <= 1. ? t : 2. - t;
  return 1.5 * u - .5 * u * u * u;
}
double spline_rate(double t) {
  if (t >= 2.) return 0.;
  return t <= 1. ? 1.5 - 1.5 * t * t : -(1.5 - 1.5 * (2. - t) * (2. - t));
}

const ConstraintMethod kConstraintMethods[] = {ConstraintMethod::augmented_lagrangian,
                                               ConstraintMethod::gear_gupta_leimkuhler,
                                               ConstraintMethod::direct};

}  // namespace

TEST_CASE("a slider follows a polynomial", "[system]") {
  const bool planar = GENERATE(true, false);
  const Vector3d axis(.8, 0., -.6);
  const std::vector<double> c = {0., .2, -.1, .3, -.04, .01};
  System s = driven_slider(planar, axis, {.polynomial = c});
  s.bodies[0].velocity = c[1] * axis;
  for (const ConstraintMethod hold : kConstraintMethods) {
    SystemRun r(s, sharp(generalised_alpha(1e-3, .9), hold));
    double place = 0., speed = 0.;
    for (int i = 0; i < 1500; ++i) {
      r.frame();
      const double t = r.time();
      double at = 0., rate = 0.;
      for (int k = 5; k >= 0; --k) {
        rate = rate * t + at;
        at = at * t + c[static_cast<std::size_t>(k)];
      }
      place = std::max(place, largest(r.body_position(0) - s.bodies[0].position - at * axis));
      speed = std::max(speed, largest(r.body_velocity(0) - rate * axis));
    }
    INFO("hold " << static_cast<int>(hold) << ": " << place << " m, " << speed << " m/s");
    CHECK(r.seen == Status::ok);
    CHECK(place < 1e-11);  // the joints' tolerance is 1e-12
    // Over the step that is 1e-9; the direct solve leaves rates to the scheme: h^2 s''', at most 2
    // m/s3.
    CHECK(speed < (hold == ConstraintMethod::direct ? 2e-6 : 1e-8));
  }
}

TEST_CASE("Baumgarte's slider follows a polynomial with the order of its error", "[system]") {
  const Vector3d axis = Vector3d::UnitX();
  System s = driven_slider(true, axis, {.polynomial = {0., .2, -.1, .3}});
  s.bodies[0].velocity = .2 * axis;
  const auto error = [&](double h) {
    SystemRun r(s, sharp(generalised_alpha(h, .9), ConstraintMethod::baumgarte));
    r.until(1.);
    return std::abs(r.body_position(0).x() - .1 - (.2 - .1 + .3));
  };
  const double coarse = error(1e-3), fine = error(5e-4);
  INFO(coarse << " " << fine);
  // It returns within 5 steps, so the error is that of a few steps: s''' h^3 = 1.8e-9 each.
  CHECK(coarse < 1e-7);
  CHECK(fine < coarse / 3.);
}

TEST_CASE("a slider follows the natural spline of a table and rests after its end", "[system]") {
  const bool planar = GENERATE(true, false);
  const Vector3d axis(.8, 0., -.6);
  // The table's first row is at 0 s, so the slider starts with the spline's rate.
  System s = driven_slider(planar, axis, {.table = {{0., 0.}, {1., 1.}, {2., 0.}}});
  s.bodies[0].velocity = 1.5 * axis;
  SystemRun r(s, sharp(generalised_alpha(1e-3, .9)));
  double place = 0., speed = 0.;
  for (int i = 0; i < 2500; ++i) {
    r.frame();
    const double t = r.time();
    place = std::max(place, largest(r.body_position(0) - s.bodies[0].position - spline(t) * axis));
    if (std::abs(t - 2.) > 1.5e-3)
      speed = std::max(speed, largest(r.body_velocity(0) - spline_rate(t) * axis));
  }
  INFO(place << " m, " << speed << " m/s");
  CHECK(place < 1e-11);
  CHECK(speed < 1e-8);
}

TEST_CASE("a driven hinge rotates its body by its polynomial, over whole turns", "[system]") {
  const bool planar = GENERATE(true, false);
  System s;
  s.planar = planar;
  const double rate = 4.;  // rad/s about y
  s.bodies = {rod_body(Vector3d::Zero(), 1., .3, 2., .05, Vector3d::Zero(), -rate)};
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar),
              {.kind = JointKind::rotation,
               .a = ground(),
               .b = body(0),
               .axis = Vector3d::UnitY(),
               .motion = {.polynomial = {0., rate, 1.}}}};
  for (const ConstraintMethod hold : kConstraintMethods) {
    SystemRun r(s, sharp(generalised_alpha(1e-3, .9), hold));
    double turn = 0., speed = 0.;
    for (int i = 0; i < 3000; ++i) {
      r.frame();
      const double t = r.time(), angle = rate * t + t * t;
      const Eigen::Matrix3d right =
          Eigen::AngleAxisd(angle, Vector3d::UnitY()) * s.bodies[0].orientation.toRotationMatrix();
      turn = std::max(turn, largest(r.body_rotation(0) - right));
      speed = std::max(speed, std::abs(r.body_spin(0).y() - (rate + 2. * t)));
    }
    INFO("hold " << static_cast<int>(hold) << ": " << turn << ", " << speed << " rad/s");
    CHECK(r.seen == Status::ok);
    CHECK(turn < 1e-11);
    CHECK(speed < 1e-8);
  }
}

TEST_CASE("a force by a table pushes a body by the integral of the table", "[system]") {
  // Through (0, 0), (1, 1), (2, 0) the spline's integral is 2 (1.5 / 2 - .5 / 4) = 1.25 s.
  const bool planar = GENERATE(true, false);
  System s;
  s.planar = planar;
  s.gravity.setZero();
  RigidBody b;
  b.mass = 5.;
  b.inertia = Eigen::Matrix3d::Identity();
  s.bodies = {b};
  s.forces = {{.on = body(0),
               .direction = {3., 0., -4.},
               .factor = {.table = {{0., 0.}, {1., 1.}, {2., 0.}}}}};
  SystemRun r(s, sharp(generalised_alpha(1e-3, .9)));
  r.until(3.);
  // The scheme sums a force as the trapezoidal rule does, with an error of h^2/12 (s'(2) - s'(0)) =
  // 2.5e-7, and its own lag is of the same order, twice h^2.
  CHECK(largest(r.body_velocity(0) - 1.25 * Vector3d(3., 0., -4.) / 5.) < 3e-6);
}
