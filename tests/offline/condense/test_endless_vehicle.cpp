// Vehicles on a track without end: rings and windows.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/endless_run.h"
#include "support/vehicles.h"

using namespace railstep;

namespace {

Traffic bogie_traffic(double start, int rail = 0) {
  RunningVehicle v;
  v.rail = rail;
  v.vehicle = bogie(kBogie).vehicle;
  v.start = start;
  v.speed = kSpeed;
  return {.vehicles = {v}, .head = {.1, .3, .035}};
}

}  // namespace

TEST_CASE("a bogie on a ring or a window has the forces of a long track with a fine mesh") {
  // The bound of docs/endless.md is 1e-3 of the peak for means over 1 ms, which show the force
  // below 440 Hz (-3 dB). Means of the full order are those at its steps' ends, half a step late.
  // The force swings by 4 % at 50 Hz over the sleepers, and 50 us are 3e-4 of that.
  constexpr double dt = 5e-5;
  const auto fine = [](PackOptions options) {
    options.steps_per_frame = 20;
    return options;
  };
  const Track track = endless_track(60, 6);
  ModelRun reference(track, bogie_traffic(12.), fine({.scheme = generalised_alpha(dt, .6)}));
  reference.packed->set_start(start_in_equilibrium(track, *reference.packed, 0.));
  reset(reference.model(), reference.state);
  const Heard want = listen(reference, 280, 40);
  const auto check = [&](const char* what, const Track& own, const PackOptions& options) {
    ModelRun run(own, bogie_traffic(0.), fine(options));
    run.packed->set_start(start_in_equilibrium(own, *run.packed, 0.));
    reset(run.model(), run.state);
    const Heard got = listen(run, 280, 40);
    const double force = largest(got.force, want.force), rail = largest(got.rail, want.rail);
    CAPTURE(what, force, rail);
    CHECK(force < 1e-3);
    CHECK(rail < 1e-3);
  };
  const Track ring = ring_of(endless_track(32, 4)), window = window_of(endless_track(32, 6));
  check("ring", ring, ring_options(ring, 3, dt));
  check("window", window, window_options(window, dt));
}

TEST_CASE("a bogie starts in motion and is at the same place of its bay 10 000 bays later",
          "[H29]") {
  // It settles to 1e-9 of the largest coordinate from bay to bay, a wave of .02 sqrt(kg) m. The
  // frame's swing decays as e^(-3/s t), so 1/(1 - e^(-.06)) = 17 times that is to come: 3e-10 m. An
  // axle's 1.2e6 N/m make 4e-4 N of it, 1e-8 of the wheel's force; pitch ten times as much.
  constexpr double dt = 5e-4;
  const Track ring = ring_of(endless_track(24, 2));
  const Traffic traffic = bogie_traffic(0.);
  PackOptions options = ring_options(ring, 2, dt);
  options.steps_per_frame = 2;
  ModelRun run(ring, traffic, options);
  run.packed->set_start(start_moving(ring, *run.packed, 0.));
  reset(run.model(), run.state);
  const Heard first = listen(run, 0, 20);
  while (run.state.steps < 400'000) run.step();
  const Heard late = listen(run, 0, 20);
  const double force = largest(late.force, first.force), rail = largest(late.rail, first.rail);
  CAPTURE(force, rail);
  CHECK(force < 1e-7);
  CHECK(rail < 1e-7);
  // 200 020 ms and half a bogie, less half a step: the step locates contacts there.
  CHECK_THAT(run.outputs.contact_x[0],
             Catch::Matchers::WithinRel(kSpeed * (200.02 - .5 * dt) + 1.28, 1e-12));
}

TEST_CASE("a vehicle on a track without end continues from its block and from a saved state") {
  const Track ring = ring_of(endless_track(24, 2)), window = window_of(endless_track(40, 2));
  for (const bool modal : {true, false}) {
    const Track& track = modal ? ring : window;
    ModelRun run = moving_run(track, bogie_traffic(0.),
                              modal ? ring_options(ring, 2, kDt) : window_options(window, kDt));
    check_goes_on(run);
  }
}

TEST_CASE("bogie, wheelset and load run on one ring, each from its own start") {
  const Track ring = ring_of(endless_track(40, 2, 2));
  Traffic traffic = bogie_traffic(0.);
  traffic.vehicles.push_back(bogie_traffic(0., 1).vehicles[0]);
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 98.1e3;
  w.start = 5.;
  w.speed = kSpeed;
  traffic.wheelsets.push_back(w);
  for (const int rail : {0, 1}) traffic.loads.push_back(moving_load(3., rail));
  ModelRun run = moving_run(ring, traffic, ring_options(ring, 2, kDt));
  for (int frame = 0; frame < 100; ++frame) run.step();  // 3 m
  CHECK(run.seen == Status::ok);
  const double x[] = {5., 5., 1.28, -1.28, 1.28, -1.28};
  for (int i = 0; i < 6; ++i)  // half a step before the end; the guide's tolerance is 1e-10 m
    CHECK_THAT(run.outputs.contact_x[i], Catch::Matchers::WithinAbs(x[i] + 3. - 1.5e-3, 1e-4));
  CHECK_THAT(run.outputs.load_x[0], Catch::Matchers::WithinAbs(6., 1e-12));
  // Each carries its own weight: over sleepers a wheel's force swings by some percent.
  CHECK_THAT(run.outputs.contact_force_mean[0], Catch::Matchers::WithinRel(49.05e3, .05));
  CHECK_THAT(run.outputs.contact_force_mean[2], Catch::Matchers::WithinRel(54.54e3, .05));
}
