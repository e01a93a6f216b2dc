// One step of the peers' moving-load scene (lines_to_beat.csv), with its error from the same run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "offline/pack/pack.h"
#include "offline/pack/scheme.h"
#include "offline/pack/start.h"
#include "offline/vehicle/kinds.h"
#include "online/step/step.h"

namespace railstep {
namespace {

constexpr double kStep = 1e-3, kSpeed = 30., kBay = .6;  // s, m/s, m
constexpr int kCompared = 300;  // steps compared with the reference at most: 0.3 s, 15 bays
constexpr int kStartUp = 50;    // steps; what a suddenly appearing load rings, design.md section 8

/// 0.2319 m by 0.0375 m rectangle on springs at every bay border, k = 0.8497 (reference.md).
Track peers_track(int bays, int elements_per_bay, int rails, Unknowns unknowns) {
  const double h = .2319, b = .0375;
  Track t;
  t.section = {.area = h * b,
               .inertia_y = b * h * h * h / 12.,
               .inertia_z = h * b * b * b / 12.,
               .torsion = h * b * b * b / 3. * (1. - .63 * b / h),
               .shear_factor_y = .8497,
               .shear_factor_z = .8497};
  t.unknowns = unknowns;
  t.rails = rails;
  t.bays = bays;
  t.bay_length = kBay;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {3e6, 3e7, 3e7};
  t.support.damping = {3e4, 3e4, 3e4};
  return t;
}

/// 50 kN on every rail from the first mid-bay to the last, then again from rest.
class MovingLoadRun {
 public:
  MovingLoadRun(const Track& track, double dt, int steps_per_frame,
                const std::optional<Reduction>& modal = {})
      : frames_(static_cast<int>(std::lround((track.length() - kBay) / (kSpeed * kStep)))) {
    Traffic traffic;
    for (int rail = 0; rail < track.rails; ++rail)
      traffic.loads.push_back({.rail = rail,
                               .start = .5 * kBay,
                               .speed = kSpeed,
                               .stop = track.length(),
                               .force = -50e3});
    packed_ = std::make_unique<PackedModel>(
        track, traffic,
        PackOptions{.scheme = modal ? held_force(dt, .6) : generalised_alpha(dt, .6),
                    .steps_per_frame = steps_per_frame,
                    .reduction = modal});
    memory_.resize(static_cast<std::size_t>(state_doubles(packed_->model())));
    scratch_.resize(static_cast<std::size_t>(workspace_doubles(packed_->model())));
    state_ = state_on(packed_->model(), memory_.data());
    workspace_ = workspace_on(packed_->model(), scratch_.data());
  }

  /// One frame; the reset at the track's end is part of the time, once in a whole passage.
  double frame() {
    if (done_ == frames_) restart();
    ++done_;
    benchmark::DoNotOptimize(advance_frame(packed_->model(), state_, workspace_, outputs_));
    return outputs_.load_deflection[0];
  }

  /// Deflections under the first load from rest, one a frame.
  std::vector<double> deflections() {
    restart();
    std::vector<double> z;
    z.reserve(static_cast<std::size_t>(kCompared));
    for (int i = 0; i < std::min(frames_, kCompared); ++i) z.push_back(frame());
    restart();
    return z;
  }

  int unknowns() const { return packed_->model().unknowns; }

 private:
  void restart() {
    reset(packed_->model(), state_);
    done_ = 0;
  }

  int frames_, done_ = 0;
  std::unique_ptr<PackedModel> packed_;
  std::vector<double> memory_, scratch_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
};

/// Largest difference from step `first` on, over the peak of `reference` there.
double largest_error(const std::vector<double>& z, const std::vector<double>& reference,
                     std::size_t first) {
  double largest = 0., peak = 0.;
  for (std::size_t i = first; i < reference.size(); ++i) {
    largest = std::max(largest, std::abs(z[i] - reference[i]));
    peak = std::max(peak, std::abs(reference[i]));
  }
  return largest / peak;
}

struct Reference {
  std::vector<double> z;  // m, every 1 ms
  double own_error;       // after start-up, from halving mesh and step once more
};

/// Eight elements per bay and 0.1 ms, and residual flexibility: without it the kink under a load
/// inside an element is missed in proportion to the element's length, 4e-4 of the peak with eight
/// per bay. The rails share nothing: one of them is enough.
const Reference& reference_for(int bays, Unknowns unknowns) {
  static std::map<std::pair<int, Unknowns>, Reference> made;
  auto [at, fresh] = made.try_emplace({bays, unknowns});
  if (fresh) {
    const auto refined = [&](int per_bay, int steps) {
      const Track track = peers_track(bays, per_bay, 1, unknowns);
      return MovingLoadRun(track, kStep / steps, steps).deflections();
    };
    at->second.z = refined(8, 10);
    at->second.own_error = largest_error(at->second.z, refined(16, 20), kStartUp);
  }
  return at->second;
}

void compare(benchmark::State& run, MovingLoadRun& scene, MovingLoadRun& fine_step,
             Unknowns unknowns) {
  const Reference& reference = reference_for(static_cast<int>(run.range(0)), unknowns);
  const std::vector<double> z = scene.deflections(), fine = fine_step.deflections();
  for (auto _ : run) scene.frame();
  run.counters["error"] = largest_error(z, reference.z, kStartUp);
  run.counters["error_of_mesh"] = largest_error(fine, reference.z, kStartUp);
  run.counters["error_of_step"] = largest_error(z, fine, kStartUp);
  run.counters["error_from_start"] = largest_error(z, reference.z, 0);
  run.counters["reference_error"] = reference.own_error;
  run.counters["unknowns"] = scene.unknowns();
}

void step(benchmark::State& run, Unknowns unknowns) {
  const int bays = static_cast<int>(run.range(0));
  MovingLoadRun scene(peers_track(bays, 1, 2, unknowns), kStep, 1);
  MovingLoadRun fine_step(peers_track(bays, 1, 1, unknowns), kStep / 10, 10);
  compare(run, scene, fine_step, unknowns);
}

void step_vertical(benchmark::State& run) { step(run, Unknowns::vertical); }
void step_rigid_section(benchmark::State& run) { step(run, Unknowns::rigid_section); }
void step_full(benchmark::State& run) { step(run, Unknowns::full); }

/// Condensed from two elements per bay; args are bays and modes per hundred bays. Lines that the
/// loads do not move are left out, so that the 9-unknown track gives the same model.
void step_condensed(benchmark::State& run) {
  const int bays = static_cast<int>(run.range(0));
  const Reduction limit{.limit = {static_cast<int>(bays * run.range(1) / 100), 1e9}};
  MovingLoadRun scene(peers_track(bays, 2, 2, Unknowns::vertical), kStep, 1, limit);
  MovingLoadRun fine_step(peers_track(bays, 2, 1, Unknowns::vertical), kStep / 10, 10, limit);
  compare(run, scene, fine_step, Unknowns::vertical);
}

/// Seats that do not pull, from a quarter of the track on; args are bays, seats and whether
/// condensed. The rail has no weight here, so they lift before and behind the load: the difference
/// from springs says how much, it is no error.
void step_fixed_ports(benchmark::State& run) {
  const int bays = static_cast<int>(run.range(0)), seats = static_cast<int>(run.range(1));
  Track track = peers_track(bays, 2, 1, Unknowns::vertical);
  std::optional<Reduction> modal;
  if (run.range(2) != 0) modal = Reduction{.limit = {bays, 1e9}};
  MovingLoadRun springs(track, kStep, 1, modal);
  for (int i = 0; i < seats; ++i) {
    Seat seat = track.seat(bays / 4 + i);
    seat.pad[0].unilateral = true;
    track.changed_seats[bays / 4 + i] = seat;
  }
  MovingLoadRun scene(track, kStep, 1, modal);
  const std::vector<double> z = scene.deflections(), want = springs.deflections();
  for (auto _ : run) scene.frame();
  run.counters["difference_from_springs"] = largest_error(z, want, kStartUp);
  run.counters["unknowns"] = scene.unknowns();
}

/// One step of 1 to 16 wheels, each a mass on a spring under its own, over 64 bays: what each adds
/// is the slope over the wheels. No error of its own: test_moving_mass.cpp has it.
void step_wheels(benchmark::State& run, const std::optional<Reduction>& modal) {
  constexpr double dt = 50e-6;
  Track track = peers_track(64, 2, 1, Unknowns::vertical);
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
  run.counters["force"] = outputs.wheel_force[0];
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
