#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A body that rotates about a fixed point; r goes from there to its centre, in body axes.
struct Top {
  double mass;
  Vector3d inertia;  // about the centre, in body axes
  Vector3d arm;      // r, m
  Matrix3d start;    // body axes at rest
  Vector3d spin;     // body axes, rad/s

  Matrix3d about_pivot() const {
    return Matrix3d(inertia.asDiagonal()) +
           mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
  }
  System scene() const {
    System s;
    RigidBody b;
    b.mass = mass;
    b.inertia = inertia.asDiagonal();
    b.position = start * arm;
    b.orientation = start;
    b.angular_velocity = start * spin;
    b.velocity = b.angular_velocity.cross(b.position);
    s.bodies = {b};
    s.joints = {{.kind = JointKind::spherical, .a = ground(), .b = body(0)}};
    return s;
  }
};

/// [R, column after column, w]: R' = R w x, I w' = I w x w + r x R' m g (Euler and Poisson).
struct TopMotion {
  HighOrder solution;
  TopMotion(const Top& top, double t, double step) {
    const Matrix3d I = top.about_pivot(), inverse = I.inverse();
    const auto f = [=](double, const Eigen::VectorXd& y) {
      const Matrix3d R = Eigen::Map<const Matrix3d>(y.data());
      const Vector3d w = y.tail<3>();
      const Vector3d weight = R.transpose() * Vector3d(0., 0., -top.mass * kGravity);
      Matrix3d dR;
      for (int i = 0; i < 3; ++i) dR.row(i) = -w.cross(R.row(i).transpose()).transpose();
      Eigen::VectorXd d(12);
      d.head<9>() = Eigen::Map<const Eigen::VectorXd>(dR.data(), 9);
      d.tail<3>() = inverse * ((I * w).cross(w) + top.arm.cross(weight));
      return d;
    };
    Eigen::VectorXd y(12);
    y << Eigen::Map<const Eigen::VectorXd>(top.start.data(), 9), top.spin;
    solution = high_order(f, y, {0., t}, step);
  }
  Matrix3d rotation() const { return Eigen::Map<const Matrix3d>(solution.y[1].data()); }
};

double error(const Top& top, const TopMotion& known, double t, const Scheme& scheme) {
  SystemRun r(top.scene(), sharp(scheme));
  r.until(t);
  CHECK(r.seen == Status::ok);
  return largest(r.body_rotation(0) - known.rotation());
}

/// The fast top of Geradin and Cardona (2001), as used by Bruls and Cardona (2010) and Arnold and
/// Bruls; it nutates some 70 times a second.
Top fast_top() {
  return {
      15., {.234375, .46875, .234375}, {0., 1., 0.}, Matrix3d::Identity(), {0., 150., -4.61538}};
}

/// A top about its z axis, .1 m above its point; I3 = 2e-3, I1 = 1.25e-3 kg m2 about the centre.
Top slow_top(double tilt, double spin) {
  return {1.,
          {1.25e-3, 1.25e-3, 2e-3},
          {0., 0., .1},
          Matrix3d(Eigen::AngleAxisd(tilt, Vector3d::UnitX())),
          {0., 0., spin}};
}

/// Spin from which a top sleeps: I3 w = 2 sqrt(I1 m g r), with I1 about the point.
double sleeping_spin() { return 2. * std::sqrt((1.25e-3 + .01) * kGravity * .1) / 2e-3; }

}  // namespace

TEST_CASE("a fast heavy top precesses and nutates as its equations say", "[system]") {
  const Top top = fast_top();
  const TopMotion known(top, .2, 1e-3);
  REQUIRE(known.solution.own_error < 1e-11);
  for (const SchemeOrder& c : kSchemeOrders) {
    const double h = c.order > 1.5 ? 2e-4 : 2e-5;
    const double coarse = error(top, known, .2, c.scheme(h));
    const double fine = error(top, known, .2, c.scheme(h / 2.));
    INFO("errors " << coarse << " " << fine << " at " << h << " s");
    // A step rotates by w h: .03 rad, and .003 for the first order.
    CHECK_THAT(order(coarse, fine), WithinAbs(c.order, .1));
  }
}

TEST_CASE("a top sleeps above its critical spin and falls below", "[system]") {
  const double factor = GENERATE(.8, 1.2);
  const Top top = slow_top(1e-3, factor * sleeping_spin());
  const TopMotion known(top, 1.2, 2e-3);
  REQUIRE(known.solution.own_error < 1e-11);
  SystemRun r(top.scene(), sharp(energy_momentum(1e-3)));
  double tilt = 0.;
  for (int i = 0; i < 1200; ++i) {
    r.frame();
    tilt = std::max(tilt, r.body_rotation(0).col(2).head<2>().norm());
  }
  INFO("spin " << factor * sleeping_spin() << " rad/s, tilt " << tilt);
  if (factor > 1.) {
    // In linear theory the tilt stays between its start and start / sqrt(1 - 1 / factor^2).
    CHECK_THAT(tilt, WithinRel(1e-3 / std::sqrt(1. - 1. / (factor * factor)), .02));
  } else {
    CHECK(tilt > .1);
  }
  const double coarse = error(top, known, 1.2, generalised_alpha(5e-4, .9));
  const double fine = error(top, known, 1.2, generalised_alpha(2.5e-4, .9));
  INFO("errors " << coarse << " " << fine);
  CHECK_THAT(order(coarse, fine), WithinAbs(2., .1));
}

TEST_CASE("a top keeps its energy and its momentum about the vertical", "[system]") {
  // The top nutates widely for 10 s in 1e4 steps.
  const Top top = slow_top(.5, sleeping_spin());
  const SystemOptions options = sharp(energy_momentum(1e-3));
  SystemRun r(top.scene(), options);
  const double energy = r.energy(), about_z = r.momentum()[5];
  double lost = 0., turned = 0.;
  for (int i = 0; i < 10000; ++i) {
    r.frame();
    lost = std::max(lost, std::abs(r.energy() - energy));
    turned = std::max(turned, std::abs(r.momentum()[5] - about_z));
  }
  CHECK(r.seen == Status::ok);
  INFO("energy " << lost << " of " << energy << ", momentum " << turned << " of " << about_z);
  // Newton leaves an ulp of positions of .1 m with 1 kg, so kg = 2e6 1/s2 of that in forces and an
  // arm of that in moments. All are to one side, over 10 s with the rotations in these.
  const double left = 4. * 1e-16 * .1 * options.scheme.kg * .1;
  CHECK(lost < left * sleeping_spin() * 10.);
  CHECK(turned < left * 10.);
}
