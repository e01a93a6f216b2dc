#include "condense_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate.h"

namespace railstep {
namespace {

constexpr double kWindow = .1;  // s, at most

bool is_compared(const std::string& column) {
  for (const char* quantity : {".deflection_z_m", ".rail_z_m"})
    if (column.ends_with(quantity)) return true;
  return false;
}

std::vector<double> rows_of(const Scene& scene, std::int64_t frames) {
  Simulation run(scene);
  return simulate(run, frames, nullptr, true).rows;
}

}  // namespace

TransientError transient_error(const Scene& scene, const std::vector<std::string>& overrides) {
  const StepScene& step = *scene.step;  // there, or no model would be
  const double frame = step.dt * static_cast<double>(step.steps_per_frame);
  const double most = std::min(kWindow, scene.duration());
  const auto frames = std::max<std::int64_t>(1, std::llround(std::floor(most / frame + 1e-9)));
  std::vector<std::string> finer = overrides;
  finer.push_back("condense.kind=\"full\"");
  finer.push_back(fmt::format("track.elements_per_bay={}", 2 * scene.track.elements_per_bay));
  finer.push_back(fmt::format("step.frame_s={:.17g}", frame));
  finer.push_back(fmt::format("step.dt_s={:.17g}", .5 * step.dt));
  const Simulation columns(scene);
  const std::vector<double> got = rows_of(scene, frames);
  const std::vector<double> want = rows_of(read_scene(scene.file, finer), frames);
  const std::size_t width = columns.columns().size(), rows = got.size() / width;
  if (got.size() != want.size()) throw std::runtime_error("the reference run ended early");
  const std::size_t first = step.start == Start::released ? rows / 5 : 0;
  TransientError result{static_cast<double>(frames) * frame, 0.};
  for (std::size_t c = 0; c < width; ++c) {
    if (!is_compared(columns.columns()[c])) continue;
    double peak = 0., error = 0.;
    for (std::size_t r = first; r < rows; ++r) {
      peak = std::max(peak, std::abs(want[r * width + c]));
      error = std::max(error, std::abs(got[r * width + c] - want[r * width + c]));
    }
    if (peak > 0.) result.largest = std::max(result.largest, error / peak);
  }
  return result;
}

}  // namespace railstep
