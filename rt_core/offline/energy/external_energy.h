#pragma once
#include <vector>

#include "online/contact/external.h"

namespace railstep {

/// External wheels as they act on the track in the step between two states: placed on the first by
/// the inputs of the second.
std::vector<ExternalContact> external_in_step(const Model& model, const State& before,
                                              const State& after);

/// Work of their forces in a step, on what the track's unknowns move under them, J: by the mean of
/// this step's forces and those of the step before, or of this step's where they are held over it.
/// What they do on the residual flexibility is left out, as it is kept there and given back.
/// @param last   of the step before, where they acted then; empty at the start
/// @param moved  change of the state in the step
double external_work(const Model& model, const std::vector<ExternalContact>& last,
                     const std::vector<ExternalContact>& now, const Configuration& moved);

}  // namespace railstep
