#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector3d;
using Number = std::complex<double>;

namespace {

/// Solution of m x'' + c x' + k x = 0 from x0 at rest, by its two roots; and the same by a one-step
/// scheme with the amplification `grow`(h root).
struct Oscillator {
  double mass, stiffness, damping, x0;

  Number root(double sign) const {
    const Number half = damping / (2. * mass);
    return -half + sign * std::sqrt(half * half - stiffness / mass);
  }
  template <typename Grow>
  double at(const Grow& grow) const {
    // x = A g1 + B g2 with A + B = x0, A r1 + B r2 = 0
    const Number r1 = root(1.), r2 = root(-1.);
    return (x0 * (r1 * grow(r2) - r2 * grow(r1)) / (r1 - r2)).real();
  }
  double exact(double t) const {
    return at([t](Number r) { return std::exp(r * t); });
  }
  double trapezoidal(double h, int steps) const {
    return at([=](Number r) { return std::pow((1. + .5 * h * r) / (1. - .5 * h * r), steps); });
  }
  double euler(double h, int steps) const {
    return at([=](Number r) { return std::pow(1. - h * r, -steps); });
  }
};

RigidBody ball(double mass, const Vector3d& position) {
  RigidBody b;
  b.mass = mass;
  b.inertia = Eigen::Matrix3d::Identity();
  b.position = position;
  return b;
}

/// A body on a spring of .5 m to the ground along a skew line, pulled out by x0.
System on_ground(const Oscillator& o, bool planar) {
  System s;
  s.planar = planar;
  s.gravity.setZero();
  const Vector3d along = Vector3d(.6, 0., .8);
  s.bodies = {ball(o.mass, (.5 + o.x0) * along)};
  s.springs = {{.a = ground(),
                .b = body(0),
                .point_b = (.5 + o.x0) * along,
                .stiffness = o.stiffness,
                .damping = o.damping,
                .length = .5}};
  return s;
}

}  // namespace

TEST_CASE("a body on spring and damper moves as a linear oscillator in its scheme", "[system]") {
  // The frequency is 8 Hz: free, lightly damped, critical to 1e-3, and overdamped 6 times.
  const double k = 4. * 2500., critical = 2. * std::sqrt(4. * k);
  const bool planar = GENERATE(true, false);
  const double share = GENERATE(0., .02, .999, 6.);
  const Oscillator o{4., k, share * critical, .05};
  const double h = 1e-3;
  const int steps = 500;
  struct Case {
    const char* name;
    Scheme scheme;
    double right;
  };
  const Case cases[] = {{"trapezoidal", generalised_alpha(h, 1.), o.trapezoidal(h, steps)},
                        {"energy-momentum", energy_momentum(h), o.trapezoidal(h, steps)},
                        {"backward Euler", backward_euler(h), o.euler(h, steps)}};
  for (const Case& c : cases) {
    SystemRun r(on_ground(o, planar), sharp(c.scheme));
    for (int i = 0; i < steps; ++i) r.frame();
    const double x = r.body_position(0).norm() - .5;
    INFO(c.name << ", damping " << share << ": " << x << " m, " << c.right);
    CHECK(r.seen == Status::ok);
    // Newton leaves 1e-11 of 500 N on 4 kg over 500 steps, in either direction.
    CHECK_THAT(x, WithinAbs(c.right, 1e-10));
    // It stays on its line.
    CHECK(std::abs(r.body_position(0).dot(Vector3d(-.8, 0., .6))) < 1e-12);
  }
}

TEST_CASE("a damped oscillator converges to its closed form with the scheme's order", "[system]") {
  const Oscillator o{4., 1e4, 40., .05};
  const auto error = [&](double h) {
    SystemRun r(on_ground(o, true), sharp(generalised_alpha(h, .8)));
    double most = 0.;
    while (r.time() < .5 - .5 * h) {
      r.frame();
      most = std::max(most, std::abs(r.body_position(0).norm() - .5 - o.exact(r.time())));
    }
    return most;
  };
  const double coarse = error(1e-3), fine = error(5e-4);
  INFO(coarse << " " << fine);
  // w^3 t h^2 / 12 with w = 50 rad/s at 1 / (decay) = .2 s is 2e-3 of .05 m; twice that for rho .8.
  CHECK(coarse < 2. * 2e-3 * .05);
  CHECK_THAT(order(coarse, fine), WithinAbs(2., .1));
}

TEST_CASE("two bodies on a spring oscillate by their reduced mass about a flying centre",
          "[system]") {
  const bool planar = GENERATE(true, false);
  const double m1 = 2., m2 = 6., h = 1e-3;
  const int steps = 400;
  const Oscillator o{m1 * m2 / (m1 + m2), 3000., 10., .04};
  System s;
  s.planar = planar;
  s.gravity.setZero();
  const Vector3d speed(.7, 0., -.2);
  s.bodies = {ball(m1, Vector3d::Zero()), ball(m2, Vector3d(.3 + o.x0, 0., 0.))};
  for (RigidBody& b : s.bodies) b.velocity = speed;
  s.springs = {{.a = body(0),
                .b = body(1),
                .point_a = Vector3d::Zero(),
                .point_b = s.bodies[1].position,
                .stiffness = o.stiffness,
                .damping = o.damping,
                .length = .3}};
  SystemRun r(s, sharp(energy_momentum(h)));
  const Vector3d centre = (m1 * r.body_position(0) + m2 * r.body_position(1)) / (m1 + m2);
  for (int i = 0; i < steps; ++i) r.frame();
  const Vector3d now = (m1 * r.body_position(0) + m2 * r.body_position(1)) / (m1 + m2);
  CHECK(r.seen == Status::ok);
  CHECK(largest(now - centre - h * steps * speed) < 1e-11);
  const double x = (r.body_position(1) - r.body_position(0)).norm() - .3;
  CHECK_THAT(x, WithinAbs(o.trapezoidal(h, steps), 1e-10));
}

TEST_CASE("a spring without a given length has no force at its start", "[system]") {
  System s;
  s.gravity.setZero();
  s.bodies = {ball(1., Vector3d(.2, .1, .3))};
  s.springs = {{.a = ground(),
                .b = body(0),
                .point_a = Vector3d(1., -1., 0.),
                .point_b = Vector3d(.2, .1, .3),
                .stiffness = 1e5,
                .damping = 10.}};
  SystemRun r(s, sharp(generalised_alpha(1e-3, .9)));
  for (int i = 0; i < 100; ++i) r.frame();
  CHECK(largest(r.body_position(0) - s.bodies[0].position) < 1e-14);
}

TEST_CASE("a spring off the centre rotates a body", "[system]") {
  // A spring of 10 N pulls a rod at rest across at its end: a = F / m, w' = F l / I.
  const bool planar = GENERATE(true, false);
  System s;
  s.planar = planar;
  s.gravity.setZero();
  s.bodies = {rod_body(Vector3d::Zero(), 1., 0., 2., .05)};
  s.springs = {{.a = ground(),
                .b = body(0),
                .point_a = Vector3d(1., 0., 1.),
                .point_b = Vector3d(1., 0., 0.),
                .stiffness = 20.,
                .length = .5}};
  const double h = 1e-5;
  SystemRun r(s, sharp(generalised_alpha(h, .9)));
  const int steps = 100;
  for (int i = 0; i < steps; ++i) r.frame();
  const double t = h * steps, inertia = 2. * (1. + .05 * .05) / 12.;
  // The force falls by k times the end's path of 20 t^2, over 10 N: 4e-5 of it at 1 ms.
  CHECK_THAT(r.body_velocity(0).z(), WithinAbs(10. / 2. * t, 4e-5 * 10. / 2. * t));
  CHECK_THAT(-r.body_spin(0).y(), WithinAbs(10. * .5 / inertia * t, 4e-5 * 10. * .5 / inertia * t));
}
