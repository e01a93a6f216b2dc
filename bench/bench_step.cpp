// One step of the peers' moving-load scene (docs/peers.md), with its error from the same run.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "offline/start/start.h"
#include "offline/vehicle/kinds.h"
#include "peers/peer_moving_load.h"

namespace railstep {
namespace {

void compare(benchmark::State& run, MovingLoadRun& scene, MovingLoadRun& fine_step,
             Unknowns unknowns) {
  const PassageReference& reference = reference_for(static_cast<int>(run.range(0)), unknowns);
  const std::vector<double> z = deflections(scene), fine = deflections(fine_step);
  for (auto _ : run) benchmark::DoNotOptimize(scene.frame());
  run.counters["error"] = largest_error(z, reference.z, kStartUp);
  run.counters["error_of_mesh"] = largest_error(fine, reference.z, kStartUp);
  run.counters["error_of_step"] = largest_error(z, fine, kStartUp);
  run.counters["error_from_start"] = largest_error(z, reference.z, 0);
  run.counters["reference_error"] = reference.own_error;
  run.counters["unknowns"] = scene.unknowns();
}

void step(benchmark::State& run, Unknowns unknowns) {
  const int bays = static_cast<int>(run.range(0));
  MovingLoadRun scene(moving_load_track(bays, 1, 2, unknowns), {});
  MovingLoadRun fine_step(moving_load_track(bays, 1, 1, unknowns),
                          {.dt = kStep / 10, .steps_per_frame = 10});
  compare(run, scene, fine_step, unknowns);
}

void step_vertical(benchmark::State& run) { step(run, Unknowns::vertical); }
void step_rigid_section(benchmark::State& run) { step(run, Unknowns::rigid_section); }
void step_full(benchmark::State& run) { step(run, Unknowns::full); }

/// A model condensed from two elements per bay; args are bays and modes per hundred bays. Lines
/// that the loads do not move are left out, so the 9-unknown track gives the same model.
void step_condensed(benchmark::State& run) {
  const int bays = static_cast<int>(run.range(0));
  const Reduction limit{.limit = {static_cast<int>(bays * run.range(1) / 100), 1e9}};
  MovingLoadRun scene(moving_load_track(bays, 2, 2, Unknowns::vertical), {.reduction = limit});
  MovingLoadRun fine_step(moving_load_track(bays, 2, 1, Unknowns::vertical),
                          {.dt = kStep / 10, .steps_per_frame = 10, .reduction = limit});
  compare(run, scene, fine_step, Unknowns::vertical);
}

/// Some seats from a quarter of the track on do not pull; args are bays, seats and whether
/// condensed. The rail has no weight here, so it lifts before and behind the load: the difference
/// from springs shows how much; it is not an error.
void step_fixed_ports(benchmark::State& run) {
  const int bays = static_cast<int>(run.range(0)), seats = static_cast<int>(run.range(1));
  Track track = moving_load_track(bays, 2, 1, Unknowns::vertical);
  std::optional<Reduction> modal;
  if (run.range(2) != 0) modal = Reduction{.limit = {bays, 1e9}};
  MovingLoadRun springs(track, {.reduction = modal});
  for (int i = 0; i < seats; ++i) {
    Seat seat = track.seat(bays / 4 + i);
    seat.pad[0].unilateral = true;
    track.changed_seats[bays / 4 + i] = seat;
  }
  MovingLoadRun scene(track, {.reduction = modal});
  const std::vector<double> z = deflections(scene), want = deflections(springs);
  for (auto _ : run) benchmark::DoNotOptimize(scene.frame());
  run.counters["difference_from_springs"] = largest_error(z, want, kStartUp);
  run.counters["unknowns"] = scene.unknowns();
}

/// One step of 1 to 16 wheels, each with its own sprung mass, over 64 bays: the cost of a wheel is
/// the slope over the wheels. The error is in test_moving_mass.cpp.
void step_wheels(benchmark::State& run, const std::optional<Reduction>& modal) {
  constexpr double dt = 50e-6;
  Track track = moving_load_track(64, 2, 1, Unknowns::vertical);
  Traffic traffic;
  for (int i = 0; i < run.range(0); ++i) {
    RunningVehicle v;
    v.vehicle = sprung_mass(4000., 900., 1.2e6, 4e3).vehicle;
    v.start = 2.5 + 2. * i;
    traffic.vehicles.push_back(v);
  }
  PackedModel packed(track, traffic,
                     PackOptions{.scheme = modal ? held_force(dt, .6) : generalised_alpha(dt, .6),
                                 .reduction = modal});
  packed.set_start(start_in_equilibrium(track, packed, 0.));
  const Model& model = packed.model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)));
  std::vector<double> scratch(static_cast<std::size_t>(workspace_doubles(model)));
  State state = state_on(model, memory.data());
  Workspace workspace = workspace_on(model, scratch.data());
  Outputs outputs{};
  reset(model, state);
  for (auto _ : run) benchmark::DoNotOptimize(advance_frame(model, state, workspace, outputs));
  run.counters["force"] = outputs.contact_force[0];
  run.counters["iterations"] = outputs.iterations;
}

void step_wheels_banded(benchmark::State& run) { step_wheels(run, std::nullopt); }
void step_wheels_condensed(benchmark::State& run) {
  step_wheels(run, Reduction{.limit = {64, 1e9}});
}

constexpr int kTimed = 100'000;  // steps

BENCHMARK(step_vertical)
    ->ArgName("elements")
    ->RangeMultiplier(4)
    ->Range(4, 256)
    ->Iterations(kTimed);
BENCHMARK(step_rigid_section)
    ->ArgName("elements")
    ->RangeMultiplier(4)
    ->Range(4, 256)
    ->Iterations(kTimed);
BENCHMARK(step_full)->ArgName("elements")->RangeMultiplier(4)->Range(4, 256)->Iterations(kTimed);
BENCHMARK(step_condensed)
    ->ArgNames({"bays", "modes_per_100_bays"})
    ->ArgsProduct({{4, 16, 64, 256}, {25, 50, 100}})
    ->Iterations(kTimed);
BENCHMARK(step_fixed_ports)
    ->ArgNames({"bays", "seats", "condensed"})
    ->ArgsProduct({{40}, {0, 1, 4, 16}, {0, 1}})
    ->Iterations(kTimed);

BENCHMARK(step_wheels_banded)
    ->ArgName("wheels")
    ->RangeMultiplier(2)
    ->Range(1, 16)
    ->Iterations(kTimed);
BENCHMARK(step_wheels_condensed)
    ->ArgName("wheels")
    ->RangeMultiplier(2)
    ->Range(1, 16)
    ->Iterations(kTimed);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
