#include "offline/pack/released.h"

#include "online/step/step.h"
#include "online/track/travel.h"

namespace railstep {

void start_rolling(const RunnerModel& runner, State& state) {
  double* const v = state.v + runner.first;
  for (std::int32_t b = 0; b < runner.bodies; ++b)
    v[kMotions * b + index_of(BodyMotion::x)] += runner.start_speed;
  for (std::int32_t i = 0; i < runner.wheelsets; ++i) {
    const RunnerWheelset& set = runner.wheelset[i];
    v[set.first + index_of(BodyMotion::pitch)] += runner.start_speed / set.radius;
    for (std::int32_t side = 0; side < 2; ++side)
      creepage_of(state, runner.first_wheelset + i, side)[3] = runner.start_speed < 0. ? -1. : 1.;
  }
}

std::vector<double> start_released(const PackedModel& packed) {
  const Model& model = packed.model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)), 0.);
  State state = state_on(model, memory.data());
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    state.v[model.wheelset[b].first] = travelled(model.wheelset[b].travel, 0.).speed;
  for (std::int32_t r = 0; r < model.runners; ++r)
    if (model.runner[r].rolls_freely != 0) start_rolling(model.runner[r], state);
  if (model.form == Form::condensed) forces(model, 0, state.a, state.g);
  return memory;
}

void put_falling(const Model& model, const std::vector<RunningVehicle>& vehicles,
                 std::vector<double>& memory) {
  State state = state_on(model, memory.data());
  for (std::size_t b = 0; b < vehicles.size(); ++b) {
    if (!vehicles[b].falling) continue;
    const SuspendedModel& own = model.vehicle[b];
    const std::vector<int> first = first_coordinates(vehicles[b].vehicle);
    for (std::size_t body = 0; body + 1 < first.size(); ++body) {
      const std::int32_t z = own.first + first[body];
      state.u[z] = vehicles[b].falling->height;
      state.v[z] = -vehicles[b].falling->speed;
      state.a[z] = state.g[z] = -vehicles[b].gravity;
    }
  }
}

}  // namespace railstep
