// One frame of the ballasted track, with its error against the same track refined in mesh and step.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "answer/condense_error.h"
#include "online/step/step.h"
#include "run/simulation.h"

namespace railstep {
namespace {

/// Runs over the track again and again, each time from rest under the wheelset.
void frame(benchmark::State& run, const std::vector<std::string>& overrides) {
  const Scene scene =
      read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/ballasted_track.toml", overrides);
  Simulation simulation(scene);
  const Model& model = simulation.model();
  Outputs outputs{};
  for (auto _ : run) {
    if (simulation.state.steps >= model.steps) reset(model, simulation.state);
    benchmark::DoNotOptimize(advance_frame(model, simulation.state, simulation.workspace, outputs));
  }
  const TransientError error = transient_error(scene, overrides);
  run.counters["error"] = error.largest;  // rails under the wheels, over their peak
  run.counters["window_s"] = error.window_s;
  run.counters["unknowns"] = model.unknowns;
  run.counters["steps"] = model.steps_per_frame;
}

void full(benchmark::State& run) { frame(run, {"condense.kind=\"full\""}); }

void condensed(benchmark::State& run) {
  frame(run, {"condense.modes_per_bay=" + std::to_string(run.range(0))});
}

BENCHMARK(full)->Unit(benchmark::kMicrosecond);
BENCHMARK(condensed)
    ->ArgName("modes_per_bay")
    ->Arg(0)
    ->Arg(1)
    ->Arg(3)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
