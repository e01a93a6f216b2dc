#include "online/track/track_sensor.h"

#include "online/math/float_mode.h"
#include "online/model/progress.h"
#include "online/track/residual.h"

namespace railstep {

namespace {

/// Value by its index in u, then v, then the fixed ports' forces, then g.
double value_at(const Model& model, const State& state, std::int32_t at) noexcept {
  if (at < model.unknowns) return state.u[at];
  at -= model.unknowns;
  if (at < model.unknowns) return state.v[at];
  at -= model.unknowns;
  return at < model.fixed.count ? state.port_force[at] : state.g[at - model.fixed.count];
}

// Never inlined: none of its arithmetic may move out of the mode that its caller sets.
[[gnu::noinline]] void read(const Model& model, const State& state, const Outputs& outputs,
                            double* value) noexcept {
  RailForce forces[kMaxRailForces];
  const int count = rail_forces(model, outputs, forces);
  const TrackSensorModel& track_sensor = model.track_sensor;
  const double offset = track_offset(model, state.steps);
  for (std::int32_t i = 0; i < track_sensor.count; ++i) {
    double sum = 0.;
    for (std::int32_t k = track_sensor.start[i]; k < track_sensor.start[i + 1]; ++k) {
      const std::int32_t at = track_sensor.index[k];
      sum += track_sensor.value[k] * value_at(model, state, at);
    }
    value[i] = track_sensor.rest[i] + (sum + residual_of_track_sensor(model, i, forces, count));
    if (track_sensor.along[i] != 0) value[i] += offset;
  }
}

}  // namespace

void read_track_sensors(const Model& model, const State& state, const Outputs& outputs,
                        double* value) noexcept {
  if (has(state.latched, Status::nonfinite_state)) return;
  const FloatMode flushed_to_zero;
  read(model, state, outputs, value);
}

}  // namespace railstep
