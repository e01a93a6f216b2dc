#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Wheelsets in a step's coupled problem, on their treads and flanges (model/contact_id.h).

/// Where each wheelset goes without contact, and its compliance. A coordinate on Baumgarte's guide
/// has none: g = x'' - 2 alpha (v - x') - beta^2 (u - x) at the step's end.
void free_wheelsets(const Model& model, const Stage& stage, const State& s, const Workspace& w,
                    Coupling& c) noexcept;

/// What a unit force at contact j adds to the approach of contact i through a wheelset that carries
/// both.
double wheelset_compliance(const Model& model, const Coupling& c, ContactId i,
                           ContactId j) noexcept;

/// Penetration that frozen geometry and the wheelset's place at the step's start leave of contact
/// i: what the coordinates at the step's end take off is left out.
double wheelset_offset(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                       ContactId i) noexcept;

/// How far contact i goes from its rail over the step without contact forces.
double free_lift(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept;

/// How far contact i was from its rail at the step's start, in the step's geometry.
double wheelset_lift_before(const Model& model, const State& s, const Coupling& c,
                            ContactId i) noexcept;

/// Most iterations of the guides' augmented Lagrangian around the contacts.
std::int32_t guide_iterations(const Model& model) noexcept;

/// Moves the wheelsets under the contact forces and corrects the guides' multipliers.
/// @param violation  raised to the largest of the guides, m or rad
/// @returns whether every guide is kept to its tolerance
bool move_wheelsets(const Model& model, const Stage& stage, State& s, Workspace& w,
                    const Coupling& c, double& violation) noexcept;

/// Whether a wheel that closes now on its rail will have left it within 10 steps (impact.h), with
/// the rail taken as rigid (a compliant one holds the wheel for longer)
/// and the smaller of the masses that the wheel has alone and together with the set's other one.
bool tread_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                ContactId wheel) noexcept;

}  // namespace railstep
