// The paper's double pendulum: time per step of 1 ms and error of C up to 1 s from one run, over
// the schemes, in space and in its plane; and a single flexible pendulum from 4 to 64 elements.
#include <benchmark/benchmark.h>

#include "../tests/pendulum_core.h"
#include "online/step/step.h"
#include "online/system/sense.h"

namespace railstep {
namespace {

struct Pendulum {
  PackedSystem packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};
  double iterations = 0.;

  Pendulum(const System& system, const SystemOptions& options)
      : packed(system, options),
        memory(static_cast<std::size_t>(state_doubles(packed.model()))),
        scratch(static_cast<std::size_t>(workspace_doubles(packed.model()))),
        state(state_on(packed.model(), memory.data())),
        workspace(workspace_on(packed.model(), scratch.data())) {
    start();
  }
  void start() {
    reset(packed.model(), state);
    iterations = 0.;
  }
  void step() {
    benchmark::DoNotOptimize(advance_frame(packed.model(), state, workspace, outputs));
    iterations += outputs.iterations;
  }
};

constexpr double kStep = 1e-3;  // s
constexpr int kSteps = 1000;

SystemOptions options(bool energy_momentum_scheme) {
  SystemOptions o;
  o.scheme = energy_momentum_scheme ? energy_momentum(kStep) : generalised_alpha(kStep, .9);
  o.energy_momentum = energy_momentum_scheme;
  return o;
}

/// Largest distance of C from the refined path at its times up to 1 s, m.
double error_of_c(Pendulum& run) {
  static const PendulumPath known =
      read_pendulum_path(RAILSTEP_SOURCE "/tests/data/double_pendulum.csv");
  double worst = 0.;
  run.start();
  for (int n = 1; n <= kSteps; ++n) {
    run.step();
    const double time = n * kStep;
    const double at = std::round(time / known.step);
    if (std::abs(at * known.step - time) > 1e-9) continue;
    const PointMotion c = sense(run.packed.model(), run.state, 2);
    const HingeAndEnd want = known.at.at(static_cast<std::size_t>(at));
    worst = std::max(worst, std::hypot(c.position[0] - want[2], c.position[2] - want[3]));
  }
  return worst;
}

/// Runs over the first second again and again.
void time_steps(benchmark::State& bench, Pendulum& run) {
  for (auto _ : bench) {
    if (run.state.steps == kSteps) run.start();
    run.step();
  }
}

void double_pendulum(benchmark::State& bench) {
  Pendulum run(pendulum_system({}, static_cast<int>(bench.range(2)), bench.range(0) != 0),
               options(bench.range(1) != 0));
  const double error = error_of_c(run);
  bench.counters["iterations"] = run.iterations / kSteps;
  time_steps(bench, run);
  bench.counters["error_of_C_m"] = error;
  bench.counters["reference_error_m"] = kPendulumKnown;
}

/// The upper link alone; the cost of an element says whether it grows linearly.
void flexible_pendulum(benchmark::State& bench) {
  const int elements = static_cast<int>(bench.range(1));
  System system = pendulum_system({}, elements, bench.range(0) != 0);
  system.beams.pop_back();
  system.joints.clear();
  system.sensors.clear();
  Pendulum run(system, options(false));
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
