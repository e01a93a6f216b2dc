#pragma once
#include "online/step/external.h"

namespace railstep {

/// A step up to the right-hand sides of banded lines, or condensed ones without wheels at its end;
/// of what states have in common (workspace.common) what an earlier one found is taken.
/// @param external  [external_wheels] overwritten
void begin_step(const Model& model, State& state, Workspace& w, Outputs& outputs,
                ExternalContact* external) noexcept;

/// The rest of it. Of states side by side, the banded lines must be solved for.
void end_step(const Model& model, State& state, Workspace& w, Outputs& outputs) noexcept;

/// Before a frame's first step and after its last one.
/// @param last  what was published before, overwritten
void begin_frame(const Model& model, const State& state, Outputs& outputs, Outputs& last) noexcept;
void end_frame(const Model& model, State& state, const Workspace& w, const Outputs& last,
               Outputs& outputs) noexcept;

}  // namespace railstep
