#include "study/frame_cost.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "online/model/state.h"
#include "run/simulate.h"

namespace railstep {
namespace {

/// Median of some frames from the start, us.
double timed(Simulation& run, std::int64_t frames) {
  reset(run.model(), run.state);
  const double median = quantile(simulate(run, frames, {}, false).frame_us, .5);
  reset(run.model(), run.state);
  return median;
}

/// As many frames as fill the window, of those that the run has.
std::int64_t frames_in(Simulation& run, double window) {
  const Model& model = run.model();
  const std::int64_t all = model.steps / model.steps_per_frame;
  const double one = std::max(timed(run, std::min<std::int64_t>(all, 3)), 1e-2);
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(window / one), 1, all);
}

}  // namespace

Timing::Timing(std::unique_ptr<Simulation> steady)
    : steady_(std::move(steady)), first_(timed(*steady_, frames_in(*steady_, kWindow))) {}

FrameCost Timing::cost_of(Simulation& run) {
  const std::int64_t frames = frames_in(run, kWindow), beside = frames_in(*steady_, kWindow);
  std::vector<double> took;
  for (int n = 0; n < kRepeats; ++n) {
    const double steady = timed(*steady_, beside);
    took.push_back(timed(run, frames) / steady * first_);
  }
  const auto [least, most] = std::minmax_element(took.begin(), took.end());
  return {quantile(took, .5), *least, *most, run.model().cost.flops, run.model().cost.bytes};
}

}  // namespace railstep
