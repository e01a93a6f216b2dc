// One beam spun up by its hub in five formulations: time per step and error from the same run, by
// speed of the hub, mesh or modes, and step. tests/support/spin_up.h has the scene.
#include <benchmark/benchmark.h>

#include <map>

#include "support/spin_up.h"

namespace railstep {
namespace {

/// Speeds are in units of .1 rad/s and steps in ms: arguments are whole numbers.
SpinUp hub(const benchmark::State& run) { return {static_cast<double>(run.range(0)) / 10.}; }
double step(const benchmark::State& run) { return static_cast<double>(run.range(1)) / 1000.; }

const SpinUpReference& reference(const SpinUp& hub) {
  static std::map<double, SpinUpReference> known;
  const auto found = known.find(hub.speed);
  if (found != known.end()) return found->second;
  return known.emplace(hub.speed, spin_up_reference(hub, 16, .005)).first->second;
}

void report(benchmark::State& run, const SpinUpRun& last) {
  const SpinUpReference& r = reference(hub(run));
  run.counters["us_per_step"] = last.microseconds_per_step();
  run.counters["solves_per_step"] = static_cast<double>(last.solves) / last.steps;
  run.counters["error"] = r.error(last);
  run.counters["reference_error"] = r.own_error / r.largest_lag;
}

void ancf(benchmark::State& run) {
  SpinUpRun last;
  for (auto _ : run) last = spin_up_ancf(hub(run), static_cast<int>(run.range(2)), step(run));
  report(run, last);
}

void linearised(benchmark::State& run) {
  SpinUpRun last;
  for (auto _ : run) last = spin_up_linear(hub(run), static_cast<int>(run.range(2)), step(run));
  report(run, last);
}

void frame_unstiffened(benchmark::State& run) {
  SpinUpRun last;
  const int modes = static_cast<int>(run.range(2));
  for (auto _ : run) last = spin_up_frame(hub(run), modes, 1, false, step(run));
  report(run, last);
}

void frame(benchmark::State& run) {
  SpinUpRun last;
  const int modes = static_cast<int>(run.range(2));
  for (auto _ : run) last = spin_up_frame(hub(run), modes, 1, true, step(run));
  report(run, last);
}

void geometrically_exact(benchmark::State& run) {
  SpinUpRun last;
  for (auto _ : run) last = spin_up_reissner(hub(run), static_cast<int>(run.range(2)), step(run));
  report(run, last);
}

// Each runs one whole manoeuvre: its thousands of steps are enough for an average.
void arguments(benchmark::internal::Benchmark* b, int parts) {
  b->ArgNames({"speed_tenths", "step_ms", "parts"})->Iterations(1)->Unit(benchmark::kMillisecond);
  for (const int speed : {5, 10, 15, 20, 25, 28, 30, 40, 60}) b->Args({speed, 10, parts});
}

BENCHMARK(ancf)->Apply([](auto* b) { arguments(b, 8); }) -> ArgsProduct({{40}, {40}, {2, 4, 8}})
    -> ArgsProduct({{40}, {5}, {4, 8}}) -> ArgsProduct({{40}, {10, 20}, {2, 4}});
BENCHMARK(linearised)->Apply([](auto* b) { arguments(b, 8); });
BENCHMARK(frame_unstiffened)->Apply([](auto* b) { arguments(b, 3); });
BENCHMARK(frame)->Apply([](auto* b) { arguments(b, 3); }) -> ArgsProduct({{40}, {40}, {1, 2, 3, 6}})
    -> ArgsProduct({{40}, {10}, {1, 2, 6}});
BENCHMARK(geometrically_exact)
    ->Apply([](auto* b) { arguments(b, 8); }) -> ArgsProduct({{40}, {40}, {2, 4}});

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
