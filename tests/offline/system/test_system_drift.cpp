#include <catch2/catch.hpp>
#include <cmath>

#include "support/system_run.h"

using namespace railstep;
using Eigen::Vector3d;

namespace {

/// A rod on a hinge at the origin in its plane, released from the horizontal.
System pendulum() {
  System s;
  s.planar = true;
  s.bodies = {rod_body(Vector3d::Zero(), 1., 0., 1., .05)};
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), true)};
  return s;
}

/// Speed of the middle of that rod when it hangs, m/s: I = m (L^2/3 + side^2/12) about the hinge.
const double kLowest = .5 * std::sqrt(kGravity / (1. / 3. + .05 * .05 / 12.));

/// Largest distance of the rod's end from its hinge in the first and in the last tenth of `steps`
/// steps, m.
struct Drift {
  double first = 0., last = 0.;
  double speed = 0.;  // of the rod's middle, largest of the last tenth, m/s
  Status seen = Status::ok;
};
Drift drift(const SystemOptions& options, int steps) {
  SystemRun r(pendulum(), options);
  Drift d;
  for (int i = 0; i < steps; ++i) {
    r.frame();
    const double off = r.point_of_body(0, Vector3d::Zero()).norm();
    if (i < steps / 10) d.first = std::max(d.first, off);
    if (i < steps - steps / 10) continue;
    d.last = std::max(d.last, off);
    d.speed = std::max(d.speed, r.body_velocity(0).norm());
  }
  d.seen = r.seen;
  return d;
}

}  // namespace

TEST_CASE("a hinge stays closed over 1e6 steps of a pendulum", "[system]") {
  // This is H22 of hard-cases.md.
  const Drift d = drift(sharp(energy_momentum(1e-3)), 1000000);
  INFO("off by " << d.first << " m in the first 1e5 steps, " << d.last << " in the last");
  CHECK(!has(d.seen, Status::nonfinite_state));
  CHECK(d.first < 1e-12);
  CHECK(d.last < 1e-12);
  // It still swings down from the horizontal: m g L/2 = I w^2/2. Within half a step of the lowest
  // place it is slower by (w h)^2/16 and less.
  CHECK_THAT(d.speed, Catch::WithinRel(kLowest, 1e-5));
}

TEST_CASE("Baumgarte's hinge does not drift over 1e6 steps", "[system]") {
  const Drift d = drift(sharp(generalised_alpha(1e-3, 1.), ConstraintMethod::baumgarte), 1000000);
  INFO("off by " << d.first << " m in the first 1e5 steps, " << d.last << " in the last");
  CHECK(!has(d.seen, Status::nonfinite_state));
  // The scheme does not damp, so each swing repeats the first; it could only lose energy.
  CHECK(d.speed > .9 * kLowest);
  CHECK(d.first > 0.);
  CHECK(d.last < 1.1 * d.first);
  // A step errs by w^4 h^4 / 12 of 1 m at w = 6 rad/s, over the 5 steps of its decay.
  CHECK(d.first < 1e-6);
}
