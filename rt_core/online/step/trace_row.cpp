#include "online/step/trace_row.h"

#include "online/step/trace_columns.h"
#include "online/track/track_sensor.h"

namespace railstep {

namespace {

struct ColumnCount {
  std::int32_t count = 0;
  template <typename Column, std::size_t n>
  void operator()(ColumnOf, std::int32_t, const Column (&)[n]) noexcept {
    count += static_cast<std::int32_t>(n);
  }
  void operator()(const TrackSensorModel& all) noexcept { count += all.count; }
};

struct RowWriter {
  const Model& model;
  const State& state;
  const Outputs& outputs;
  double* to;

  template <int most, std::size_t n>
  void operator()(ColumnOf of, std::int32_t i, const OutputColumn<most> (&columns)[n]) noexcept {
    const std::int32_t at = of == ColumnOf::flange ? flange_contact(model, i) : i;
    for (const OutputColumn<most>& column : columns) *to++ = (outputs.*column.value)[at];
  }
  template <std::size_t n>
  void operator()(ColumnOf, std::int32_t i, const ExternalColumn (&columns)[n]) noexcept {
    for (const ExternalColumn& column : columns)
      *to++ = (outputs.*column.value)[i][column.direction];
  }
  void operator()(const TrackSensorModel& all) noexcept {
    read_track_sensors(model, state, outputs, to);
    to += all.count;
  }
  template <std::size_t n>
  void operator()(ColumnOf, std::int32_t i, const SensorColumn (&columns)[n]) noexcept {
    const PointMotion point = sensor_motion(model, state, i);
    const double* const rest = model.system.sensor_rest + std::ptrdiff_t{3} * i;
    for (const SensorColumn& column : columns) {
      const int d = column.direction;
      switch (column.quantity) {
        case SensorQuantity::position:
          *to++ = point.position[d];
          break;
        case SensorQuantity::displacement:
          *to++ = point.position[d] - rest[d];
          break;
        case SensorQuantity::velocity:
          *to++ = point.velocity[d];
          break;
      }
    }
  }
  template <std::size_t n>
  void operator()(ColumnOf, std::int32_t i, const JointColumn (&columns)[n]) noexcept {
    const JointForce joint = joint_force(model, state, model.system.traced_joint[i]);
    for (const JointColumn& column : columns) *to++ = (joint.*column.value)[column.direction];
  }
  template <std::size_t n>
  void operator()(ColumnOf, std::int32_t i, const SpringColumn (&)[n]) noexcept {
    static_assert(n == 1);
    const SystemModel& s = model.system;
    *to++ = state.row_force[s.joint_rows + s.traced_spring[i]];
  }
};

}  // namespace

std::int32_t trace_columns(const Model& model) noexcept {
  ColumnCount time{1};
  for_each_column(model, time);
  return time.count;
}

void trace_row(const Model& model, const State& state, const Outputs& outputs,
               double* row) noexcept {
  if (has(state.latched, Status::nonfinite_state)) return;
  *row = static_cast<double>(state.steps) * model.scheme.dt;
  RowWriter write{model, state, outputs, row + 1};
  for_each_column(model, write);
}

}  // namespace railstep
