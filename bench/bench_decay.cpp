// A frame of a track at rest, 1e6 steps after its load has gone, and a frame under the load:
// numbers that decay must not cost more than others. Both take turns, so a slow machine slows both.
#include <benchmark/benchmark.h>

#include <chrono>

#include "online/step/step.h"
#include "run/simulation.h"

namespace railstep {
namespace {

using Clock = std::chrono::steady_clock;

struct Track {
  explicit Track(const char* kind)
      : run(simulation_of(read_any_scene(
            RAILSTEP_SOURCE "/config/scenes/moving_load.toml",
            {std::string("condense.kind=\"") + kind + "\"", "step.dt_s=1e-3",
             "load=[{name=\"a\", rail=\"left\", start_m=4.5, speed_m_per_s=0, force_z_n=-50e3, "
             "table=[[0, 1], [0.0999, 1], [0.1, 0]]}]"}))) {
    publish_start(run->model(), run->state, outputs);
  }
  void frames(int count) {
    for (int n = 0; n < count; ++n)
      benchmark::DoNotOptimize(advance_frame(run->model(), run->state, run->workspace, outputs));
  }
  std::unique_ptr<Simulation> run;
  Outputs outputs{};
};

void decayed(benchmark::State& bench, const char* kind) {
  constexpr int kBlock = 90;
  Track loaded(kind), rest(kind);
  rest.frames(1'000'000);
  double loaded_s = 0., rest_s = 0.;
  for (auto _ : bench) {
    reset(loaded.run->model(), loaded.run->state);
    const auto start = Clock::now();
    loaded.frames(kBlock);
    const auto between = Clock::now();
    rest.frames(kBlock);
    loaded_s += std::chrono::duration<double>(between - start).count();
    rest_s += std::chrono::duration<double>(Clock::now() - between).count();
  }
  const double frames = static_cast<double>(bench.iterations()) * kBlock;
  bench.counters["loaded_us"] = 1e6 * loaded_s / frames;
  bench.counters["decayed_us"] = 1e6 * rest_s / frames;
  bench.counters["ratio"] = rest_s / loaded_s;
}
BENCHMARK_CAPTURE(decayed, full, "full")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(decayed, modal, "modal")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
