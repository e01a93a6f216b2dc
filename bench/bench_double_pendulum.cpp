// The paper's double pendulum: time per step of 1 ms and error of C up to 1 s from one run, for
// each scheme, in space and in the plane. Also a single flexible pendulum of 4 to 64 elements.
#include <benchmark/benchmark.h>

#include "pendulum_run.h"

namespace railstep {
namespace {

/// Runs over the first second again and again.
void time_steps(benchmark::State& bench, Pendulum& run) {
  for (auto _ : bench) {
    if (run.state.steps == kPendulumSteps) run.start();
    run.step();
  }
}

void double_pendulum(benchmark::State& bench) {
  Pendulum run(pendulum_system({}, static_cast<int>(bench.range(2)), bench.range(0) != 0),
               pendulum_options(bench.range(1) != 0));
  const double error = error_of_c(run);
  bench.counters["iterations"] = run.iterations / kPendulumSteps;
  time_steps(bench, run);
  bench.counters["error_of_C_m"] = error;
  bench.counters["reference_error_m"] = kPendulumKnown;
}

/// The upper link alone; the cost per element shows whether it grows linearly.
void flexible_pendulum(benchmark::State& bench) {
  const int elements = static_cast<int>(bench.range(1));
  System system = pendulum_system({}, elements, bench.range(0) != 0);
  system.beams.pop_back();
  system.joints.clear();
  system.sensors.clear();
  Pendulum run(system, pendulum_options(false));
  time_steps(bench, run);
  bench.counters["per_element"] = benchmark::Counter(
      elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK(double_pendulum)
    ->ArgNames({"planar", "energy_momentum", "elements"})
    ->ArgsProduct({{0, 1}, {0, 1}, {4, 8}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(flexible_pendulum)
    ->ArgNames({"planar", "elements"})
    ->ArgsProduct({{0, 1}, {4, 16, 64}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
