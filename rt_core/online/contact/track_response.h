#pragma once
#include "online/contact/coupling.h"
#include "online/model/progress.h"

namespace railstep {

/// Configuration at which the contacts of a step are located.
inline Configuration located_on(const Model& model, const State& s, const Workspace& w) noexcept {
  return {w.scaled, {s.u, s.v}, track_offset(model, s.steps + 1)};
}

/// Solves banded lines for their own right-hand side (in workspace.solved) and the lines that a
/// wheel acts on for a unit force there (unit[wheel]); of condensed lines the force is held over
/// the step. Notes where the lines were located under each wheel.
void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept;

/// Displacement under wheel `i` of the track moved by unit forces at wheel `j`, at the step's end.
double track_compliance(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                        ContactId j) noexcept;

/// Displacement under wheel `i` where the lines are moved by `re` and, condensed, `im`;
/// [line_unknowns].
double track_under(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                   const double* re, const double* im) noexcept;

/// Displacement under wheel `i`, without contact forces, from where the contact was located.
double track_motion(const Model& model, const Workspace& w, const Coupling& c,
                    ContactId i) noexcept;

/// Displacements of the track under the wheel forces: free, and what each force adds.
void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept;

}  // namespace railstep
