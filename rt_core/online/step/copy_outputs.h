#pragma once
#include "online/model/state.h"

namespace railstep {

/// Copies the published outputs of loads, wheels and flanges; those of the frame itself (status,
/// iterations, residuals) are left.
void copy_published(const Model& model, const Outputs& from, Outputs& to) noexcept;

/// Outputs of contacts that steps change before their frame is published.
struct ContactOutputs {
  double contact_force[kMaxWheels], contact_force_mean[kMaxWheels], contact_force_peak[kMaxWheels],
      contact_impulse[kMaxWheels], contact_gap[kMaxWheels];
  bool contact_on_rail[kMaxWheels];
  double contact_x[kMaxWheels], contact_place[kMaxWheels], contact_rail_z[kMaxWheels];
};
void keep_contacts(const Model& model, const Outputs& from, ContactOutputs& to) noexcept;
void restore_contacts(const Model& model, const ContactOutputs& from, Outputs& to) noexcept;

}  // namespace railstep
