#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// Flanges in a step's coupled problem: their contacts follow those of all wheels. Responses of the
// track and the wheelset to a flange force are found as for a tread. Residual flexibility is
// neglected at flanges.

/// Finds the contacts of all flanges where the forces of the step act, as for treads.
/// @param later  s; irregularities are those at this time after the configuration's
void locate_flanges(const Model& model, const State& s, const Workspace& w, double later,
                    Coupling& c) noexcept;

/// Laws of the flanges over the step. The motion along the rail adds to a damper's speed
/// (damper.h).
void find_flange_laws(const Model& model, const State& s, const Workspace& w, Coupling& c) noexcept;

/// As tread_impact_is_unresolved(), for the mass that acts at the flange alone.
bool flange_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                 ContactId contact) noexcept;

}  // namespace railstep
