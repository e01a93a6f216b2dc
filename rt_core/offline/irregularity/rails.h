#pragma once
#include <array>

#include "offline/irregularity/spectrum.h"
#include "offline/irregularity/spline.h"

namespace railstep {

/// How far each rail lies off its design line, m: sideways (left positive) and up.
struct RailSignals {
  std::array<Signal, 2> y, z;  // of the left and the right rail
};

/// Rails of a track's geometry: z = vertical +- cross_level / 2, y = alignment +- gauge / 2, plus
/// for the left. A geometry without coefficients is straight.
/// @param geometry  by Geometry; those with coefficients have the same start, step and count
/// Throws Refused if they do not.
RailSignals rails_of(const std::array<Signal, kGeometries>& geometry);

}  // namespace railstep
