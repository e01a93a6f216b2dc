#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "offline/analysis/statics.h"
#include "support/condensed_tracks.h"
#include "support/system_run.h"

using namespace railstep;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

TEST_CASE("a sprung block and its track start at rest and stay there", "[system][rest][track]") {
  Track track = peers_pair(2);
  track.rail_spacing = 1.5;
  const double x = 4.9, mass = 500., k = 2e6;
  PackOptions options = full_order(1e-3);
  options.gravity = kGravity;
  SystemRun run(sprung_block(x, mass, k, 2e4), {.at_rest = true}, track, options);
  // statics.h solves it independently: the rails' weight, and that of the block on the rail.
  const Statics statics(track);
  const std::vector<VectorXd> u = statics.solve({{{0, x, 0., 0., 2}, -mass * kGravity}}, kGravity);
  double rail = 0.;
  const std::vector<Line> lines = assemble(track);
  for (std::size_t l = 0; l < lines.size(); ++l)
    rail += VectorXd(point_row(track, lines[l], {0, x, 0., 0., 2})).dot(u[l]);
  const double want = rail - mass * kGravity / k;
  const double at_start = run.body_position(0).z() - .5;
  // 1e-9 m/s2 of this block, over its (2 pi 10)^2 /s2, is 3e-13 m.
  CHECK(at_start == Approx(want).margin(1e-12));
  CHECK(run.state.row_force[run.model().system.joint_rows] ==
        Approx(-mass * kGravity).epsilon(1e-9));
  double moved = 0.;
  for (int n = 0; n < 300; ++n) {
    run.frame();
    moved = std::max(moved, std::abs(run.body_position(0).z() - .5 - at_start));
  }
  CHECK(moved < 1e-12);
  CHECK(run.seen == Status::ok);
}

TEST_CASE("a body hinged to a rail starts at rest below it", "[system][rest][track]") {
  // It is given at 45 degrees beside the rail: the rotation is large.
  Track track = peers_pair(1);
  track.rail_spacing = 1.5;
  const double x = 3., length = .5;
  System s;
  s.bodies = {block(20., {x, .75 + length / std::sqrt(2.), -length / std::sqrt(2.)})};
  s.joints = {{.kind = JointKind::revolute,
               .a = rail(0),
               .b = body(0),
               .point = {x, .75, 0.},
               .axis = Vector3d::UnitX()}};
  SystemRun run(s, {.at_rest = true}, track, full_order(1e-3));
  const Vector3d start = run.body_position(0);
  CHECK(std::abs(start.y() - .75) < 1e-8);
  CHECK(start.z() == Approx(-length).margin(1e-4));
  CHECK(run.joint_force(0).z() == Approx(20. * kGravity).epsilon(1e-8));
  run.until(.2);
  CHECK((run.body_position(0) - start).norm() < 1e-8);
}

TEST_CASE("a start at rest under moving loads moves along with them", "[system][rest][track]") {
  // A run whose load came slowly from far is compared with the start: both are quasi-static.
  Track track = peers_pair(2);
  track.rail_spacing = 1.5;
  const double x = 4.9, speed = .2;
  const auto load_from = [&](double start) {
    return Traffic{
        .loads = {{.rail = 0, .start = start, .speed = speed, .stop = 1e9, .force = -5e4}}};
  };
  const PackOptions options = full_order(1e-3);
  const SystemRun start(sprung_block(x, 500., 2e6, 2e4), {.at_rest = true}, track, options,
                        load_from(x - .3));
  SystemRun run(sprung_block(x, 500., 2e6, 2e4), {.at_rest = true}, track, options,
                load_from(x - .3 - 2. * speed));
  run.until(2.);
  // A quasi-static motion v has the acceleration v' v. 2 s of motion with 40 % damping forget the
  // start. The rest is (v / l)^2 / w^2 of the displacement, with l 0.7 m and w 60 /s: 2e-5 of it.
  CHECK(run.body_velocity(0).z() == Approx(start.body_velocity(0).z()).epsilon(1e-2));
  CHECK(std::abs(start.body_velocity(0).z()) > 1e-5);
  CHECK(run.body_position(0).z() - .5 == Approx(start.body_position(0).z() - .5).epsilon(1e-4));
}

TEST_CASE("a start at rest adds the speed of a drive", "[system][rest][track]") {
  // A disc with its mass off its axle rotates at w: centripetal force acts from the start.
  Track track = peers_pair(1);
  track.rail_spacing = 1.5;
  const double x = 3., off = .02, w = 50., mass = 10.;
  System s;
  s.bodies = {block(mass, {x, .75 + off, 0.})};
  s.joints = {{.kind = JointKind::revolute,
               .a = rail(0),
               .b = body(0),
               .point = {x, .75, 0.},
               .axis = Vector3d::UnitX()},
              {.kind = JointKind::rotation,
               .a = rail(0),
               .b = body(0),
               .point = {x, .75, 0.},
               .axis = Vector3d::UnitX(),
               .motion = {.polynomial = {0., w}}}};
  const SystemRun run(s, {.at_rest = true}, track, full_order(1e-4));
  CHECK(run.body_spin(0).x() == Approx(w).epsilon(1e-12));
  // Newton's law for the disc, with independent accelerations and joint forces: from the mobility
  // of rail and disc, and from the balance of the state at rest.
  const int first = run.model().system.first + run.body(0).first;
  const Vector3d acceleration = Eigen::Map<const Vector3d>(run.state.g + first);
  const Vector3d force = run.joint_force(0) - Vector3d(0., 0., mass * kGravity);
  CHECK((force - mass * acceleration).norm() < 1e-9 * mass * off * w * w);
  CHECK(force.y() == Approx(-mass * off * w * w).epsilon(1e-9));  // these rails move only along z
  CHECK(run.body_position(0).z() < -1e-6);
}

TEST_CASE("the start names the body that does not come to rest", "[system][rest]") {
  System s;
  s.bodies = {block(3., {0., 0., 1.})};
  CHECK_THROWS_WITH(PackedSystem(s, {.scheme = generalised_alpha(1e-3, .6), .at_rest = true}),
                    Catch::Contains("body 0") && Catch::Contains("E-SYSTEM-62"));
  s.joints = {{.kind = JointKind::spherical, .a = ground(), .b = body(0), .point = {0., 0., 1.}}};
  CHECK_NOTHROW(PackedSystem(s, {.scheme = generalised_alpha(1e-3, .6), .at_rest = true}));
}
