#pragma once
#include "online/contact/wheel.h"

namespace railstep {

/// Places the wheels of all vehicles: upright, over the place at the given time, with the rail's
/// row and irregularities there, independent of displacements. A wheel off the rail stands on the
/// ground at the height of the rail's axis at rest.
/// @param before   s; the place is that at this time before the step's end
/// @param contact  [contacts] of the model; those of vehicles are written
/// @param later    s; irregularities are those at this time after the place's
void place_vehicle_wheels(const Model& model, std::int64_t step, double before,
                          WheelContact* contact, double later = 0.) noexcept;

/// The same with the penetrations of a configuration.
/// @param at       displacements of track and vehicles
/// @param contact  [contacts] of the model; those of vehicles are written
void find_vehicle_contacts(const Model& model, std::int64_t step, double before,
                           const Configuration& at, WheelContact* contact) noexcept;

/// Slope of the rail along x in a contact by the lines alone.
double slope_under(const Model& model, const WheelContact& at,
                   const Configuration& located) noexcept;

}  // namespace railstep
