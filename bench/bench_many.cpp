// Many states of one model, stepped together against one by one: the same work, in turns.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "online/step/many.h"
#include "simulation.h"

namespace railstep {
namespace {

constexpr int kFrames = 50;  // of a block, 1 ms each: the traffic stays on the track

/// A scene of two 0.6 m-bay rails with a step a frame, as the lines to beat have it.
std::vector<std::string> peers(const std::string& unknowns, int bays) {
  return {"track.unknowns=\"" + unknowns + "\"", "track.bays=" + std::to_string(bays),
          "step.dt_s=1e-3", "step.duration_s=0.1"};
}

/// The same condensed, from two elements per bay.
std::vector<std::string> condensed(int bays, int modes_per_bay) {
  std::vector<std::string> keys = peers("vertical", bays);
  keys.insert(keys.end(), {"track.elements_per_bay=2", "condense.kind=\"modal\"",
                           "condense.modes_per_bay=" + std::to_string(modes_per_bay)});
  return keys;
}

/// Two wheels in Hertz contact, one on each rail, instead of the loads.
std::vector<std::string> on_wheels(std::vector<std::string> keys) {
  keys.insert(keys.end(),
              {"load=[]", "rail.crown_radius_m=0.3", "support.stiffness_roll_n_m_per_rad=1e6",
               "step.dt_s=50e-6", "step.frame_s=1e-3", "step.start=\"equilibrium\"",
               "vehicle=[{name=\"l\", type=\"sprung_mass\", rail=\"left\", mass_kg=4000, "
               "unsprung_mass_kg=900, stiffness_n_per_m=1.2e6, damping_n_s_per_m=4e3, start_m=2.5, "
               "speed_m_per_s=30}, "
               "{name=\"r\", type=\"sprung_mass\", rail=\"right\", mass_kg=4000, "
               "unsprung_mass_kg=900, stiffness_n_per_m=1.2e6, damping_n_s_per_m=4e3, start_m=2.5, "
               "speed_m_per_s=30}]"});
  return keys;
}

struct Kind {
  const char *name, *scene;
  std::vector<std::string> keys;
};

/// States of one model, each moved a little from the model's start by its own amount.
class Batch {
 public:
  Batch(const Model& model, int count, bool apart)
      : model_(model),
        count_(count),
        apart_(apart),
        memory_(static_cast<std::size_t>(count * state_doubles(model))),
        scratch_(static_cast<std::size_t>(workspace_doubles(model))),
        shared_(static_cast<std::size_t>(many_bytes(model))),
        workspace_(workspace_on(model, scratch_.data())),
        many_(many_workspace_on(model, shared_.data())),
        outputs_(static_cast<std::size_t>(count)) {
    for (int i = 0; i < count; ++i)
      states_.push_back(state_on(model, memory_.data() + i * state_doubles(model)));
  }

  void restart() {
    for (int i = 0; i < count_; ++i) {
      State& s = states_[static_cast<std::size_t>(i)];
      reset(model_, s);
      if (apart_) s.steps = i;
      for (std::int32_t k = 0; k < model_.unknowns; ++k) s.u[k] *= 1. + 1e-6 * i;
    }
  }
  /// Each through all frames before the next one starts: its data stay at hand.
  void alone(int frames) {
    for (std::size_t i = 0; i < states_.size(); ++i)
      for (int n = 0; n < frames; ++n)
        benchmark::DoNotOptimize(advance_frame(model_, states_[i], workspace_, outputs_[i]));
  }
  void together(int frames) {
    for (int n = 0; n < frames; ++n)
      benchmark::DoNotOptimize(
          advance_frames(model_, states_.data(), count_, many_, outputs_.data()));
  }
  std::uint64_t hash() const {
    std::uint64_t sum = 0;
    for (const State& s : states_) sum = 31 * sum + state_hash(model_, s);
    return sum;
  }
  bool is_finite() const {
    return std::none_of(states_.begin(), states_.end(),
                        [](const State& s) { return has(s.latched, Status::nonfinite_state); });
  }

 private:
  const Model& model_;
  int count_;
  bool apart_;  // each is a step further than the one before it
  std::vector<double> memory_, scratch_;
  std::vector<std::byte> shared_;
  std::vector<State> states_;
  Workspace workspace_;
  ManyWorkspace many_;
  std::vector<Outputs> outputs_;
};

/// The thread's own seconds: other work on the machine is not among them.
double seconds_run() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Blocks of both in turns; rates of the best blocks, and the middle ratio of neighbours.
void measure(benchmark::State& run, const Kind& kind) {
  const auto scene = simulation_of(read_any_scene(
      std::string(RAILSTEP_SOURCE) + "/config/scenes/" + kind.scene + ".toml", kind.keys));
  const Model& model = scene->model();
  const int count = static_cast<int>(run.range(0));
  Batch batch(model, count, run.range(1) != 0);
  const int frames = std::max(2, kFrames / model.steps_per_frame);
  const int rounds = std::max(1, 100 / count);  // so that blocks are long
  const auto seconds = [&](auto step) {
    double sum = 0.;
    for (int n = 0; n < rounds; ++n) {
      batch.restart();
      const double from = seconds_run();
      step();
      sum += seconds_run() - from;
    }
    return sum / rounds;
  };
  double best_alone = 1e9, best_together = 1e9;
  std::vector<double> ratios;
  for (auto _ : run) {
    const double alone = seconds([&] { batch.alone(frames); });
    const std::uint64_t hash = batch.hash();
    const double together = seconds([&] { batch.together(frames); });
    if (hash != batch.hash()) run.SkipWithError("other bits together than alone");
    if (!batch.is_finite()) run.SkipWithError("a state is no number");
    best_alone = std::min(best_alone, alone);
    best_together = std::min(best_together, together);
    ratios.push_back(alone / together);
    run.SetIterationTime((alone + together) * rounds);
  }
  const auto mid = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), mid, ratios.end());
  const double steps = static_cast<double>(frames) * model.steps_per_frame * count;
  run.counters["alone_per_s"] = steps / best_alone;
  run.counters["together_per_s"] = steps / best_together;
  run.counters["ratio"] = *mid;
  run.counters["unknowns"] = model.unknowns;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"loads/full/16", "moving_load", peers("full", 16)},
      {"loads/full/64", "moving_load", peers("full", 64)},
      {"loads/vertical/16", "moving_load", peers("vertical", 16)},
      {"loads/vertical/64", "moving_load", peers("vertical", 64)},
      {"loads/condensed/16x1", "moving_load", condensed(16, 1)},
      {"loads/condensed/16x2", "moving_load", condensed(16, 2)},
      {"loads/condensed/64x1", "moving_load", condensed(64, 1)},
      {"wheels/vertical/16", "moving_load", on_wheels(peers("vertical", 16))},
      {"wheels/full/16", "moving_load", on_wheels(peers("full", 16))},
      {"wheels/full/64", "moving_load", on_wheels(peers("full", 64))},
      {"wheels/condensed/16x1", "moving_load", on_wheels(condensed(16, 1))},
      {"wheels/condensed/16x2", "moving_load", on_wheels(condensed(16, 2))},
      {"wheelset/full", "wheelset_on_track", {}},
      {"wheelset/condensed", "wheelset_on_track", {"condense.kind=\"modal\""}},
      {"ballasted/full", "ballasted_track", {"condense.kind=\"full\""}},
      {"ballasted/condensed", "ballasted_track", {}},
      {"hanging/full", "hanging_sleeper", {}},
      {"hanging/condensed", "hanging_sleeper", {"condense.kind=\"modal\""}},
      {"bogie/full", "bogie_at_speed", {}},
      {"bogie/condensed", "bogie_at_speed", {"condense.kind=\"modal\""}},
      {"endless/full", "endless_track", {"condense.kind=\"full\""}},
      {"endless/condensed", "endless_track", {}},
      {"machine/full", "exciter_on_track", {}},
      {"bodies", "double_pendulum", {}},
  };
  return all;
}

[[maybe_unused]] const bool registered = [] {
  for (const Kind& kind : kinds())
    benchmark::RegisterBenchmark(kind.name, [&kind](benchmark::State& run) { measure(run, kind); })
        ->ArgNames({"states", "apart"})
        ->Args({1, 0})
        ->Args({8, 0})
        ->Args({32, 0})
        ->Args({32, 1})
        ->UseManualTime()
        ->MinTime(.5);
  return true;
}();

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
