#include "online/step/copy_outputs.h"

#include <cstring>

namespace railstep {

namespace {

template <typename T, std::size_t most>
void copy(const T (&from)[most], T (&to)[most], std::int32_t count) noexcept {
  std::memcpy(to, from, sizeof(T) * static_cast<std::size_t>(count));
}

/// Between Outputs and ContactOutputs, whose members have the same names.
template <typename From, typename To>
void copy_contacts(const From& from, To& to, std::int32_t contacts) noexcept {
  copy(from.contact_force, to.contact_force, contacts);
  copy(from.contact_force_mean, to.contact_force_mean, contacts);
  copy(from.contact_force_peak, to.contact_force_peak, contacts);
  copy(from.contact_impulse, to.contact_impulse, contacts);
  copy(from.contact_gap, to.contact_gap, contacts);
  copy(from.contact_on_rail, to.contact_on_rail, contacts);
  copy(from.contact_x, to.contact_x, contacts);
  copy(from.contact_place, to.contact_place, contacts);
  copy(from.contact_rail_z, to.contact_rail_z, contacts);
}

}  // namespace

void keep_contacts(const Model& model, const Outputs& from, ContactOutputs& to) noexcept {
  copy_contacts(from, to, contact_count(model));
}
void restore_contacts(const Model& model, const ContactOutputs& from, Outputs& to) noexcept {
  copy_contacts(from, to, contact_count(model));
}

void copy_published(const Model& model, const Outputs& from, Outputs& to) noexcept {
  const std::int32_t loads = model.loads, contacts = contact_count(model);
  copy(from.load_x, to.load_x, loads);
  copy(from.load_place, to.load_place, loads);
  copy(from.load_deflection, to.load_deflection, loads);
  copy(from.load_force, to.load_force, loads);
  copy_contacts(from, to, contacts);
  const std::int32_t sets = model.runner_wheelsets;
  copy(from.wheel_q, to.wheel_q, 2 * sets);
  copy(from.wheel_y, to.wheel_y, 2 * sets);
  copy(from.wheel_y_over_q, to.wheel_y_over_q, 2 * sets);
  copy(from.wheel_t_gamma, to.wheel_t_gamma, 2 * sets);
  copy(from.wheel_contact_y, to.wheel_contact_y, 2 * sets);
  copy(from.wheel_on_rail, to.wheel_on_rail, 2 * sets);
  copy(from.wheel_place, to.wheel_place, 2 * sets);
  copy(from.wheelset_sum_y, to.wheelset_sum_y, sets);
  copy(from.wheelset_y, to.wheelset_y, sets);
  copy(from.wheelset_yaw, to.wheelset_yaw, sets);
  copy(from.drive_force, to.drive_force, model.runners);
  copy(from.runner_way, to.runner_way, model.runners);
  copy(from.runner_speed, to.runner_speed, model.runners);
  copy(from.rod_tension, to.rod_tension, model.runner_rods);
  copy(from.element_force, to.element_force, model.runner_force_elements);
  copy(from.element_travel, to.element_travel, model.runner_force_elements);
  copy(from.traced_force, to.traced_force, model.runner_traced);
  copy(from.traced_travel, to.traced_travel, model.runner_traced);
  copy(from.external_on_rail, to.external_on_rail, model.external_wheels);
  copy(from.external_place, to.external_place, model.external_wheels);
  copy(from.external_force, to.external_force, model.external_wheels);
  copy(from.external_displacement, to.external_displacement, model.external_wheels);
  copy(from.external_velocity, to.external_velocity, model.external_wheels);
}

}  // namespace railstep
