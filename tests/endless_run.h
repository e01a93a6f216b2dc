#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "endless.h"

namespace railstep {

inline constexpr double kDt = 1e-4;  // s: 200 steps a bay
inline constexpr int kStepsPerFrame = 10;

inline PackOptions framed(PackOptions options) {
  options.steps_per_frame = kStepsPerFrame;
  return options;
}

/// Means over frames of 1 ms of the left wheel's force, and the rail's height under it.
struct Heard {
  std::vector<double> force, rail;
};

inline Heard listen(ModelRun& run, int from, int frames) {
  Heard heard;
  for (int frame = 1; frame <= from + frames; ++frame) {
    run.step();
    if (frame <= from) continue;
    heard.force.push_back(run.outputs.wheel_force_mean[0]);
    heard.rail.push_back(run.outputs.wheel_rail_z[0]);
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

}  // namespace railstep
