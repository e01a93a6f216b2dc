// A vehicle in space, the Manchester passenger vehicle 1 with eight wheels, on uneven rails that
// are rigid, or a ring of 48 bays: time of a step, with the error of the wheelsets' lateral forces
// against small steps.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "measure.h"
#include "online/step/step.h"
#include "run/simulation.h"

namespace railstep {
namespace {

constexpr double kFrame = 1e-2, kDuration = 1.;  // s
constexpr double kExact = 6.25e-5;               // s

Scene scene_of(const char* name, double dt, const std::vector<std::string>& more) {
  std::vector<std::string> words{"step.dt_s=" + std::to_string(dt * 1e6) + "e-6",
                                 "step.frame_s=" + std::to_string(kFrame),
                                 "step.duration_s=" + std::to_string(kDuration),
                                 "irregularity={spectrum=\"german_low\",geometries=[\"vertical\","
                                 "\"alignment\",\"cross_level\"]}"};
  words.insert(words.end(), more.begin(), more.end());
  return read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/" + name + ".toml", words);
}

/// Lateral forces of all wheelsets on the track, frame by frame.
std::vector<double> sums(const Scene& scene) {
  Simulation run(scene);
  Outputs outputs{};
  std::vector<double> all;
  for (std::int64_t n = 0; n < run.model().steps / run.model().steps_per_frame; ++n) {
    static_cast<void>(advance_frame(run.model(), run.state, run.workspace, outputs));
    all.insert(all.end(), outputs.wheelset_sum_y,
               outputs.wheelset_sum_y + run.model().runner_wheelsets);
  }
  return all;
}

double largest(const std::vector<double>& values) {
  double most = 0.;
  for (const double x : values) most = std::max(most, std::fabs(x));
  return most;
}

void vehicle(benchmark::State& bench, const char* name, const std::vector<std::string>& more) {
  const double dt = 1e-6 * static_cast<double>(bench.range(0));
  const std::vector<double> exact = sums(scene_of(name, kExact, more));
  std::vector<double> error = sums(scene_of(name, dt, more));
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= exact[i];
  Simulation run(scene_of(name, dt, more));
  const Model& model = run.model();
  Outputs outputs{};
  std::int64_t frames = 0, iterations = 0;
  measure(bench, 10, model.steps_per_frame, [&] {
    if (run.state.steps >= model.steps) reset(model, run.state);
    benchmark::DoNotOptimize(advance_frame(model, run.state, run.workspace, outputs));
    iterations += outputs.iterations;  // the most of a step of the frame
    ++frames;
  });
  bench.counters["error"] = largest(error) / largest(exact);
  bench.counters["unknowns"] = model.unknowns;
  bench.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(frames);
}

void rigid(benchmark::State& bench) { vehicle(bench, "manchester_straight", {}); }
void rigid_held(benchmark::State& bench) {
  vehicle(bench, "manchester_straight", {"condense.kind=\"modal\""});
}
void ring(benchmark::State& bench) { vehicle(bench, "manchester_ring", {"track.bays=48"}); }

BENCHMARK(rigid)->ArgName("dt_us")->Arg(2000)->Arg(1000)->Arg(500)->Arg(250)->UseManualTime();
BENCHMARK(rigid_held)->ArgName("dt_us")->Arg(1000)->UseManualTime();
BENCHMARK(ring)->ArgName("dt_us")->Arg(1000)->Arg(500)->UseManualTime();

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
