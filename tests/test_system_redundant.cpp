#include <catch2/catch.hpp>
#include <cmath>

#include "bricard.h"
#include "system_run.h"

using namespace railstep;
using Eigen::Vector3d;

namespace {

/// A rod on a hinge at the origin, let go from the horizontal, whose hinge is said `times` times.
System pendulum(bool planar, int times) {
  System s;
  s.planar = planar;
  s.bodies = {rod_body(Vector3d::Zero(), 1., 0., 1., .05)};
  for (int i = 0; i < times; ++i)
    s.joints.push_back(hinge(ground(), body(0), Vector3d::Zero(), planar));
  return s;
}

Vector3d end(const SystemRun& r) { return r.point_of_body(0, Vector3d::UnitX()); }

}  // namespace

TEST_CASE("a doubled hinge moves as a single one", "[system]") {
  // hard-cases.md, H20.
  const bool planar = GENERATE(true, false);
  const Scheme scheme = GENERATE(generalised_alpha(1e-3, .9), energy_momentum(1e-3));
  SystemRun single(pendulum(planar, 1), sharp(scheme));
  SystemRun twice(pendulum(planar, 2), sharp(scheme)), thrice(pendulum(planar, 3), sharp(scheme));
  double apart = 0.;
  for (int i = 0; i < 2000; ++i) {
    for (SystemRun* r : {&single, &twice, &thrice}) r->frame();
    apart = std::max({apart, largest(end(single) - end(twice)), largest(end(single) - end(thrice))});
  }
  INFO("apart " << apart << " m");
  CHECK((single.seen | twice.seen | thrice.seen) == Status::ok);
  CHECK(apart < 1e-9);
  // Together they carry what the one does, and alike.
  const Vector3d one = single.joint_force(0), first = twice.joint_force(0),
                 second = twice.joint_force(1);
  CHECK((first + second - one).norm() < 1e-6 * one.norm());
  CHECK((first - second).norm() < 1e-6 * one.norm());
}

TEST_CASE("the direct solve names redundant joints", "[system]") {
  const bool planar = GENERATE(true, false);
  const SystemOptions direct = sharp(generalised_alpha(1e-3, .9), Hold::direct);
  SystemRun single(pendulum(planar, 1), direct), twice(pendulum(planar, 2), direct);
  for (int i = 0; i < 1000; ++i) {
    single.frame();
    twice.frame();
  }
  CHECK(single.seen == Status::ok);
  CHECK(twice.seen == Status::redundant_joint);
  CHECK(largest(end(single) - end(twice)) < 1e-9);
}

TEST_CASE("the direct solve names Bricard's one row too many and goes on", "[system]") {
  const Bricard m;
  SystemRun direct(m.scene(), sharp(generalised_alpha(1e-3, .9), Hold::direct));
  SystemRun augmented(m.scene(), sharp(generalised_alpha(1e-3, .9)));
  for (int i = 0; i < 1000; ++i) {
    direct.frame();
    augmented.frame();
  }
  CHECK(has(direct.seen, Status::redundant_joint));
  CHECK(augmented.seen == Status::ok);
  double apart = 0.;
  for (int i = 0; i < 5; ++i)
    apart = std::max(apart, largest(direct.body_position(i) - augmented.body_position(i)));
  // Which row is left out changes nothing of a closed loop but round-off: joint tolerance 1e-12
  // over the loop's smallest share of motion, 1e-3, and 1 s of swinging.
  CHECK(apart < 1e-8);
}
