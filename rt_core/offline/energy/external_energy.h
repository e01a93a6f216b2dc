#pragma once
#include <vector>

#include "online/contact/external.h"

namespace railstep {

/// External wheels as they act on the track in the step between two states: the inputs of the
/// second state place them on the first.
std::vector<ExternalContact> external_in_step(const Model& model, const State& before,
                                              const State& after);

/// Work of their forces in a step on the displacements of the track's unknowns, J, by the mean of
/// the forces of this step and of the step before, or by this step's if forces are held over it.
/// Work on the residual flexibility is left out, as it is stored there and given back.
/// @param last   the wheels in the step before; empty at the start
/// @param moved  change of the state in the step
double external_work(const Model& model, const std::vector<ExternalContact>& last,
                     const std::vector<ExternalContact>& now, const Configuration& moved);

}  // namespace railstep
