#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/block_fields.h"
#include "support/endless_tracks.h"

namespace railstep {

inline constexpr double kDt = 1e-4;  // s: 200 steps a bay
inline constexpr int kStepsPerFrame = 10;

inline PackOptions framed(PackOptions options) {
  options.steps_per_frame = kStepsPerFrame;
  return options;
}

/// Means of the left wheel's force and of the rail's height under it, over frames of 1 ms.
struct Heard {
  std::vector<double> force, rail;
};

inline Heard listen(ModelRun& run, int from, int frames) {
  Heard heard;
  for (int frame = 1; frame <= from + frames; ++frame) {
    run.step();
    if (frame <= from) continue;
    heard.force.push_back(run.outputs.contact_force_mean[0]);
    heard.rail.push_back(run.outputs.contact_rail_z[0]);
  }
  CHECK(run.seen == Status::ok);
  return heard;
}

inline double largest(const std::vector<double>& a, const std::vector<double>& b) {
  double error = 0., peak = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error = std::max(error, std::abs(a[i] - b[i]));
    peak = std::max(peak, std::abs(b[i]));
  }
  return error / peak;
}

inline ModelRun moving_run(const Track& track, const Traffic& traffic, const PackOptions& options) {
  ModelRun run(track, traffic, framed(options));
  run.packed->set_start(start_moving(track, *run.packed, 0.));
  reset(run.model(), run.state);
  return run;
}

/// Checks that a run of 100 frames and the run of its block end alike, and so does a run that is
/// restored half way from a snapshot.
inline void check_goes_on(ModelRun& run) {
  const Block block = to_block(run.model(), "time_s");
  Model model;
  REQUIRE(read(block, model).status == LoadStatus::ok);
  LoadedRun loaded(model);
  CHECK(loaded.frames(100) == Status::ok);
  for (int frame = 0; frame < 50; ++frame) run.step();
  const std::vector<double> saved = run.memory;
  const std::int64_t steps = run.state.steps;
  for (int frame = 0; frame < 50; ++frame) run.step();
  CHECK(state_hash(run.model(), run.state) == state_hash(model, loaded.state));
  run.memory = saved;
  run.state = state_on(run.model(), run.memory.data());
  run.state.steps = steps;
  for (int frame = 0; frame < 50; ++frame) run.step();
  CHECK(state_hash(run.model(), run.state) == state_hash(model, loaded.state));
}

}  // namespace railstep
