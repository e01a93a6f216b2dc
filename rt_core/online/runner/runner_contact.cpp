#include "online/runner/runner_contact.h"

#include "online/math/dense.h"
#include "online/runner/body_force.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

constexpr double kLargeTurn = .1;  // rad, of a body in its frame: sines are 0.2 % off

/// Force of the drive on the first body ahead: what the motion along x leaves over.
double drive_force(const RunnerModel& runner, const State& at, double time) noexcept {
  const double acceleration = travelled(runner.travel, time).acceleration;
  double force = dot(runner.stiffness, at.u + runner.first, runner.size) +
                 dot(runner.damping, at.v + runner.first, runner.size) +
                 runner.mass[0] * acceleration - runner.rest[0];
  for (std::int32_t i = 0; i < runner.forces; ++i)
    if (runner.force[i].direction == 0) force -= force_at(runner.force[i], time, at.input);
  return force;
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
  const double place = element_place(model, runner, i, at.steps, 0.);
  out.wheelset_sum_y[set] = 0.;
  for (int side = 0; side < 2; ++side) {
    const std::int32_t wheel = 2 * set + side;
    const double* const force = wheel_force_of(at, set, side);
    const double outwards = side == 0 ? -force[1] : force[1];
    out.wheel_q[wheel] = force[2];
    out.wheel_y[wheel] = outwards;
    out.wheel_y_over_q[wheel] = force[2] > 0. ? outwards / force[2] : 0.;
    out.wheelset_sum_y[set] -= force[1];
    out.wheel_place[wheel] = place;
    out.wheel_on_rail[wheel] =
        model.lines > 0 && place >= 0. && place <= model.elements * model.element_length;
  }
  out.wheelset_y[set] = u[index_of(BodyMotion::y)];
  out.wheelset_yaw[set] = u[index_of(BodyMotion::yaw)];
}

}  // namespace

double element_place(const Model& model, const RunnerModel& runner, int wheelset, std::int64_t step,
                     double before) noexcept {
  const double way =
      model.lines == 0
          ? travelled(runner.travel, static_cast<double>(step) * model.scheme.dt - before).distance
          : way_at(model, runner.travel, step, before).distance;
  return (runner.start + way) + runner.wheelset[wheelset].place;
}

RailsUnder rails_under(const Model& model, const RunnerModel& runner, int wheelset,
                       std::int64_t step, double before, RailsUnder* slopes) noexcept {
  RailsUnder rails{};
  if (slopes != nullptr) *slopes = {};
  if (model.signals == 0) return rails;
  const double x = element_place(model, runner, wheelset, step, before) +
                   (model.lines > 0 ? track_offset(model, step) : 0.);
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
  const double time = static_cast<double>(at.steps) * model.scheme.dt;
  for (std::int32_t n = 0; n < model.runners; ++n) {
    const RunnerModel& runner = model.runner[n];
    for (int i = 0; i < runner.wheelsets; ++i) publish_wheelset(model, runner, i, at, outputs);
    outputs.drive_force[n] = drive_force(runner, at, time);
    if (has_large_turn(runner, at)) met = met | Status::large_turn;
  }
  return met;
}

}  // namespace railstep
