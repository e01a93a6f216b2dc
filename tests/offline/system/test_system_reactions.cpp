#include <catch2/catch.hpp>
#include <cmath>

#include "support/high_order.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinRel;
using Eigen::Vector3d;

namespace {

const ConstraintMethod kAllMethods[] = {
    ConstraintMethod::augmented_lagrangian, ConstraintMethod::baumgarte,
    ConstraintMethod::gear_gupta_leimkuhler, ConstraintMethod::direct};

}  // namespace

TEST_CASE("the joint of a hanging body carries its weight", "[system]") {
  const bool planar = GENERATE(true, false);
  for (const ConstraintMethod hold : kAllMethods) {
    System s;
    s.planar = planar;
    s.bodies = {rod_body(Vector3d::Zero(), 1., -2. * std::atan(1.), 3., .05)};
    s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar)};
    SystemRun r(s, sharp(generalised_alpha(1e-3, .9), hold));
    for (int i = 0; i < 200; ++i) r.frame();
    INFO("hold " << static_cast<int>(hold));
    CHECK(r.seen == Status::ok);
    // Positions of 1 m are known to some ulp, 1e-15 m; forces to m kg = 1e7 N/m of that.
    CHECK(largest(r.joint_force(0) - Vector3d(0., 0., 3. * kGravity)) < 1e-7);
    CHECK(largest(r.joint_moment(0)) < 1e-7);
  }
}

TEST_CASE("a clamped lever carries its weight and its moment", "[system]") {
  // A rod of 2 m and 3 kg along x is fixed at its start; its end bears 10 N upwards and 4 N along
  // y.
  for (const ConstraintMethod hold : kAllMethods) {
    System s;
    s.bodies = {rod_body(Vector3d::Zero(), 2., 0., 3., .05)};
    s.joints = {{.kind = JointKind::fixed, .a = ground(), .b = body(0)}};
    s.forces = {{.on = body(0),
                 .point = {2., 0., 0.},
                 .direction = {0., 4., 10.},
                 .factor = {.polynomial = {1.}}}};
    SystemRun r(s, sharp(generalised_alpha(1e-3, .9), hold));
    for (int i = 0; i < 200; ++i) r.frame();
    INFO("hold " << static_cast<int>(hold));
    CHECK(r.seen == Status::ok);
    CHECK(largest(r.body_position(0) - Vector3d(1., 0., 0.)) < 1e-11);
    // As above.
    CHECK(largest(r.joint_force(0) - Vector3d(0., -4., 3. * kGravity - 10.)) < 1e-7);
    // Balance about the clamp is M + r x F + r_g x W = 0; (2,0,0) x (0,4,10) = (0,-20,8), and
    // (1,0,0) x (0,0,-3 g) = (0, 3 g, 0).
    CHECK(largest(r.joint_moment(0) - Vector3d(0., 20. - 3. * kGravity, -8.)) < 1e-7);
  }
}

TEST_CASE("the pivot of a see-saw and a guide under its end share the load", "[system]") {
  // A rod of 3 m and 2 kg is hinged 1 m from its start, and its end stays level: by moments about
  // the hinge the end bears .5 m / 2 m of the weight.
  System s;
  s.planar = true;
  s.bodies = {rod_body(Vector3d(-1., 0., 0.), 3., 0., 2., .05)};
  s.joints = {hinge(ground(), body(0), Vector3d::Zero(), true),
              {.kind = JointKind::point_on_line,
               .a = ground(),
               .b = body(0),
               .point = {2., 0., 0.},
               .axis = Vector3d::UnitX()}};
  SystemRun r(s, sharp(generalised_alpha(1e-3, .9)));
  for (int i = 0; i < 200; ++i) r.frame();
  CHECK(r.seen == Status::ok);
  CHECK(largest(r.joint_force(0) - Vector3d(0., 0., .75 * 2. * kGravity)) < 1e-7);
  CHECK(largest(r.joint_force(1) - Vector3d(0., 0., .25 * 2. * kGravity)) < 1e-7);
}

TEST_CASE("a swinging pendulum pulls on its hinge with m g cos + m l w^2", "[system]") {
  // A rod of 1 m has its centre at l = .5 m and I = m (l^2 + (1 + .05^2) / 12) about the hinge. At
  // the angle a below the horizontal start w^2 = 2 m g l sin(a) / I. The force over m is g sin(a) +
  // l w^2 along the rod and g cos(a) (1 - m l^2 / I) across it.
  const bool planar = GENERATE(true, false);
  const double m = 2., l = .5, inertia = m * (l * l + (1. + .05 * .05) / 12.);
  for (const ConstraintMethod hold : kAllMethods) {
    const auto error = [&](double h) {
      System s;
      s.planar = planar;
      s.bodies = {rod_body(Vector3d::Zero(), 1., 0., m, .05)};
      s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar)};
      SystemRun r(s, sharp(generalised_alpha(h, .6), hold));
      double most = 0.;
      while (r.time() < .8 - .5 * h) {
        r.frame();
        if (r.time() < .1) continue;  // .6^100: the start's oscillation is over
        const Vector3d along = r.body_rotation(0).col(0), across(-along.z(), 0., along.x());
        const double sine = -along.z(), cosine = along.x();
        const double w2 = 2. * m * kGravity * l * sine / inertia;
        const Vector3d force = -m * (kGravity * sine + l * w2) * along +
                               m * kGravity * cosine * (1. - m * l * l / inertia) * across;
        most = std::max(most, largest(r.joint_force(0) - force));
      }
      CHECK(r.seen == Status::ok);
      return most;
    };
    const double coarse = error(1e-3), fine = error(5e-4);
    INFO("hold " << static_cast<int>(hold) << ": " << coarse << " " << fine << " N of 49 N");
    CHECK(fine < 49. * 1e-4);  // (w h)^2 = 1e-5 of it, times 10
    CHECK(order(coarse, fine) > 1.8);
  }
}

TEST_CASE("a spinning rod pulls on its hinge with m r w^2", "[system]") {
  const bool planar = GENERATE(true, false);
  const double w = 20.;
  for (const ConstraintMethod hold : kAllMethods) {
    System s;
    s.planar = planar;
    s.gravity.setZero();
    s.bodies = {rod_body(Vector3d::Zero(), 1., .3, 2., .05, Vector3d::Zero(), w)};
    s.joints = {hinge(ground(), body(0), Vector3d::Zero(), planar)};
    const double h = 1e-3;
    SystemRun r(s, sharp(generalised_alpha(h, .9), hold));
    for (int i = 0; i < 500; ++i) r.frame();
    const Vector3d pull = -2. * .5 * w * w * r.body_rotation(0).col(0);
    INFO("hold " << static_cast<int>(hold) << ", force " << r.joint_force(0).norm());
    CHECK(r.seen == Status::ok);
    // On a circle the scheme's acceleration has a relative error of (w h)^2 = 4e-4, over 3 or less.
    CHECK(largest(r.joint_force(0) - pull) < w * w * h * h * pull.norm() / 3.);
    // The rate does not change.
    CHECK_THAT(-r.body_spin(0).y(), WithinRel(w, 1e-4));
  }
}

TEST_CASE("an accelerated slider pulls on its drive with m a", "[system]") {
  const System s = [] {
    System scene;
    RigidBody b;
    b.mass = 4.;
    b.inertia = Eigen::Matrix3d::Identity();
    b.velocity = {.5, 0., 0.};
    scene.bodies = {b};
    scene.joints = {{.kind = JointKind::prismatic, .a = ground(), .b = body(0)},
                    {.kind = JointKind::translation,
                     .a = ground(),
                     .b = body(0),
                     .motion = {.polynomial = {0., .5, 1., -.3}}}};
    return scene;
  }();
  for (const ConstraintMethod hold : kAllMethods) {
    SystemRun r(s, sharp(generalised_alpha(1e-3, .9), hold));
    r.until(1.);
    INFO("hold " << static_cast<int>(hold));
    CHECK(r.seen == Status::ok);
    // The force is 4 kg (2 - 1.8 t): the scheme's accelerations of a cubic motion lag by less than
    // a step, 1.8 h.
    CHECK(largest(r.joint_force(1) - Vector3d(4. * (2. - 1.8), 0., 0.)) < 4. * 1.8e-3);
    CHECK(largest(r.joint_force(0) - Vector3d(0., 0., 4. * kGravity)) < 1e-7);
  }
}
