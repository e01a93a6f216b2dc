#pragma once
#include "online/contact/coupling.h"
#include "online/model/progress.h"

namespace railstep {

/// Configuration on which the contacts of a step are located.
inline Configuration located_on(const Model& model, const State& s, const Workspace& w) noexcept {
  return {w.scaled, {s.u, s.v}, track_offset(model, s.steps + 1)};
}

/// Solves banded lines for their own right-hand side (in workspace.solved), and for each wheel the
/// lines that it acts on for a unit force there (unit[wheel]). On condensed lines the force is held
/// over the step. It stores the displacement of the lines under each wheel when located.
void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept;

/// Displacement of the track under wheel `i` by a unit force at wheel `j`, at the step's end.
double track_compliance(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                        ContactId j) noexcept;

/// Displacement under wheel `i` by displacements `re` and, if condensed, `im` of the lines,
/// [line_unknowns].
double track_under(const Model& model, const Workspace& w, const Coupling& c, ContactId i,
                   const double* re, const double* im) noexcept;

/// Displacement under wheel `i` without contact forces, since the contact was located.
double track_motion(const Model& model, const Workspace& w, const Coupling& c,
                    ContactId i) noexcept;

/// Displacements of the track under the wheel forces: the free ones plus the response to each
/// force.
void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept;

}  // namespace railstep
