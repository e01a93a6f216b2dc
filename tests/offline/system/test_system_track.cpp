#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "support/condensed_tracks.h"
#include "support/system_run.h"

using namespace railstep;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Displacement of a point of the left rail's line when it carries a mass itself: dense matrices
/// and the scheme's formulas (scheme.h), from rest under the weight of the mass alone.
std::vector<double> carried_mass(const Track& track, double x, double mass, const Scheme& s,
                                 int steps) {
  const std::vector<Line> lines = assemble(track);
  const Line* line = nullptr;
  VectorXd b;
  for (const Line& l : lines)
    if (l.rail_factor[0] != 0. && VectorXd(point_row(track, l, {0, x, 0., 0., 2})).norm() > 0.) {
      line = &l;
      b = point_row(track, l, {0, x, 0., 0., 2});
    }
  REQUIRE(line != nullptr);
  const MatrixXd M = MatrixXd(line->mass) + mass * b * b.transpose();
  const MatrixXd C = line->damping, K = line->stiffness;
  const Eigen::LDLT<MatrixXd> S(K + s.kv * C + s.kg * M);
  const VectorXd f = -mass * kGravity * b;
  VectorXd u = VectorXd::Zero(b.size()), v = u, g = s.kg * S.solve(f), a = g;
  std::vector<double> moved;
  for (int n = 0; n < steps; ++n) {
    const VectorXd us = u + s.uv * v + s.ua * a + s.ug * g, vs = v + s.va * a + s.vg * g;
    const VectorXd next = S.solve(f + M * (s.kg * us) + C * (s.kv * us - vs));
    const VectorXd fresh = s.kg * (next - us);
    v = vs + s.kv * (next - us);
    a = s.ag * fresh + s.a0 * g + s.aa * a;
    u = next;
    g = fresh;
    moved.push_back(b.dot(u));
  }
  return moved;
}

System weight_on_rail(double x, double mass) {
  System s;
  s.bodies = {block(mass, {x, .75, 0.})};
  s.joints = {{.kind = JointKind::fixed, .a = rail(0), .b = body(0), .point = {x, .75, 0.}}};
  return s;
}

}  // namespace

TEST_CASE("a mass joined to a rail moves as one that the rail itself carries", "[system][track]") {
  Track track = peers_pair(1);
  track.rail_spacing = 1.5;
  const double x = .37 * track.element_length() + 5 * track.bay_length, mass = 80., dt = 1e-3;
  const std::vector<double> want = carried_mass(track, x, mass, generalised_alpha(dt, .6), 60);
  for (const ConstraintMethod hold :
       {ConstraintMethod::augmented_lagrangian, ConstraintMethod::direct}) {
    System scene = weight_on_rail(x, mass);
    scene.joints[0].kind = JointKind::spherical;
    // The joint is at the centre of mass, so the body does not rotate.
    SystemRun run(scene, {.constraint_method = hold}, track, full_order(dt));
    double worst = 0.;
    for (const double z : want) {
      run.frame();
      worst = std::max(worst, std::abs(run.body_position(0).z() - z));
    }
    // The force residual of 1e-8 of 785 N, over the rail's 3e7 N/m, leaves 3e-13 m per step, which
    // the damped track forgets; the deflection is 1e-5 m.
    CHECK(worst < 1e-11);
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("a sprung mass settles at the deflection of spring and track", "[system][track]") {
  Track track = peers_pair(2);
  track.rail_spacing = 1.5;
  const double x = 4.9, mass = 500., k = 2e6;
  SystemRun run(sprung_block(x, mass, k, 6e4), {}, track, {.scheme = backward_euler(5e-3)});
  run.until(4.);
  double compliance = 0.;
  for (const Line& line : assemble(track)) {
    const VectorXd b = point_row(track, line, {0, x, 0., 0., 2});
    if (b.norm() > 0.) compliance += b.dot(MatrixXd(line.stiffness).ldlt().solve(b));
  }
  const double want = -mass * kGravity * (1. / k + compliance);
  // 800 steps of 5 ms damp the slowest motion (10 Hz, 40 % damped) to below round-off.
  CHECK(run.body_position(0).z() - .5 == Approx(want).epsilon(1e-9));
  CHECK(run.state.row_force[run.model().system.joint_rows] ==
        Approx(-mass * kGravity).epsilon(1e-9));
}

TEST_CASE("left and right rails on sleepers carry mirrored bodies alike", "[system][track]") {
  const Track track = s1_track(6, 1);
  const double half = track.rail_spacing / 2., x = 1.7;
  const auto run_on = [&](int side) {
    const double sign = side == 0 ? 1. : -1.;
    System scene;
    scene.bodies = {block(60., {x + .1, sign * (half + .2), .3})};
    scene.joints = {{.kind = JointKind::fixed,
                     .a = rail(side),
                     .b = body(0),
                     .point = {x, sign * (half + .03), .05}}};
    scene.forces = {{.on = body(0),
                     .point = {x + .1, sign * (half + .2), .3},
                     .direction = {0., sign * 400., 0.},
                     .factor = {.polynomial = {1.}}}};
    SystemRun run(scene, {}, track, full_order(1e-4));
    run.until(.02);
    CHECK(run.seen == Status::ok);
    return run.body_position(0);
  };
  const Vector3d left = run_on(0), right = run_on(1);
  REQUIRE(std::abs(left.y() - half - .2) > 1e-6);  // it moves sideways
  // Mirror images differ by the round-off that iterations to 1e-8 of 600 N leave: 1e-5 N on a body
  // of 60 kg within 20 ms.
  CHECK((left - Vector3d(right.x(), -right.y(), right.z())).norm() < 1e-11);
}

TEST_CASE("joints to a missing track or beyond the rail's ends are refused", "[system][track]") {
  const Track track = peers_pair(1);
  System scene = weight_on_rail(1., 80.);
  CHECK_THROWS_WITH(PackedSystem(scene, {.scheme = generalised_alpha(1e-3, .6)}),
                    Catch::Contains("E-SYSTEM-04"));
  scene.joints[0].point.x() = 1e3;
  CHECK_THROWS_WITH(SystemRun(scene, {}, track, full_order(1e-3)), Catch::Contains("E-SYSTEM-06"));
}

TEST_CASE("features that a track beside bodies lacks are refused", "[system][track]") {
  const Track track = peers_pair(1);
  System scene = weight_on_rail(1., 80.);
  CHECK_THROWS_WITH(SystemRun(scene, {.constraint_method = ConstraintMethod::gear_gupta_leimkuhler},
                              track, full_order(1e-3)),
                    Catch::Contains("E-SYSTEM-60"));
  scene.forces = {{.on = rail(0), .point = {1., .75, 0.}, .factor = {.polynomial = {1.}}}};
  CHECK_THROWS_WITH(SystemRun(scene, {}, track, full_order(1e-3)), Catch::Contains("E-SYSTEM-21"));
}
