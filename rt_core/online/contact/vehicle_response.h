#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Vehicles in a step's coupled problem. Their wheels follow those of the wheelsets.

/// Motion of each vehicle without contact, in `solved`.
void free_vehicles(const Model& model, double time, const State& s, Workspace& w) noexcept;

/// Laws of the vehicles' wheels over the step. A damper acts on the rate of penetration at the
/// step's end, kv (d - d*) + v* plus the effect of the wheel's motion along the rail; if forces are
/// held, on (d - d0) / (theta dt).
void find_vehicle_laws(const Model& model, double time, const State& s, const Workspace& w,
                       Coupling& c) noexcept;

/// Change of the approach of wheel i by a unit force at wheel j, through a vehicle that carries
/// both.
double vehicle_compliance(const Model& model, ContactId i, ContactId j) noexcept;

/// Penetration of wheel i from the located rail, irregularities and the vehicle's position at the
/// step's start, without the effect of the coordinates at the step's end.
double vehicle_offset(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept;

/// Moves the vehicles under the contact forces.
void move_vehicles(const Model& model, Workspace& w, const Coupling& c) noexcept;

/// As tread_impact_is_unresolved() of wheelsets, for the mass that acts at the wheel alone.
bool vehicle_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                  ContactId wheel) noexcept;

}  // namespace railstep
