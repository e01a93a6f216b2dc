#pragma once
#include "online/step/wheel.h"

namespace railstep {

/// Finds the contacts of a vehicle's wheels: upright, over the place that the time says. A wheel
/// off the rail stands on the ground at the height of the rail's axis at rest.
/// @param at       displacements of track and vehicles at which to look
/// @param contact  [wheels] of the model; those of the vehicle are written
/// @param later    s, by how much the irregularities under them are those of a later time
void find_vehicle_contacts(const Model& model, const VehicleModel& vehicle, double time,
                           const Configuration& at, WheelContact* contact,
                           double later = 0.) noexcept;

/// Displacement along a row of a rail by the lines alone, m.
double rail_height(const Model& model, const RailRow& row, const Configuration& at) noexcept;

/// Slope of the rail along x in a contact by the lines alone.
double slope_under(const Model& model, const WheelContact& at, const Configuration& seen) noexcept;

}  // namespace railstep
