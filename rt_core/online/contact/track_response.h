#pragma once
#include "online/contact/coupling.h"
#include "online/model/progress.h"

namespace railstep {

/// Configuration on which the contacts of a step are located.
inline Configuration located_on(const Model& model, const State& s, const Workspace& w) noexcept {
  return {w.scaled, {s.u, s.v}, track_offset(model, s.steps + 1)};
}

/// Response of a line to a unit force: real and imaginary part of its modes; or, with the line's
/// matrix L D L' of a step, L^-1 and D^-1 L^-1 of the force's row, which are 0 outside `panels`.
/// Both point to the first unknown of all lines.
struct LineResponse {
  Panels panels;
  const double *first, *second;
};

// Contacts and seats of wheels touch the track along rows (contact_id.h), with forces against them.
// On banded lines all of a step take one solve, S = L D L'. Forward, L^-1 of the track's
// right-hand side and of each row r give all that the contacts need: S^-1 b along a row
// is (L^-1 r) . (D^-1 L^-1 b), a sum over the few panels to which L^-1 carries r. Their
// forces are added to D^-1 L^-1 b, and one solve backward gives the displacements.

/// Solves banded lines forward for their own right-hand side (in workspace.solved), and for each
/// wheel the lines that it acts on for a unit force there. On condensed lines the force is held
/// over the step. It stores the displacement of the lines under each wheel when located, and on
/// condensed lines that without contact forces.
void respond(const Model& model, const State& s, Workspace& w, Coupling& c) noexcept;

/// Displacement of line `l`, which forces along a base move, along it by a response of the line.
double line_compliance(const Model& model, const Workspace& w, const Coupling& c, int base,
                       std::int32_t l, const LineResponse& by) noexcept;

/// The same of lines that are displaced by `re`, condensed ones by `re` and `im`, [unknowns].
double shape_under(const Model& model, const Workspace& w, const Coupling& c, int base,
                   std::int32_t l, const double* re, const double* im) noexcept;

/// Finds the displacements without contact forces since the contacts were located, Coupling::moved.
void find_track_motion(const Model& model, const Workspace& w, Coupling& c) noexcept;

/// Adds the wheel forces to the track without them.
void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept;

/// Displacements of banded lines, by the solve backward; after all forces.
void finish_track(const Model& model, Workspace& w) noexcept;

}  // namespace railstep
