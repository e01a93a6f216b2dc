#pragma once
#include "offline/system/pack_parts.h"

namespace railstep {

/// Adds a marker on a part, and on a rail the port that carries it. Throws Refused if the part does
/// not exist or the point is not on it.
/// @param track  the track beside the system, or null
/// @param point  m, in the global axes
/// @param axes   columns: the marker's directions
/// @returns index of the marker
std::int32_t place_marker(const System& system, const Track* track, const Part& part,
                          const Eigen::Vector3d& point, const Eigen::Matrix3d& axes,
                          SystemParts& parts);

}  // namespace railstep
