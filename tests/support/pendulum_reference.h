#pragma once
#include "support/double_pendulum.h"
#include "support/high_order.h"

namespace railstep {

/// Sampling of the references, s.
inline constexpr double kPendulumSample = 1e-3;

struct PendulumRun {
  PendulumPath path;
  double energy_change = 0.;  // largest at the samples, J
};

/// Runs from rest by extrapolation of order 12, with `parts` steps per sample. A model has start(),
/// the first y; slope(y, dy); seen(y), B and C; energy(y). `watch` is called at every sample.
template <typename Model, typename Watch>
PendulumRun swing(const Model& model, double until, int parts, Watch watch) {
  const auto slope = [&model](double, const Eigen::VectorXd& at) {
    Eigen::VectorXd dy(at.size());
    model.slope(at, dy);
    return dy;
  };
  Eigen::VectorXd y = model.start();
  const double energy = model.energy(y);
  PendulumRun run{{kPendulumSample, {model.seen(y)}}};
  for (int i = 0; i < std::lround(until / kPendulumSample); ++i) {
    for (int k = 0; k < parts; ++k) y = extrapolated_step(slope, 0., y, kPendulumSample / parts, 6);
    run.path.at.push_back(model.seen(y));
    run.energy_change = std::max(run.energy_change, std::abs(model.energy(y) - energy));
    watch(y);
  }
  return run;
}

template <typename Model>
PendulumRun swing(const Model& model, double until, int parts) {
  return swing(model, until, parts, [](const Eigen::VectorXd&) {});
}

/// Steps per sample that follow an undamped oscillation: the step is 2.2 over its frequency
/// (rad/s), half the step at which order 12 loses it.
inline int steps_for(double frequency) {
  return std::max(1, static_cast<int>(std::ceil(kPendulumSample * frequency / 2.2)));
}

}  // namespace railstep
