#pragma once
#include "online/math/dense.h"
#include "online/model/state.h"
#include "online/runner/frames.h"
#include "online/runner/profile_contact.h"

namespace railstep {

// Wheels of runners on their rails.

/// Where a runner's frame is, and how far the runner is ahead of it.
struct AlongTrack {
  std::int64_t step;
  double before;      // s before the end of the step
  double ahead = 0.;  // m, ahead_of() of runners that roll freely
  double speed = 0.;  // m/s, by which they are faster than their frame
};

/// How the first body of a runner goes along the design line. Acceleration is that of the frame.
OnLine on_line(const Model& model, const RunnerModel& runner, const AlongTrack& at) noexcept;
LineBodies line_bodies(const RunnerModel& runner) noexcept;
/// Where a runner is in a state.
inline AlongTrack along_in(const RunnerModel& runner, const State& at) noexcept {
  return {at.steps, 0., ahead_of(runner, at.u + runner.first),
          ahead_of(runner, at.v + runner.first)};
}
inline constexpr int kMostPoses = kMotions * kMaxFramePairs;
/// Poses of the frames of a runner's bodies. @param pose  [6 frames.pairs] out
/// @returns pose; null without a design line
const double* poses_of(const Model& model, const RunnerModel& runner, const AlongTrack& at,
                       double* pose) noexcept;
/// The same one step before a state.
const double* poses_before(const Model& model, const RunnerModel& runner, const State& at,
                           double* pose) noexcept;
/// Adds what a design line does to a runner: the forces of frames that accelerate and lean, those
/// of the suspension between frames that stand turned and aside, and gyroscopic moments.
/// @param span   s, as of frame_motion()
/// @param u, v   [size] motions and rates, of which those of free runners' spins count
/// @param force  [size]
void add_line_forces(const Model& model, const RunnerModel& runner, const OnLine& at, double span,
                     const double* u, const double* v, double* force) noexcept;
/// Displacement of a force element or elongation of a rod by the poses of frames.
/// @param rows  its table
inline double by_poses(const RunnerModel& runner, const double* rows, std::int32_t row,
                       const double* poses) noexcept {
  const std::int32_t n = kMotions * runner.frames.pairs;
  return dot(rows + std::ptrdiff_t{n} * row, poses, n);
}

/// @param slopes  out: derivatives along x; null: none
RailsUnder rails_under(const Model& model, const RunnerModel& runner, int wheelset,
                       const AlongTrack& at, RailsUnder* slopes = nullptr) noexcept;

/// Force of a rail on a wheel of a wheelset by profiles or by cones.
/// @param side  1 of the left wheel, -1 of the right
WheelForce force_on_wheel(const RollingContact& c, double radius, double side,
                          const Rolling& rolling, const OverRail& at, const double* v,
                          const RailRate& rate) noexcept;

/// The numbers that a state keeps of a wheel's force. @param to  [kWheelForces]
inline void keep_wheel_force(const WheelForce& force, double* to) noexcept {
  for (int d = 0; d < 3; ++d) to[d] = force.generalised[d];
  to[3] = force.on_section;
  to[4] = force.creep_power;
  to[5] = force.rail_y;
}

/// Place of a wheelset along the model's elements, m.
double element_place(const Model& model, const RunnerModel& runner, int wheelset,
                     const AlongTrack& at) noexcept;

/// How a wheel rolls. A wheel of a runner that rolls freely rolls at the mean of its own speed and
/// of its rim's. Below 1 m/s its creep follows the slip over a length, up to `relaxation`, by
/// implicit Euler.
/// @param frame     speed of the wheelset's frame, m/s
/// @param v         [6] rates of the wheelset's motions
/// @param creepage  [kWheelCreep] State::creepage; unused if the runner does not roll freely
/// @param dt        time since the creep was found, s; 0: it has not changed
Rolling rolling_of(const RunnerModel& runner, int wheelset, double frame, const double* v,
                   const double* creepage, double dt) noexcept;

/// Publishes the wheels and wheelsets of all runners, and the forces that hold them at their
/// places.
/// @returns large_turn where a body has left its small-angle frame
Status publish_runners(const Model& model, const State& at, Outputs& outputs) noexcept;

}  // namespace railstep
