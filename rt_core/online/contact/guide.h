#pragma once
#include "online/contact/coupling.h"

namespace railstep {

// The guides of wheelsets in a step's coupled problem.

/// Motion of each wheelset without contact and without its multipliers, Coupling::wheelset.
/// @param time  s; at which the equations of bodies hold
void free_wheelsets(const Model& model, const Stage& stage, double time, const State& s,
                    const Workspace& w, Coupling& c) noexcept;

/// Largest number of iterations of the guides' augmented Lagrangian around the contacts.
std::int32_t guide_iterations(const Model& model) noexcept;

/// Moves the wheelsets without contact under their multipliers, in `solved`.
void take_multipliers(const Model& model, const State& s, const Coupling& c, Workspace& w) noexcept;

/// Corrects the guides' multipliers after a solve of all contacts, whose forces are not in
/// `solved`.
/// @param violation  raised to the largest of the guides, m or rad
/// @returns whether every guide is kept to its tolerance
bool correct_multipliers(const Model& model, const Stage& stage, State& s, const Workspace& w,
                         const Coupling& c, double& violation) noexcept;

}  // namespace railstep
