#pragma once
#include <array>
#include <limits>
#include <vector>

namespace railstep {

/// A bolted joint: a rail is cut at a border of its elements, and fishplates hold its two ends by
/// springs and dampers on the motion of one end over the other, at the rail's axis. A stiffness
/// that is infinite lets both ends share that motion; all others of the section (its own strains)
/// are free at both ends. Where its gap closes, the ends are in contact along x at the axis: a
/// one-sided spring (fixed_port.h). A rail that does not move along x has no such spring.
struct RailJoint {
  double x = 0.;                               // along the rail, m
  std::array<bool, 2> rails{true, true};       // cut: left, right
  std::array<double, 3> stiffness{};           // along x, y, z, N/m
  std::array<double, 3> damping{};             // N s/m
  std::array<double, 3> rotation_stiffness{};  // twist, vertical bending, lateral bending, N m/rad;
                                               // that of twist is finite
  std::array<double, 3> rotation_damping{};    // N m s/rad
  double end_stiffness = 0.;                   // of two ends in contact, N/m; 0: they never meet
  double end_damping = 0.;                     // N s/m
  std::array<double, 2> gap{};        // between the ends of left and right rail at rest, m;
                                      // closed by heat: -end_force / end_stiffness
  std::array<double, 2> end_force{};  // compression of the ends by heat at rest, N

  bool operator==(const RailJoint&) const = default;
};

struct Track;

/// The node at which a joint stands. Throws Refused at a place that is not a border of two
/// elements, and at an end of the rail.
int joint_node(const Track& track, const RailJoint& joint);

/// The joint of a rail at a node, or null. @param rail  0 left, 1 right
const RailJoint* joint_at(const Track& track, int rail, int node);

/// Throws Refused on joints that the track cannot have.
void check_joints(const Track& track);

/// Compression, N, of rails that heat makes longer between two ends that hold them, where their
/// seats let them slide:
///   P = (growth - sum of gaps)/(L/EA + sum of 1/k),   0 where the gaps have room.
/// It is the same all along, and where it is above 0 every gap is closed.
/// @param growth  of all rails, free, m
/// @param flexibility  L/EA, m/N
/// @param joints  gap, m, and end_stiffness, N/m, of each; one whose ends never meet: 0
struct HeatedGap {
  double gap, end_stiffness;
};
double compression_by_heat(double growth, double flexibility, const std::vector<HeatedGap>& joints);

/// The joints whose ends heat closes, each with a spring of that stiffness in place of the ends.
void join_closed_ends(Track& track);

}  // namespace railstep
