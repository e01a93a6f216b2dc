#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A crank about the origin, a connecting rod, and a slider along x.
struct SliderCrank {
  double crank = .2, rod = .5;                              // m
  double crank_mass = 1., rod_mass = 2., slider_mass = 3.;  // kg
  double side = .02;                                        // side of the square sections, m
  double start = .7, rate = 3.;  // of the crank: rad from x towards z, rad/s

  double rod_angle(double angle) const { return std::asin(-crank / rod * std::sin(angle)); }
  /// d(rod angle)/d(angle)
  double rod_ratio(double angle) const {
    return -crank * std::cos(angle) / (rod * std::cos(rod_angle(angle)));
  }
  Vector3d pin(double angle) const {
    return {crank * std::cos(angle), 0., crank * std::sin(angle)};
  }
  double slider(double angle) const {
    return crank * std::cos(angle) + rod * std::cos(rod_angle(angle));
  }
  /// dx/d(angle)
  double slider_ratio(double angle) const {
    return -crank * std::sin(angle) - rod * std::sin(rod_angle(angle)) * rod_ratio(angle);
  }
  System scene(bool planar) const;
  Eigen::VectorXd slope(const Eigen::VectorXd& y) const;
};

System SliderCrank::scene(bool planar) const {
  System s;
  s.planar = planar;
  const double angle = rod_angle(start);
  const Vector3d across(-std::sin(start), 0., std::cos(start));
  RigidBody block;
  block.mass = slider_mass;
  block.inertia = 1e-3 * Eigen::Matrix3d::Identity();
  block.position = {slider(start), 0., 0.};
  block.velocity = {slider_ratio(start) * rate, 0., 0.};
  s.bodies = {rod_body(Vector3d::Zero(), crank, start, crank_mass, side, Vector3d::Zero(), rate),
              rod_body(pin(start), rod, angle, rod_mass, side, crank * rate * across,
                       rod_ratio(start) * rate),
              block};
  const Joint rail = {.kind = JointKind::prismatic,
                      .a = ground(),
                      .b = body(2),
                      .point = block.position,
                      .axis = Vector3d::UnitX()};
  // In space hinges about y would be redundant in the loop; a ball and a universal joint are not.
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar),
              {.kind = JointKind::spherical, .a = body(0), .b = body(1), .point = pin(start)},
              hinge(body(1), body(2), block.position, true),
              rail};
  if (!planar)
    s.joints[1] = {.kind = JointKind::universal,
                   .a = body(0),
                   .b = body(1),
                   .point = pin(start),
                   .axis = Vector3d::UnitY(),
                   .other_axis = Vector3d(-std::sin(angle), 0., std::cos(angle))};
  return s;
}

/// Rates of the crank's angle and rate: M(angle) angle'' + M' angle'^2 / 2 + V' = 0, from the
/// positions of the centres p(angle) and their derivatives p' and p''.
Eigen::VectorXd SliderCrank::slope(const Eigen::VectorXd& y) const {
  const double c = std::cos(y[0]), s = std::sin(y[0]), b = rod_angle(y[0]), db = rod_ratio(y[0]);
  // sin b = -(crank / rod) sin a: cos b b'' - sin b b'^2 = (crank / rod) sin a
  const double ddb = (crank / rod * s + std::sin(b) * db * db) / std::cos(b);
  const auto half = [&](double mass, double length) {
    return mass * (length * length + side * side) / 12.;
  };
  struct Point {
    double mass;
    Vector2d d, dd;
  };
  const Vector2d crank_d = crank * Vector2d(-s, c), crank_dd = crank * Vector2d(-c, -s);
  const Vector2d rod_d = rod * db * Vector2d(-std::sin(b), std::cos(b));
  const Vector2d rod_dd = rod * (ddb * Vector2d(-std::sin(b), std::cos(b)) -
                                 db * db * Vector2d(std::cos(b), std::sin(b)));
  const Point points[] = {{crank_mass, .5 * crank_d, .5 * crank_dd},
                          {rod_mass, crank_d + .5 * rod_d, crank_dd + .5 * rod_dd},
                          {slider_mass, crank_d + rod_d, crank_dd + rod_dd}};
  double M = half(crank_mass, crank) + half(rod_mass, rod) * db * db;
  double half_slope = half(rod_mass, rod) * db * ddb, pull = 0.;
  for (const Point& p : points) {
    M += p.mass * p.d.squaredNorm();
    half_slope += p.mass * p.d.dot(p.dd);
    pull += p.mass * kGravity * p.d[1];
  }
  Eigen::VectorXd d(2);
  d << y[1], -(half_slope * y[1] * y[1] + pull) / M;
  return d;
}

}  // namespace

TEST_CASE("a driven crank puts its slider where geometry says", "[system]") {
  const bool planar = GENERATE(true, false);
  const SliderCrank m;
  System s = m.scene(planar);
  // About y a body rotates from z towards x: from x towards z the sign is negative.
  s.joints.push_back({.kind = JointKind::rotation,
                      .a = ground(),
                      .b = body(0),
                      .axis = Vector3d::UnitY(),
                      .motion = {.polynomial = {0., -m.rate, -2.}}});
  SystemRun r(s, sharp(generalised_alpha(1e-3, .8)));
  double place = 0., speed = 0.;
  for (int i = 0; i < 2000; ++i) {
    r.frame();
    const double t = r.time(), angle = m.start + m.rate * t + 2. * t * t, w = m.rate + 4. * t;
    place = std::max(place, std::abs(r.body_position(2).x() - m.slider(angle)));
    speed = std::max(speed, std::abs(r.body_velocity(2).x() - m.slider_ratio(angle) * w));
  }
  CHECK(r.seen == Status::ok);
  INFO("slider " << place << " m, " << speed << " m/s");
  // Joints hold to 1e-12 per row; the ratio dx/da stays below .25 m, and its inverse is not used.
  CHECK(place < 1e-11);
  CHECK(speed < 1e-9);  // a projection to the rows' rates of 1e-12 / h
}

TEST_CASE("a free slider-crank runs as its one equation says", "[system]") {
  const bool planar = GENERATE(true, false);
  const SliderCrank m;
  Eigen::VectorXd y(2);
  y << m.start, m.rate;
  const HighOrder known =
      high_order([&](double, const Eigen::VectorXd& at) { return m.slope(at); }, y, {0., 1.}, .01);
  REQUIRE(known.own_error < 1e-11);
  const auto error = [&](const Scheme& scheme) {
    SystemRun r(m.scene(planar), sharp(scheme));
    r.until(1.);
    CHECK(r.seen == Status::ok);
    return std::abs(r.body_position(2).x() - m.slider(known.y[1][0]));
  };
  for (const SchemeOrder& c : kSchemeOrders) {
    const double h = c.order > 1.5 ? 1e-3 : 2e-4;
    const double coarse = error(c.scheme(h)), fine = error(c.scheme(h / 2.));
    INFO(coarse << " and " << fine << " m at " << h << " s and its half");
    // The next term is of relative order w h: .02, and .004 some 10 times for the first order.
    CHECK_THAT(order(coarse, fine), WithinAbs(c.order, .15));
  }
}

namespace {

/// Rods of 1 m and 1 kg at 45 degrees; the second rod's end is on the x axis and starts at -4 m/s.
System equal_arms() {
  System s;
  s.planar = true;
  const double angle = std::atan(1.), rate = 4. / (2. * std::sin(angle));
  const Vector3d pin(std::cos(angle), 0., std::sin(angle));
  const Vector3d end(2. * std::cos(angle), 0., 0.);
  s.bodies = {rod_body(Vector3d::Zero(), 1., angle, 1., 0., Vector3d::Zero(), rate),
              rod_body(pin, 1., -angle, 1., 0.,
                       rate * Vector3d(-std::sin(angle), 0., std::cos(angle)), -rate)};
  for (RigidBody& b : s.bodies) b.inertia(0, 0) = 1e-3;  // about its own axis: not used in plane
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), true),
              hinge(body(0), body(1), pin, true),
              {.kind = JointKind::point_on_line,
               .a = ground(),
               .b = body(1),
               .point = end,
               .axis = Vector3d::UnitX()}};
  return s;
}

}  // namespace

TEST_CASE("an equal-arm slider-crank passes its singular position", "[system]") {
  // R8 of hard-cases.md, to 1e-8. At 90 degrees both arms lie on each other; there the slider could
  // stay while they rotate as one.
  constexpr double kUpright = .391732135, kRate = 1.68672409, kAt1 = -1.95128839;
  constexpr double kAt10 = -1.06179862;
  const Vector3d end(std::sqrt(2.), 0., 0.);
  const bool by_mean = GENERATE(true, false);
  const auto options = [&](double h) {
    return sharp(by_mean ? energy_momentum(h) : generalised_alpha(h, .95));
  };
  const auto run = [&](double h, double t, double& lost) {
    SystemRun r(equal_arms(), options(h));
    const double energy = r.energy();
    const auto steps = std::llround(t / h);
    for (std::int64_t i = 0; i < steps; ++i) {
      r.frame();
      lost = std::max(lost, std::abs(r.energy() - energy));
    }
    INFO("violation " << r.violation);
    CHECK(!has(r.seen, Status::nonfinite_state));
    CHECK(r.violation < 1e-6);
    return r.point_of_body(1, end).x();
  };
  double lost = 0.;
  const double coarse = std::abs(run(1e-3, 1., lost) - kAt1);
  const double fine = std::abs(run(5e-4, 1., lost) - kAt1);
  INFO("errors at 1 s: " << coarse << " " << fine << ", energy " << lost);
  // w^3 t h^2 / 12 at the fastest 4 rad/s is 5e-6 rad at 1 ms, times an arm of 2 m, times 10 as
  // neighbouring motions diverge while they slow down over the top.
  CHECK(coarse < 1e-4);
  CHECK(fine < .3 * coarse + 1e-8);
  CHECK(lost < 1e-3);  // H21

  // 10 s: H21's energy. The position's order: half the step has a quarter of the error.
  lost = 0.;
  const double late = std::abs(run(1e-3, 10., lost) - kAt10);
  const double later = std::abs(run(5e-4, 10., lost) - kAt10);
  INFO("errors at 10 s: " << late << " " << later << ", energy " << lost);
  CHECK(lost < 1e-3);
  CHECK(later < .3 * late + 1e-8);

  // Upright: angle and rate of the crank at the published time, by a parabola between steps.
  SystemRun r(equal_arms(), options(2.5e-4));
  r.until(kUpright - 1e-4);
  const double left = kUpright - r.time(), rate = -r.body_spin(0).y();
  const Vector3d along = r.body_rotation(0).col(0);
  const double angle = std::atan2(along.z(), along.x()) + rate * left;
  // angle'' = -g cos / (...) is 0 when upright.
  CHECK_THAT(angle, WithinAbs(2. * std::atan(1.), 1e-5));
  CHECK_THAT(rate, WithinAbs(kRate, 1e-5));
}
