#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <vector>

#include "offline/system/pack_system.h"
#include "offline/system/system_energy.h"
#include "online/step/step.h"
#include "online/system/rotation.h"
#include "online/system/row.h"
#include "online/system/sensor.h"

namespace railstep {

/// A run of a system, with all its memory.
class Rollout {
 public:
  Rollout(const System& system, const SystemOptions& options) : packed_(system, options) {
    again();
  }

  const Model& model() const { return packed_.model(); }
  State& state() { return state_; }
  const Outputs& outputs() const { return outputs_; }

  void again() {
    numbers_.assign(static_cast<std::size_t>(state_doubles(model())), 0.);
    scratch_.assign(static_cast<std::size_t>(workspace_doubles(model())), 0.);
    state_ = state_on(model(), numbers_.data());
    workspace_ = workspace_on(model(), scratch_.data());
    reset(model(), state_);
  }
  Status step() { return advance_frame(model(), state_, workspace_, outputs_); }
  /// x and z of the first sensor, m.
  Eigen::Vector2d place() const {
    const PointMotion at = sensor_motion(model(), state_, 0);
    return {at.position[0], at.position[2]};
  }

 private:
  PackedSystem packed_;
  std::vector<double> numbers_, scratch_;
  State state_{};
  Workspace workspace_{};
  Outputs outputs_{};
};

/// Largest |Phi| and |Phi'| of the joint rows, which no motion drives, computed from the state
/// itself and not taken from the step's outputs.
struct Violation {
  double position, velocity;  // m (or 1), m/s
};
inline Violation violation(const Model& model, const State& state) {
  const SystemModel& s = model.system;
  std::vector<double> turned(9 * static_cast<std::size_t>(s.bodies) + 1);
  for (std::int32_t b = 0; b < s.bodies; ++b)
    rotation_matrix(state.quaternion + 4 * b, turned.data() + 9 * b);
  const Motions at{state.u + s.first, state.v + s.first, state.g + s.first, turned.data()};
  Violation most{0., 0.};
  for (std::int32_t r = 0; r < s.joint_rows; ++r) {
    const RowModel& row = s.row[r];
    const Jet phi = row_jet(row, marker_jet(s, s.marker[row.a], at),
                            marker_jet(s, s.marker[row.b], at), {row.offset, 0., 0.});
    most.position = std::max(most.position, std::abs(phi.x));
    most.velocity = std::max(most.velocity, std::abs(phi.v));
  }
  return most;
}

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Results of one run.
struct RunResult {
  double position = 0., velocity = 0.;  // largest violations, m and m/s
  double drift = kUnknown;  // slope of the largest violations of each tenth of the time, m/s
  double energy = 0.;       // largest change, J
  double energy_end = 0.;   // change at the end, J
  double error = kUnknown;  // of the sensor at 1 s, m
  double mean_iterations = 0.;
  int most_iterations = 0;
  double capped = 0.;     // share of steps that reached the cap
  double redundant = 0.;  // share of steps with redundant rows
  double step_us = 0.;    // processor time, best of several runs of the first second
  double end = 0.;        // s; earlier than asked if the state was lost
};

/// Slope of a least-squares line through values at the middles of equal parts of a time.
inline double slope(const std::array<double, 10>& value, double until) {
  double sum = 0., squares = 0.;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double t = (static_cast<double>(i) - 4.5) * until / 10.;
    sum += t * value[i];
    squares += t * t;
  }
  return sum / squares;
}

/// Processor time of a step over the first second, best of `times`, us.
inline double best_step_time(Rollout& run, int times) {
  const auto steps = static_cast<int>(std::lround(1. / run.model().scheme.dt));
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < times; ++i) {
    run.again();
    const std::clock_t begin = std::clock();
    for (int k = 0; k < steps; ++k) (void)run.step();
    best = std::min(best, static_cast<double>(std::clock() - begin));
  }
  return best / CLOCKS_PER_SEC * 1e6 / steps;
}

/// Runs to `until` (s) and checks every step. Ends early if the state is lost: the step reports it,
/// or a joint has come apart by a metre.
inline RunResult measure(const System& system, const SystemOptions& options, double until,
                         const Eigen::Vector2d& at_one_second) {
  Rollout run(system, options);
  RunResult result;
  const double dt = options.scheme.dt, start = system_energy(run.model(), run.state()).total();
  const auto steps = static_cast<int>(std::lround(until / dt));
  std::array<double, 10> largest{};
  int k = 0;
  for (; k < steps; ++k) {
    const Status status = run.step();
    const Violation off = violation(run.model(), run.state());
    if (has(status, Status::nonfinite_state) || !(off.position < 1.)) break;
    result.position = std::max(result.position, off.position);
    result.velocity = std::max(result.velocity, off.velocity);
    double& tenth = largest[static_cast<std::size_t>(10LL * k / steps)];
    tenth = std::max(tenth, off.position);
    result.energy_end = system_energy(run.model(), run.state()).total() - start;
    result.energy = std::max(result.energy, std::abs(result.energy_end));
    result.mean_iterations += run.outputs().iterations;
    result.most_iterations = std::max(result.most_iterations, run.outputs().iterations);
    result.capped += has(status, Status::cap_reached) ? 1. : 0.;
    result.redundant += has(status, Status::redundant_joint) ? 1. : 0.;
    if (k + 1 == std::lround(1. / dt)) result.error = (run.place() - at_one_second).norm();
  }
  for (double* sum : {&result.mean_iterations, &result.capped, &result.redundant})
    *sum /= std::max(1, k);
  result.end = k * dt;
  if (k == steps) result.drift = slope(largest, until);
  result.step_us = best_step_time(run, 3);
  return result;
}

}  // namespace railstep
