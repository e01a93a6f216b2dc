#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/statics.h"
#include "online/track/track_sensor.h"
#include "support/condensed_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

TEST_CASE("a condensed track in static equilibrium does not move", "[condensed]") {
  // Each rail carries three loads, two of them in one element, and both carry two wheelsets and
  // their weight. Both rails have the same loads: a wheelset that rolls would slide down its slope.
  const Track track = paper_track();
  Traffic traffic{.wheelsets = {paper_wheelset(2.9), paper_wheelset(3.6)}, .head = kHead};
  for (const int rail : {0, 1})
    for (const double x : {2., 3.1, 3.4})
      traffic.loads.push_back(
          {.rail = rail, .start = x, .stop = 7., .force = -1e3, .z = kHead.top_z});
  PackOptions options = condensed(track, 2., 1e-4);
  options.gravity = 9.81;
  ModelRun run = in_equilibrium(track, traffic, options);
  publish_start(run.model(), run.state, run.outputs);
  const Outputs start = run.outputs;
  CHECK(start.load_deflection[1] < -1e-4);
  const double z = run.body()[2], roll = run.body()[3];
  double most = 0.;
  for (int i = 0; i < 1000; ++i) {
    run.step();
    for (int l = 0; l < 6; ++l)
      most = std::max(most, std::abs(run.outputs.load_deflection[l] - start.load_deflection[l]));
    for (int w = 0; w < 4; ++w)
      most = std::max(most, std::abs(run.outputs.contact_rail_z[w] - start.contact_rail_z[w]));
    most = std::max({most, std::abs(run.body()[2] - z), .5 * std::abs(run.body()[3] - roll)});
  }
  CHECK(run.seen == Status::ok);
  CAPTURE(most);
  CHECK(most < 1e-13);  // m; rounding of some mm
  for (int w = 0; w < 4; ++w)
    CHECK_THAT(run.outputs.contact_force[w], WithinRel(start.contact_force[w], 1e-9));
}

TEST_CASE("a wheelset on unequal rails starts with its own weight on both wheels", "[start]") {
  // 20 kN beside the left wheel roll the wheelset by 2.8e-3 rad on either kind of track.
  Traffic traffic{.wheelsets = {paper_wheelset(2.9)}, .head = kHead};
  traffic.loads = {{.start = 3.1, .stop = 7., .force = -20e3}};
  for (const PackOptions& options : {condensed(paper_track(), 2., 1e-4), full_order(1e-4)}) {
    ModelRun run = in_equilibrium(paper_track(), traffic, options);
    CHECK(run.body()[3] < -2e-3);
    // Both contacts shift along the axle by 2.8e-3 of .448 m; the arms are .5 m.
    const double start[2] = {run.state.contact_force[0], run.state.contact_force[1]};
    for (const double force : start) CHECK_THAT(force, WithinRel(490.5, 2.6e-3));
    for (int i = 0; i < 20; ++i) {
      run.step();
      // It slides down its slope by 5e-8 m, which costs the contacts 2e-10 m of 4e-6 m.
      for (int wheel = 0; wheel < 2; ++wheel)
        CHECK_THAT(run.outputs.contact_force[wheel], WithinRel(start[wheel], 1e-4));
    }
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("forces on one condensed rail affect each other as on the fine track", "[condensed]") {
  Track coarse = s1_track(8, 2), fine = s1_track(8, 16);
  const double top = .091, places[2] = {2.25, 2.4}, sets[2] = {2.85, 3.2};
  const auto deflections = [&](bool swapped) {
    Traffic traffic{.wheelsets = {paper_wheelset(sets[0]), paper_wheelset(sets[1])},
                    .head = {top, .3, .036}};
    for (Wheelset& w : traffic.wheelsets) w.weight = 50e3;
    for (const int i : {swapped ? 1 : 0, swapped ? 0 : 1})
      traffic.loads.push_back({.start = places[i], .stop = 9., .force = -50e3, .z = top});
    ModelRun run = in_equilibrium(coarse, traffic, condensed(coarse, 1., 1e-4));
    publish_start(run.model(), run.state, run.outputs);
    return std::vector<double>{run.outputs.load_deflection[swapped ? 1 : 0],
                               run.outputs.load_deflection[swapped ? 0 : 1],
                               run.outputs.contact_rail_z[0],
                               run.outputs.contact_rail_z[1],
                               run.outputs.contact_rail_z[2],
                               run.outputs.contact_rail_z[3]};
  };
  const Statics statics(fine);
  std::vector<PointForce> forces;
  for (const double x : places) forces.push_back({{0, x, 0., top, 2}, -50e3});
  for (const double x : sets)
    for (const int rail : {0, 1}) forces.push_back({{rail, x, 0., top, 2}, -25e3});
  const auto u = statics.solve(forces);
  std::vector<double> want;
  for (const double x : places) want.push_back(statics.at(u, {0, x, 0., top, 2}));
  for (const double x : sets)
    for (const int rail : {0, 1}) want.push_back(statics.at(u, {rail, x, 0., 0., 2}));
  const auto got = deflections(false), other = deflections(true);
  for (std::size_t i = 0; i < want.size(); ++i) {
    CAPTURE(i, got[i] / want[i] - 1.);
    // The tables between ports have 4 intervals per element. Under a force their cubics miss the
    // kink by some 0.1 of an interval times the jump of slope 1/(k G A): 3e-11 of 2e-8 m/N.
    CHECK_THAT(got[i], WithinRel(want[i], 2e-3));
    CHECK_THAT(other[i], WithinRel(got[i], 1e-9));  // only the order of the sums differs
  }
}

TEST_CASE("a load that starts in motion on condensed track has no transient", "[condensed]") {
  const Track track = peers_pair(1);
  const MovingLoad load{.start = 4., .speed = 10., .stop = 9.3, .force = -50e3};
  ModelRun moving = in_equilibrium(track, {.loads = {load}}, condensed(track, 1., 1e-4)),
           still(track, {.loads = {load}}, condensed(track, 1., 1e-4));
  const Statics statics(peers_pair(8));
  double error = 0., released = 0.;
  for (int i = 1; i <= 200; ++i) {
    moving.step();
    still.step();
    const RailPoint at{0, moving.outputs.load_x[0], 0., 0., 2};
    const double want = -50e3 * statics.flexibility(at, at);
    error = std::max(error, std::abs(moving.outputs.load_deflection[0] / want - 1.));
    released = std::max(released, std::abs(still.outputs.load_deflection[0] / want - 1.));
  }
  CAPTURE(error);
  // Effects of speed are (v / critical)^2, with 10 m/s against some 500 m/s, and the dampers' lag c
  // v k' / k: 3e4 10 / 3e7 of the static shape's slope, 1 per m. Both are below 1e-2.
  CHECK(error < 1e-2);
  CHECK(released > .5);
}

TEST_CASE("a condensed start in motion has the velocity of the static shape that moves along",
          "[condensed]") {
  const Track track = peers_pair(1);
  const double x = 4.65, speed = 30., dx = 1e-4;
  Traffic traffic{.loads = {{.start = x, .speed = speed, .stop = 9.3, .force = -50e3}}};
  const RailPoint seen[2] = {{0, 4.2, 0., 0., 2}, {0, 5.4, 0., 0., 2}};
  for (const RailPoint& at : seen)
    traffic.track_sensors.push_back({.velocity = 1., .track = {.rail = {{at, 1.}}}});
  ModelRun run = in_equilibrium(track, traffic, condensed(track, 1000., 1e-3));  // all modes
  publish_start(run.model(), run.state, run.outputs);
  double velocity[2];
  read_track_sensors(run.model(), run.state, run.outputs, velocity);
  const Statics statics(track);
  for (int i = 0; i < 2; ++i) {
    const double ahead = statics.flexibility(seen[i], {0, x + dx, 0., 0., 2}),
                 behind = statics.flexibility(seen[i], {0, x - dx, 0., 0., 2});
    // Within an element the shape is a parabola in the force's position, so its difference quotient
    // is exact. K's rounding is left, 1e-9 here, over the part 1e-4 of K that differs.
    CHECK_THAT(velocity[i], WithinRel(-50e3 * speed * (ahead - behind) / (2. * dx), 1e-5));
  }
  CHECK(velocity[0] * velocity[1] < 0.);  // up behind the load, down ahead of it
}

TEST_CASE("a start in motion at the rail's end agrees with one just behind it", "[start]") {
  const Track track = peers_pair(1);
  const RailPoint at{0, .6, 0., 0., 2};
  const auto velocity_at = [&](double x, double speed, const PackOptions& options) {
    const Traffic traffic{
        .loads = {{.start = x, .speed = speed, .stop = speed > 0. ? 9.3 : .3, .force = -50e3}},
        .track_sensors = {{.velocity = 1., .track = {.rail = {{at, 1.}}}}}};
    ModelRun run = in_equilibrium(track, traffic, options);
    double velocity;
    read_track_sensors(run.model(), run.state, run.outputs, &velocity);
    return velocity;
  };
  // Within the end's element the shape is a parabola in the force's position. Over 1e-4 m of 0.6 m
  // its slope changes by 1e-3 at most, as neither slope passes 0 there.
  for (const PackOptions& options : {full_order(1e-3), condensed(track, 1000., 1e-3)}) {
    const double inside = velocity_at(1e-4, 30., options);
    CHECK(std::abs(inside) > 1e-3);
    CHECK_THAT(velocity_at(0., 30., options), WithinRel(inside, 1e-3));
  }
  const double end = 16 * .6, inside = velocity_at(end - 1e-4, -30., full_order(1e-3));
  CHECK_THAT(velocity_at(end, -30., full_order(1e-3)), Catch::WithinAbs(inside, 1e-6));
}
