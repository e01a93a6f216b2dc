#include "online/step/copy_outputs.h"

#include <cstring>

namespace railstep {

namespace {

template <typename T, std::size_t most>
void copy(const T (&from)[most], T (&to)[most], std::int32_t count) noexcept {
  std::memcpy(to, from, sizeof(T) * static_cast<std::size_t>(count));
}

}  // namespace

void copy_published(const Model& model, const Outputs& from, Outputs& to) noexcept {
  const std::int32_t loads = model.loads, wheels = wheel_count(model),
                     flanges = flange_count(model);
  copy(from.load_x, to.load_x, loads);
  copy(from.load_place, to.load_place, loads);
  copy(from.load_deflection, to.load_deflection, loads);
  copy(from.load_force, to.load_force, loads);
  copy(from.wheel_force, to.wheel_force, wheels);
  copy(from.wheel_force_mean, to.wheel_force_mean, wheels);
  copy(from.wheel_force_peak, to.wheel_force_peak, wheels);
  copy(from.wheel_impulse, to.wheel_impulse, wheels);
  copy(from.wheel_gap, to.wheel_gap, wheels);
  copy(from.wheel_on_rail, to.wheel_on_rail, wheels);
  copy(from.wheel_x, to.wheel_x, wheels);
  copy(from.wheel_place, to.wheel_place, wheels);
  copy(from.wheel_rail_z, to.wheel_rail_z, wheels);
  copy(from.flange_force, to.flange_force, flanges);
  copy(from.flange_force_peak, to.flange_force_peak, flanges);
  copy(from.flange_impulse, to.flange_impulse, flanges);
  copy(from.flange_gap, to.flange_gap, flanges);
  copy(from.external_on_rail, to.external_on_rail, model.external_wheels);
  copy(from.external_place, to.external_place, model.external_wheels);
  copy(from.external_force, to.external_force, model.external_wheels);
  copy(from.external_displacement, to.external_displacement, model.external_wheels);
  copy(from.external_velocity, to.external_velocity, model.external_wheels);
}

}  // namespace railstep
