#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/pack/time_schemes.h"
#include "support/condensed_tracks.h"
#include "support/rigid_track.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

ModelRun wheelset_run(const Track& track, const Wheelset& wheelset, const PackOptions& options) {
  return {track, {.wheelsets = {wheelset}, .head = kHead}, options};
}

PackOptions options(double dt) { return {.scheme = generalised_alpha(dt, .6)}; }

}  // namespace

TEST_CASE("the paper's wheelset settles in its static equilibrium", "[wheelset]") {
  ModelRun run = wheelset_run(paper_track(), paper_wheelset(3.2), options(1e-4));
  run.until(1.);
  CHECK(run.seen == Status::ok);
  // Wheels without friction carry half the weight each, however the rails move.
  for (int i = 0; i < 2; ++i) CHECK_THAT(run.outputs.contact_force[i], WithinRel(490.5, 1e-9));
  // Both rails under their wheel, at the head and at the axis below it; statics has no contact.
  const Statics statics(paper_track());
  std::vector<PointForce> forces;
  for (const int rail : {0, 1}) forces.push_back({{rail, 3.2, 0., kHead.top_z, 2}, -490.5});
  const auto u = statics.solve(forces);
  const double axis = statics.at(u, {0, 3.2, 0., 0., 2});
  const double head = statics.at(u, {0, 3.2, 0., kHead.top_z, 2});
  // Both find one equilibrium; after 1 s less than 1e-8 of the fall is left.
  const std::ptrdiff_t place = 2 * (run.model().residual.points + 1);
  const double missed = 490.5 * run.model().residual.axis[place];
  CHECK_THAT(run.outputs.contact_rail_z[0], WithinRel(axis - missed, 1e-6));
  CHECK_THAT(run.outputs.contact_rail_z[1], WithinRel(axis - missed, 1e-6));
  // reference.md has a Hertz approach of 3.615e-6 m under 490.5 N, printed to 4 digits.
  CHECK_THAT(-run.outputs.contact_gap[0], WithinAbs(3.615e-6, 1e-9));
  const double residual = 490.5 * run.model().residual.under[place];
  CHECK_THAT(run.body()[2], WithinAbs(head - residual + run.outputs.contact_gap[0], 1e-10));
}

TEST_CASE("a wheelset released as it touches sinks as in the reference", "[wheelset]") {
  // reference.md has the lowest wheel position -7.67e-5 m at 25.5 ms, to 3 digits. Its load acts on
  // the axis; the head is lower by its squeeze (0.02e-5), and both have the Hertz approach.
  ModelRun run = wheelset_run(paper_track(), paper_wheelset(3.2), options(1e-4));
  double lowest = 0., when = 0.;
  while (run.time() < .1) {
    run.step();
    if (run.body()[2] < lowest) {
      lowest = run.body()[2];
      when = run.time();
    }
  }
  CHECK_THAT(lowest, WithinRel(-7.67e-5, .01));
  CHECK_THAT(when, WithinAbs(25.5e-3, .5e-3));
}

TEST_CASE("on cylinders without friction nothing resists a lateral force", "[wheelset]") {
  // reference.md has y = 0.05 t^2 for 10 N on 100 kg.
  Wheelset w = paper_wheelset(3.2);
  w.forces = {{1, {-1., 10., 1., 10.}}};
  ModelRun run = wheelset_run(paper_track(), w, options(1e-4));
  run.until(.2);
  CHECK_THAT(run.body()[1], WithinRel(.05 * .2 * .2, 2e-3));
}

TEST_CASE("a wheel dropped on a rigid rail bounces with its energy", "[wheelset]") {
  // R1 of hard-cases.md: one wheel of 600 kg without weight at 0.1 m/s reaches 82.13323 kN after
  // 2.687653/2 ms and rebounds with -v. A wheelset of 1200 kg has two; contact of .46 m on .3 m.
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.start = 3.2;
  const auto drop = [&](double dt) {
    PackOptions o = options(dt);
    o.residual_flexibility = false;
    ModelRun run = wheelset_run(rigid_track(), w, o);
    run.state.v[run.model().wheelset[0].first + 2] = -.1;
    double peak = 0.;
    while (run.time() < 4e-3) {
      run.step();
      peak = std::max(peak, run.outputs.contact_force[1]);
    }
    CHECK(has(run.seen, Status::contact_lost));
    return std::pair{peak, run.state.v[run.model().wheelset[0].first + 2]};
  };
  // H4 demands 1 % at 50 us and 1e-3 at 10 us.
  const auto [coarse, rebound_coarse] = drop(5e-5);
  CHECK_THAT(coarse, WithinRel(82.13323e3, 1e-2));
  const auto [fine, rebound] = drop(1e-5);
  CHECK_THAT(fine, WithinRel(82.13323e3, 1e-3));
  CHECK_THAT(rebound, WithinRel(.1, 2e-3));
}

TEST_CASE("all methods of the guide hold, with the same motion", "[wheelset]") {
  const auto run_to = [](Guide guide) {
    Wheelset w = paper_wheelset(3.2);
    w.start = 2.;
    w.speed = 10.;
    w.guide = guide;
    w.alpha = w.beta = 200.;
    w.forces = {{0, {0., 5e3}}};
    ModelRun run = wheelset_run(paper_track(), w, options(1e-4));
    run.state.v[run.model().wheelset[0].first] = 10.;
    run.until(.2);
    CHECK(run.outputs.constraint_violation < 1e-9);
    CHECK_THAT(run.body()[0], WithinAbs(2., 1e-9));
    return std::array{run.body()[2], run.outputs.contact_force[0], guide_of(run.state, 0)[0],
                      run.outputs.constraint_violation};
  };
  const auto a = run_to(Guide::augmented_lagrangian), b = run_to(Guide::baumgarte),
             c = run_to(Guide::elimination);
  CHECK_THAT(a[0], WithinRel(b[0], 1e-6));
  CHECK_THAT(a[1], WithinRel(b[1], 1e-6));
  CHECK_THAT(c[0], WithinRel(a[0], 1e-10));
  CHECK_THAT(c[1], WithinRel(a[1], 1e-8));
  CHECK_THAT(c[2], WithinRel(a[2], 1e-3));  // the other's is the penalty times what it misses
  CHECK_THAT(c[2], WithinRel(5e3, 1e-2));   // what the wheels' slope on the rails adds is small
  CHECK(c[3] == 0.);
}

TEST_CASE("a status reports an impact that the step cannot follow", "[wheelset]") {
  // R1 of hard-cases.md: 600 kg per wheel at 0.1 m/s has contact for 2.69 ms, 26.9 steps of 0.1 ms.
  const auto met = [](double dt, double above) {
    Wheelset w = paper_wheelset(3.2);
    w.mass = 1200.;
    w.weight = 0.;
    w.inertia_roll = w.inertia_yaw = 1e9;
    w.radius = .46;
    ModelRun run = wheelset_run(rigid_track(), w, options(dt));
    run.state.u[run.model().wheelset[0].first + 2] = above;
    run.state.v[run.model().wheelset[0].first + 2] = -.1;
    run.until(5e-3);
    return has(run.seen, Status::contact_unresolved);
  };
  CHECK_FALSE(met(1e-4, 1e-5));
  CHECK_FALSE(met(2.5e-4, 1e-5));  // 10.8 steps
  CHECK(met(3e-4, 1e-5));          // 9 steps
  CHECK(met(1e-3, 1e-5));
}

TEST_CASE("a guide whose cap is too low sets a status", "[wheelset]") {
  Wheelset w = paper_wheelset(3.2);
  w.cap = 1;
  w.speed = 10.;
  w.start = 2.;
  ModelRun run = wheelset_run(paper_track(), w, options(1e-4));
  run.state.v[run.model().wheelset[0].first] = 0.;  // at rest: the guide must act
  run.step();
  CHECK(has(run.seen, Status::cap_reached));
  CHECK(std::isfinite(run.body()[0]));
}

TEST_CASE("a wheelset that runs off the rails falls, and a status reports it", "[wheelset]") {
  Wheelset w = paper_wheelset(3.2);
  w.start = 6.3;
  w.speed = 10.;
  ModelRun run = wheelset_run(paper_track(), w, options(1e-4));
  run.state.v[run.model().wheelset[0].first] = 10.;
  run.until(.05);
  CHECK(has(run.seen, Status::off_rail));
  CHECK(run.outputs.contact_force[0] == 0.);
  CHECK(run.body()[2] < -1e-3);
}
