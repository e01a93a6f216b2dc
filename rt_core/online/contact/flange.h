#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Flanges in a step's coupled problem: contacts behind those of all wheels. What a force at one
// does to the track and the wheelset is found as that of a tread is; it neither makes nor feels
// residual displacements.

/// Contacts of all flanges where the forces of the step act, as of the treads.
/// @param later  s, by how much the irregularities under them are those of a later time
void locate_flanges(const Model& model, const State& s, const Workspace& w, double later,
                    Coupling& c) noexcept;

/// Laws of the flanges over the step. To a damper's speed (damper.h) the way along a rail adds.
void find_flange_laws(const Model& model, const State& s, const Workspace& w, Coupling& c) noexcept;

/// As tread_impact_is_unresolved() of treads, for the mass that the flange has alone.
bool flange_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                 ContactId contact) noexcept;

}  // namespace railstep
