#pragma once
#include <memory>
#include <vector>

#include "offline/condense/basis.h"
#include "offline/receptance/receptance.h"

namespace railstep {

/// Static error of one line of a model in a transfer: G_exact - G_model, [reads], m/N, which acts
/// as massless springs in series with the model. Exact is the line with every element divided so
/// that the points of the transfer are at ends of the parts, where an element is exact, or into
/// kMostParts if no division puts them there. The weights of rails in the line are in. 0 for a line
/// that has a free rigid mode, which has no static answer.
/// @param basis  of the condensed line; null: the line as it stands
Eigen::VectorXd residual_statics(const Track& track, const Line& line, const Basis* basis,
                                 const Transfer& transfer);

/// A part is then 1/64 of an element: a point force inside it misses 1/64 of what it misses inside
/// an element, since that error is of the first order in the length (shear).
inline constexpr int kMostParts = 64;

}  // namespace railstep
