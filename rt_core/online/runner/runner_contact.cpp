#include "online/runner/runner_contact.h"

#include "online/math/dense.h"
#include "online/runner/force_elements.h"
#include "online/runner/traced_elements.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

constexpr double kLargeTurn = .1;  // rad, of a body in its frame: sines are 0.2 % off

double time_of(const Model& model, const AlongTrack& at) noexcept {
  return static_cast<double>(at.step) * model.scheme.dt - at.before;
}

double speed_of(const Model& model, const RunnerModel& runner, const AlongTrack& at) noexcept {
  return travelled(runner.travel, time_of(model, at)).speed + at.speed;
}

/// The forces of a runner's constraints, and how far its rods are from their lengths.
/// @param poses  of the frames on a design line; else null
void publish_constraints(const Model& model, const RunnerModel& runner, const State& at,
                         const double* poses, Outputs& out) noexcept {
  const double* const reaction = reactions_of(model, at, runner);
  const std::ptrdiff_t own = &runner - model.runner;
  const bool free = runner.rolls_freely != 0;
  out.drive_force[own] = reaction[0];
  out.runner_way[own] = free ? at.u[runner.first] : 0.;
  out.runner_speed[own] = free ? at.v[runner.first] : 0.;
  for (std::int32_t j = 0; j < runner.rods; ++j) {
    out.rod_tension[runner.first_rod + j] = reaction[1 + j];
    const double* const row = runner.rod_row + std::ptrdiff_t{runner.size} * j;
    double longer = dot(row, at.u + runner.first, runner.size);
    if (poses != nullptr) longer += by_poses(runner, runner.frames.rods, j, poses);
    longer = std::fabs(longer);
    if (longer > out.constraint_violation) out.constraint_violation = longer;
  }
}

bool has_large_turn(const RunnerModel& runner, const State& at) noexcept {
  const double* u = at.u + runner.first;
  for (std::int32_t b = 0; b < runner.bodies; ++b, u += kMotions) {
    const double roll = std::fabs(u[index_of(BodyMotion::roll)]),
                 yaw = std::fabs(u[index_of(BodyMotion::yaw)]);
    if (roll > kLargeTurn || yaw > kLargeTurn) return true;
  }
  return false;
}

void publish_wheelset(const Model& model, const RunnerModel& runner, int i, const State& at,
                      Outputs& out) noexcept {
  const std::int32_t set = runner.first_wheelset + i;
  const double* const u = at.u + runner.first + runner.wheelset[i].first;
  const AlongTrack along = along_in(runner, at);
  const double place = element_place(model, runner, i, along);
  const double speed = std::fabs(speed_of(model, runner, along));
  out.wheelset_sum_y[set] = 0.;
  for (int side = 0; side < 2; ++side) {
    const std::int32_t wheel = WheelId{set, side}.number();
    const double* const force = wheel_force_of(at, set, side);
    const double outwards = side == 0 ? -force[1] : force[1];
    out.wheel_q[wheel] = force[2];
    out.wheel_y[wheel] = outwards;
    out.wheel_y_over_q[wheel] = force[2] > 0. ? outwards / force[2] : 0.;
    out.wheel_t_gamma[wheel] = speed > kLeastRolling ? -force[4] / speed : 0.;
    out.wheel_contact_y[wheel] = side == 0 ? force[5] : -force[5];
    out.wheelset_sum_y[set] -= force[1];
    out.wheel_place[wheel] = place;
    out.wheel_on_rail[wheel] =
        model.lines > 0 && place >= 0. && place <= model.elements * model.element_length;
  }
  out.wheelset_y[set] = u[index_of(BodyMotion::y)];
  out.wheelset_yaw[set] = u[index_of(BodyMotion::yaw)];
}

}  // namespace

WheelForce force_on_wheel(const RollingContact& c, double radius, double side,
                          const Rolling& rolling, const OverRail& at, const double* v,
                          const RailRate& rate) noexcept {
  if (!has_profiles(c)) return wheel_force(c, radius, side, rolling, at.motion, v, rate);
  ProfileWheel wheel;
  find_profile_wheel(c, radius, side, at, wheel);
  double stiffness[kMostZones];
  return profile_force(c, wheel, radius, side, rolling, at, v, rate, stiffness);
}

namespace {

/// Place of a runner's origin along the model's elements, m.
double origin_place(const Model& model, const RunnerModel& runner, const AlongTrack& at) noexcept {
  const double way = model.lines == 0 ? travelled(runner.travel, time_of(model, at)).distance
                                      : way_at(model, runner.travel, at.step, at.before).distance;
  return runner.start + (way + at.ahead);
}

/// From a place along the model's elements to one along the track, m.
double offset_of(const Model& model, const AlongTrack& at) noexcept {
  return model.lines > 0 ? track_offset(model, at.step) : 0.;
}

}  // namespace

double element_place(const Model& model, const RunnerModel& runner, int wheelset,
                     const AlongTrack& at) noexcept {
  return origin_place(model, runner, at) + runner.wheelset[wheelset].place;
}

OnLine on_line(const Model& model, const RunnerModel& runner, const AlongTrack& at) noexcept {
  const Travelled frame = travelled(runner.travel, time_of(model, at));
  return {(origin_place(model, runner, at) + offset_of(model, at)) + runner.frames.centre[0],
          frame.speed + at.speed, frame.acceleration};
}

LineBodies line_bodies(const RunnerModel& runner) noexcept {
  return {runner.bodies, runner.frames.centre, runner.mass, runner.frames.gravity};
}

const double* poses_of(const Model& model, const RunnerModel& runner, const AlongTrack& at,
                       double* pose) noexcept {
  if (!is_there(model.design_line)) return nullptr;
  find_poses(model.design_line, on_line(model, runner, at), runner.frames, pose);
  return pose;
}

const double* poses_before(const Model& model, const RunnerModel& runner, const State& at,
                           double* pose) noexcept {
  AlongTrack where = along_in(runner, at);
  where.before = model.scheme.dt;
  where.ahead -= model.scheme.dt * where.speed;
  return poses_of(model, runner, where, pose);
}

void add_line_forces(const Model& model, const RunnerModel& runner, const OnLine& at, double span,
                     const double* u, const double* v, double* force) noexcept {
  const DesignLine& line = model.design_line;
  add_frame_forces(line, at, line_bodies(runner), span, force);
  for (std::int32_t i = 0; i < runner.wheelsets; ++i) {
    const RunnerWheelset& set = runner.wheelset[i];
    const double beyond = runner.rolls_freely != 0 ? v[set.first + index_of(BodyMotion::pitch)]
                                                   : at.speed / set.radius;
    const double place = at.place + (set.place - runner.frames.centre[0]);
    add_gyroscopic(rotation_at(line, place), at.speed, set.spin_inertia * beyond,
                   force + set.first);
  }
  add_pair_forces(line, at, runner.frames, u, force);
  if (runner.frames.series == nullptr) return;
  const std::int32_t n = kMotions * runner.frames.pairs;
  double pose[kMostPoses];
  find_poses(line, at, runner.frames, pose);
  for (std::int32_t k = 0; k < n; ++k) pose[k] = -pose[k];
  columns_multiply_add(runner.frames.series, pose, force, runner.size, n);
}

Rolling rolling_of(const RunnerModel& runner, int wheelset, double frame, const double* v,
                   const double* creepage, double dt) noexcept {
  // Slower than kSlow creep follows slip in a length, and the direction stays as it was below
  // kStill.
  constexpr double kSlow = 1., kStill = 1e-3, kSteady = 1e12;  // m/s, m/s, 1/s
  Rolling rolling(frame);
  if (runner.rolls_freely == 0) return rolling;
  const double ahead = frame + v[index_of(BodyMotion::x)],
               rim = frame + runner.wheelset[wheelset].radius * v[index_of(BodyMotion::pitch)];
  const double mean = .5 * (std::fabs(ahead) + std::fabs(rim)), slow = 2. - 2. * mean / kSlow;
  const double length = runner.contact.relaxation * (slow > 1. ? 1. : slow > 0. ? slow : 0.);
  const double follows = length * (dt > 0. ? 1. / dt : kSteady);
  const double both = ahead + rim,
               sign = std::fabs(both) > kStill ? (both < 0. ? -1. : 1.) : creepage[3];
  const double over = mean + follows > kLeastRolling ? mean + follows : kLeastRolling;
  rolling.over = sign * over;
  rolling.keeps = true;
  for (int k = 0; k < 3; ++k) rolling.left[k] = (over - mean) * creepage[k];
  rolling.left[2] *= sign;
  return rolling;
}

RailsUnder rails_under(const Model& model, const RunnerModel& runner, int wheelset,
                       const AlongTrack& at, RailsUnder* slopes) noexcept {
  RailsUnder rails;
  if (slopes != nullptr) *slopes = {};
  const RollingFriction& friction = runner.contact.creep.friction;
  const bool on_design_line = is_there(model.design_line);
  if (model.signals == 0 && friction.places == 0 && !on_design_line) return rails;
  const double x = element_place(model, runner, wheelset, at) + offset_of(model, at);
  if (on_design_line) {
    const double speed = speed_of(model, runner, at);
    const FrameRotation rotation = rotation_at(model.design_line, x);
    rails.frame_pitch = speed * rotation.y;
    rails.frame_yaw = speed * rotation.z;
    rails.frame_x = at.ahead;
  }
  grip_at(friction, x, rails.grip);
  for (std::int32_t i = 0; i < model.signals; ++i) {
    const RailSignal& own = model.signal[i];
    const SignalValue found = signal_at(own.signal, x);
    (own.direction == 1 ? rails.y : rails.z)[own.rail] += found.value;
    if (slopes != nullptr) (own.direction == 1 ? slopes->y : slopes->z)[own.rail] += found.slope;
  }
  return rails;
}

Status publish_runners(const Model& model, const State& at, Outputs& outputs) noexcept {
  Status met = Status::ok;
  for (std::int32_t n = 0; n < model.runners; ++n) {
    const RunnerModel& runner = model.runner[n];
    for (int i = 0; i < runner.wheelsets; ++i) publish_wheelset(model, runner, i, at, outputs);
    double pose[kMostPoses];
    const double* const poses = runner.force_elements + runner.rods + runner.traced_elements > 0
                                    ? poses_of(model, runner, along_in(runner, at), pose)
                                    : nullptr;
    publish_constraints(model, runner, at, poses, outputs);
    for (std::int32_t j = 0; j < runner.force_elements; ++j) {
      const StandingElement element = standing_element(model, runner, j, at, poses);
      outputs.element_force[runner.first_force_element + j] =
          element.force.force + runner.force_element[j].preload;
      outputs.element_travel[runner.first_force_element + j] = element.z;
    }
    publish_traced(model, runner, at, poses, outputs);
    if (has_large_turn(runner, at)) met = met | Status::large_turn;
  }
  return met;
}

}  // namespace railstep
