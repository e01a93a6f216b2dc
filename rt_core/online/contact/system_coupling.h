#pragma once
#include "online/contact/runner_coupling.h"
#include "online/system/system_step.h"

namespace railstep {

// A system of bodies whose joints and springs hold rails, beside contacts and one-sided springs.
// Both move the same lines. Contacts take the system as linear about its present iterate, which
// changes W and their free motion. The system then takes the contacts' forces as they are, and what
// is left of its forces against their prediction moves the contacts again.

/// Most solves of the contacts in a step.
inline constexpr int kSystemPasses = 8;

/// Whether a step couples a system with contacts.
inline bool couples_system(const Model& model) noexcept {
  return model.system.ports > 0 && port_count(model) > 0;
}

/// Solves the system under the contacts' forces of the last step, and adds its part to W and to the
/// free motion of the contacts. All of Coupling but the runners must be known.
/// @param result  of the system's solve, with the most iterations of all in the step
void couple_system(const Model& model, State& state, Workspace& workspace, Coupling& c,
                   SystemResult& result) noexcept;

/// Solves the system under the present forces of the contacts. Moves the contacts, and the seats of
/// runners if there are any, by the part of its forces that was not predicted.
/// @returns whether this part is negligible
bool settle_system(const Model& model, State& state, Workspace& workspace, Coupling& c,
                   CoupledRunners* runners, SystemResult& result) noexcept;

}  // namespace railstep
