#include "online/step/trace_row.h"

#include "online/system/sensor.h"
#include "online/track/track_sensor.h"

namespace railstep {

namespace {

double* append(const double* from, int count, double* to) noexcept {
  for (int i = 0; i < count; ++i) *to++ = from[i];
  return to;
}

double* append_wheels(const Model& model, const Outputs& out, double* to) noexcept {
  for (std::int32_t i = 0; i < wheel_count(model); ++i)
    for (const double* quantity : {out.wheel_force, out.wheel_force_mean, out.wheel_force_peak,
                                   out.wheel_impulse, out.wheel_gap, out.wheel_rail_z})
      *to++ = quantity[i];
  for (std::int32_t i = 0; i < 2 * model.flanges; ++i)
    for (const double* quantity :
         {out.flange_force, out.flange_force_peak, out.flange_impulse, out.flange_gap})
      *to++ = quantity[i];
  for (std::int32_t i = 0; i < model.external_wheels; ++i) {
    to = append(out.external_displacement[i], 3, to);
    to = append(out.external_velocity[i], 3, to);
  }
  return to;
}

double* append_system(const Model& model, const State& state, double* to) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t i = 0; i < s.sensors; ++i) {
    const PointMotion p = sensor_motion(model, state, i);
    const double* rest = s.sensor_rest + std::ptrdiff_t{3} * i;
    to = append(p.position, 3, to);
    for (int d = 0; d < 3; ++d) *to++ = p.position[d] - rest[d];
    *to++ = p.velocity[2];
  }
  for (std::int32_t i = 0; i < s.traced_joints; ++i) {
    const JointForce f = joint_force(model, state, s.traced_joint[i]);
    to = append(f.force, 3, to);
    to = append(f.moment, 3, to);
  }
  for (std::int32_t i = 0; i < s.traced_springs; ++i)
    *to++ = state.row_force[s.joint_rows + s.traced_spring[i]];
  return to;
}

}  // namespace

std::int32_t trace_columns(const Model& model) noexcept {
  return 1 + 2 * model.loads + 6 * wheel_count(model) + 8 * model.flanges +
         6 * model.external_wheels + model.track_sensor.count + 7 * model.system.sensors +
         6 * model.system.traced_joints + model.system.traced_springs;
}

void trace_row(const Model& model, const State& state, const Outputs& outputs,
               double* row) noexcept {
  if (has(state.latched, Status::nonfinite_state)) return;
  *row++ = static_cast<double>(state.steps) * model.scheme.dt;
  for (std::int32_t i = 0; i < model.loads; ++i) {
    *row++ = outputs.load_x[i];
    *row++ = outputs.load_deflection[i];
  }
  row = append_wheels(model, outputs, row);
  read_track_sensors(model, state, outputs, row);
  append_system(model, state, row + model.track_sensor.count);
}

}  // namespace railstep
