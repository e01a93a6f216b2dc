#pragma once
#include "online/contact/coupling.h"

namespace railstep {

/// Displacements of the track under each wheel by a unit force at each other, at the step's end:
/// the lower triangle of W, j <= i.
void track_compliance(const Model& model, const Workspace& w, Coupling& c) noexcept;

}  // namespace railstep
