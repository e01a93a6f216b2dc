#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// The bodies of wheelsets and vehicles in a step's coupled problem, at their contacts.

/// Motion of each vehicle without contact, in `solved`.
/// @param time  s; at which the equations of bodies hold
void free_vehicles(const Model& model, double time, const State& s, Workspace& w) noexcept;

/// Laws of all contacts over the step. A damper acts on the rate of penetration at the step's end,
/// kv (d - d*) + v* plus the effect of the wheel's motion along the rail; if forces are held, on
/// (d - d0) / (theta dt).
void find_contact_laws(const Model& model, double time, const State& s, const Workspace& w,
                       Coupling& c) noexcept;

/// Change of the approach of contact i by a unit force at contact j, through the bodies that carry
/// both.
double body_compliance(const Model& model, const Coupling& c, ContactId i, ContactId j) noexcept;

/// Moves the bodies under the contact forces, in `solved`; their part of `scaled` is overwritten.
void move_bodies(const Model& model, const Coupling& c, Workspace& w) noexcept;

/// Whether a wheel that now meets its rail will leave it within 10 steps (impact.h). The rail
/// counts as rigid (a compliant one holds the wheel for longer). The mass is that at the contact
/// alone, or at a tread together with the other one of its wheelset if this is less.
bool impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                          ContactId contact) noexcept;

}  // namespace railstep
