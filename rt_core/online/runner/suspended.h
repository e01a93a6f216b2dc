#pragma once
#include "online/model/state.h"

namespace railstep {

/// Displacements of suspended bodies at a stage's end, without what acts at their interfaces:
///   (s K + s kv C + kg M) q = M kg u* + C (s (kv u* - v*) - (1 - s) v0) - (1 - s) K u0 + rest
///                             + forces of tables and inputs at the fraction s + other forces.
/// @param time   s; of that fraction of the stage
/// @param from   [size] displacements from which all others count, which strain nothing; null: 0
/// @param force  [size] other forces, N and N m; overwritten
/// @param u      [size] out
void move_freely(const Model& model, const SuspendedModel& bodies, double time, const State& s,
                 const Workspace& w, const double* from, double* force, double* u) noexcept;

}  // namespace railstep
