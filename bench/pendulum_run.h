#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "online/step/step.h"
#include "online/system/sensor.h"
#include "support/pendulum_core.h"

namespace railstep {

/// A system of pendulums with its state, stepped by 1 ms.
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
    (void)advance_frame(packed.model(), state, workspace, outputs);
    iterations += outputs.iterations;
  }
};

inline constexpr double kPendulumStep = 1e-3;  // s
inline constexpr int kPendulumSteps = 1000;

inline SystemOptions pendulum_options(bool energy_momentum_scheme) {
  SystemOptions o;
  o.scheme = energy_momentum_scheme ? energy_momentum(kPendulumStep)
                                    : generalised_alpha(kPendulumStep, .9);
  o.energy_momentum = energy_momentum_scheme;
  return o;
}

/// Largest distance of C from the refined path, at the path's times up to 1 s, m.
inline double error_of_c(Pendulum& run) {
  static const PendulumPath known =
      read_pendulum_path(RAILSTEP_SOURCE "/tests/data/double_pendulum.csv");
  double worst = 0.;
  run.start();
  for (int n = 1; n <= kPendulumSteps; ++n) {
    run.step();
    const double time = n * kPendulumStep;
    const double at = std::round(time / known.step);
    if (std::abs(at * known.step - time) > 1e-9) continue;
    const PointMotion c = sensor_motion(run.packed.model(), run.state, 2);
    const HingeAndEnd want = known.at.at(static_cast<std::size_t>(at));
    worst = std::max(worst, std::hypot(c.position[0] - want[2], c.position[2] - want[3]));
  }
  return worst;
}

}  // namespace railstep
