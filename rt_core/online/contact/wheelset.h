#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Wheelsets in a step's coupled problem, on their treads and flanges (model/contact_id.h).

/// Motion of each wheelset without contact.
void free_wheelsets(const Model& model, const Stage& stage, const State& s, const Workspace& w,
                    Coupling& c) noexcept;

/// Change of the approach of contact i by a unit force at contact j, through a wheelset that
/// carries both.
double wheelset_compliance(const Model& model, const Coupling& c, ContactId i,
                           ContactId j) noexcept;

/// Penetration of contact i from frozen geometry and the wheelset's position at the step's start,
/// without the effect of the coordinates at the step's end.
double wheelset_offset(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                       ContactId i) noexcept;

/// Distance by which contact i leaves its rail over the step without contact forces.
double free_lift(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept;

/// Largest number of iterations of the guides' augmented Lagrangian around the contacts.
std::int32_t guide_iterations(const Model& model) noexcept;

/// Moves the wheelsets under the contact forces and corrects the guides' multipliers.
/// @param violation  raised to the largest of the guides, m or rad
/// @returns whether every guide is kept to its tolerance
bool move_wheelsets(const Model& model, const Stage& stage, State& s, Workspace& w,
                    const Coupling& c, double& violation) noexcept;

/// Whether a wheel that now meets its rail will leave it within 10 steps (impact.h). The rail
/// counts as rigid (a compliant one holds the wheel for longer), and the mass is the smaller of
/// those at the wheel alone and together with the other wheel of the set.
bool tread_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                ContactId wheel) noexcept;

}  // namespace railstep
