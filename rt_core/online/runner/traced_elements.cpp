#include "online/runner/traced_elements.h"

#include "online/math/dense.h"
#include "online/runner/runner_contact.h"

namespace railstep {

void publish_traced(const Model& model, const RunnerModel& runner, const State& at,
                    const double* poses, Outputs& outputs) noexcept {
  if (runner.traced_elements == 0) return;
  double pose[kMostPoses];
  const double* const before = poses != nullptr ? poses_before(model, runner, at, pose) : nullptr;
  const double *const u = at.u + runner.first, *const v = at.v + runner.first;
  for (std::int32_t j = 0; j < runner.traced_elements; ++j) {
    const TracedElement& e = runner.traced[j];
    const double* const row = runner.traced_row + std::ptrdiff_t{runner.size} * j;
    double z = dot(row, u, runner.size), rate = dot(row, v, runner.size);
    if (before != nullptr) {
      const double moved = by_poses(runner, runner.frames.traced_moved, j, poses);
      z += moved;
      rate += (moved - by_poses(runner, runner.frames.traced_moved, j, before)) / model.scheme.dt;
    }
    const std::int32_t i = runner.first_traced + j;
    outputs.traced_travel[i] = z;
    outputs.traced_force[i] =
        e.preload - e.stiffness * z - e.series * (z - u[e.deflection]) - e.damping * rate;
  }
}

}  // namespace railstep
