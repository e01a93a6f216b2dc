// A wheelset on rails that share sleepers: both sides respond equally; the guide's velocities.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "online/step/step.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;

namespace {

/// Rails with all their unknowns, on sleepers that roll and move sideways.
Track sleepers() {
  Track t;
  t.section = section_f();
  t.bays = 6;
  t.elements_per_bay = 1;
  t.support = {.stiffness = {50e6, 50e6, 200e6},
               .damping = {3e4, 3e4, 3e4},
               .roll_stiffness = .3e6,
               .roll_damping = 1e2,
               .height_z = -.085};
  t.sleeper = Sleeper{300., 300. * .75 * .75, {30e6, 30e6, 50e6}, {3e4, 3e4, 80e3}};
  return t;
}

struct GuidedRun {
  Track track = sleepers();
  std::vector<Line> lines = assemble(track);
  std::unique_ptr<PackedModel> packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};

  GuidedRun(double speed, Guide guide) {
    Wheelset w;
    w.mass = 1200.;
    w.inertia_roll = w.inertia_yaw = 700.;
    w.inertia_spin = 100.;
    w.weight = 100e3;
    w.start = 1.7;  // neither on a seat nor in the element's middle
    w.speed = speed;
    w.guide = guide;
    w.alpha = w.beta = 200.;
    packed = std::make_unique<PackedModel>(track,
                                           Traffic{.wheelsets = {w}, .head = {.1007375, .3, .038}},
                                           PackOptions{.scheme = generalised_alpha(5e-5, .6)});
    memory.assign(static_cast<std::size_t>(state_doubles(model())), 0.);
    scratch.assign(static_cast<std::size_t>(workspace_doubles(model())), 0.);
    state = state_on(model(), memory.data());
    workspace = workspace_on(model(), scratch.data());
  }

  const Model& model() const { return packed->model(); }
  int body(int k) const { return model().wheelset[0].first + k; }
  void step() {
    scratch.assign(scratch.size(), std::numeric_limits<double>::quiet_NaN());
    const Status met = advance_frame(model(), state, workspace, outputs);
    CHECK_FALSE(has(met, Status::cap_reached));
    CHECK_FALSE(has(met, Status::off_rail));
  }
  /// Displacement of the railhead's top under the wheelset, by the assembled track's own rows.
  double head(int rail, int direction) const {
    double sum = 0.;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const Eigen::Map<const Eigen::VectorXd> u(state.u + model().line[l].first,
                                                lines[l].unknowns());
      sum += point_row(track, lines[l], {rail, 1.7, 0., model().head_z[rail], direction}).dot(u);
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("a wheelset that rolls one way is the mirror image of one that rolls the other way",
          "[mirror]") {
  // Released at +-2 mrad, it stands on one wheel first and then rocks. Its normals lean with it, so
  // that they push and roll the rails sideways. The left rail of one run moves as the right rail of
  // the other. Rounding over 400 steps with contacts is 1e-9 of the largest.
  GuidedRun one(0., Guide::augmented_lagrangian), other(0., Guide::augmented_lagrangian);
  one.state.u[one.body(3)] = 2e-3;
  other.state.u[other.body(3)] = -2e-3;
  for (GuidedRun* run : {&one, &other})
    run->state.u[run->body(2)] = 2e-3 * .75;  // the lower touches
  double largest_force = 0., largest_y = 0., force_miss = 0., y_miss = 0., z_miss = 0.;
  double low = 0.;
  for (int i = 0; i < 400; ++i) {
    one.step();
    other.step();
    for (const int rail : {0, 1}) {
      const double force = one.outputs.contact_force[rail], y = one.head(rail, 1);
      largest_force = std::max(largest_force, force);
      largest_y = std::max(largest_y, std::abs(y));
      low = std::min(low, one.head(rail, 2));
      force_miss = std::max(force_miss, std::abs(force - other.outputs.contact_force[1 - rail]));
      y_miss = std::max(y_miss, std::abs(y + other.head(1 - rail, 1)));
      z_miss = std::max(z_miss, std::abs(one.head(rail, 2) - other.head(1 - rail, 2)));
    }
  }
  CAPTURE(largest_force, largest_y, low, force_miss, y_miss, z_miss);
  CHECK(force_miss < 1e-9 * largest_force);
  CHECK(y_miss < 1e-9 * largest_y);
  CHECK(z_miss < -1e-9 * low);
}

TEST_CASE("the guide's constraint holds velocity and acceleration as well as position", "[guide]") {
  // The wheelset starts at rest where it should run at 10 m/s. Velocities that swing about 10 m/s
  // by as much could hold the position alone, for as long as the scheme remembers.
  GuidedRun run(10., Guide::augmented_lagrangian);
  for (int i = 1; i <= 5; ++i) {
    run.step();
    CHECK_THAT(run.state.u[run.body(0)],
               WithinAbs(10. * i * 5e-5, 1e-10));  // the guide's tolerance
    CHECK(run.state.v[run.body(0)] == 10.);
    CHECK(run.state.v[run.body(5)] == 0.);
    CHECK(run.state.g[run.body(0)] == 0.);
    CHECK(run.state.g[run.body(5)] == 0.);
  }
}

TEST_CASE("Baumgarte's guide corrects a wrong start at its own rate", "[guide]") {
  // x'' + 2 a x' + b^2 x = 0 with a = b = 200 1/s and a velocity error of -10 m/s has x = -10 t
  // exp(-200 t). The scheme errs by (200 dt)^2 = 1e-4 of it in shape.
  GuidedRun run(10., Guide::baumgarte);
  run.state.a[run.body(0)] = run.state.g[run.body(0)] = 2. * 200. * 10.;  // x'' at the start
  double largest = 0., miss = 0.;
  for (int i = 1; i <= 400; ++i) {
    run.step();
    const double t = 5e-5 * i, want = -10. * t * std::exp(-200. * t);
    largest = std::max(largest, -want);
    miss = std::max(miss, std::abs(run.state.u[run.body(0)] - 10. * t - want));
  }
  CHECK(miss < 1e-3 * largest);
}
