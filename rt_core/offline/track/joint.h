#pragma once
#include <array>

namespace railstep {

/// A bolted joint: a rail is cut at a border of its elements, and fishplates hold its two ends by
/// springs and dampers on what one end does over the other, at the rail's axis. A stiffness that is
/// infinite lets both ends share that motion; all others of the section (its own strains) are free
/// at both ends.
struct RailJoint {
  double x = 0.;                           // along the rail, m
  std::array<bool, 2> rails{true, true};   // cut: left, right
  std::array<double, 3> stiffness{};       // along x, y, z, N/m
  std::array<double, 3> damping{};         // N s/m
  std::array<double, 3> turn_stiffness{};  // twist, vertical bending, lateral bending, N m/rad;
                                           // that of twist is finite
  std::array<double, 3> turn_damping{};    // N m s/rad

  bool operator==(const RailJoint&) const = default;
};

struct Track;

/// The node at which a joint stands. Throws std::invalid_argument at a place that is no border of
/// two elements, and at an end of the rail.
int joint_node(const Track& track, const RailJoint& joint);

/// The joint of a rail at a node; none: null. @param rail  0 left, 1 right
const RailJoint* joint_at(const Track& track, int rail, int node);

/// Throws std::invalid_argument on joints that the track cannot have.
void check_joints(const Track& track);

}  // namespace railstep
