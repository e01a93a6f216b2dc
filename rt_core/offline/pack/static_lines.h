#pragma once
#include <vector>

#include "offline/pack/pack.h"
#include "offline/track/statics.h"

namespace railstep {

/// Static displacements of each line of the model, its unknowns or its coordinates if condensed,
/// with what of the track's one-sided springs presses.
std::vector<Eigen::VectorXd> static_lines(const PackedModel& packed, const Statics& statics,
                                          const std::vector<PointForce>& forces, double gravity);

/// Height of a rail's point as the model's lines have it, m; the rest is residual.
double height_of(const Track& track, const PackedModel& packed,
                 const std::vector<Eigen::VectorXd>& lines, const RailPoint& at);

}  // namespace railstep
