#pragma once
// Vectors of scenes of bodies and beams. Only scene*.cpp include this.
#include <Eigen/Core>
#include <string_view>

#include "text/read.h"

namespace railstep {

inline const Range kPlace = between(-1e4, 1e4);     // m
inline const Range kVelocity = between(-1e4, 1e4);  // m/s
inline const Range kTurning = between(-1e5, 1e5);   // rad/s

/// A vector [x, y, z].
Eigen::Vector3d read_vector(const Table& t, std::string_view key, const Range& accepted);
/// A vector that has y = 0 in planar systems. Where the key is absent: `otherwise`.
Eigen::Vector3d read_in_plane(const Table& t, std::string_view key, const Range& accepted,
                              bool planar);
Eigen::Vector3d read_in_plane(const Table& t, std::string_view key, const Range& accepted,
                              bool planar, const Eigen::Vector3d& otherwise);
/// A turn or a rate of turn: x = z = 0 in planar systems.
Eigen::Vector3d read_turn(const Table& t, std::string_view key, const Range& accepted, bool planar,
                          const Eigen::Vector3d& otherwise);
/// A direction of any length but 0, made a unit vector; in planar systems y = 0.
Eigen::Vector3d read_direction(const Table& t, std::string_view key, bool planar);
/// A unit axis of turns: along +y in planar systems, which is then the default.
Eigen::Vector3d read_turn_axis(const Table& t, std::string_view key, bool planar);
/// Refuses two unit vectors that are not square to each other within 1e-9, the rounding of
/// decimals.
void check_square(const Table& t, std::string_view key, const Eigen::Vector3d& a,
                  std::string_view other, const Eigen::Vector3d& b);

}  // namespace railstep
