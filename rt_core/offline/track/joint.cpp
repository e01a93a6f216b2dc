#include "offline/track/joint.h"

#include <cmath>
#include <set>
#include <utility>

#include "offline/math/refuse.h"
#include "offline/track/assembly.h"

namespace railstep {

namespace {

constexpr double kOnBorder = 1e-9;  // of an element, tolerance for decimal lengths

constexpr int kVertical = 6, kLateral = 3;  // b_x, a_x: slopes of bending

/// Motion of the rail's end ahead over the one behind, in unknown k of the node.
Row jump(const Line& line, int rail, int node, int k, double factor) {
  Row row;
  const int behind = line.unknown(rail, node, k), ahead = line.unknown_ahead(rail, node, k);
  if (behind == ahead) return row;  // shared
  const double signed_factor = sign_of(line, 0, k) * factor;
  push(row, ahead, signed_factor);
  push(row, behind, -signed_factor);
  return row;
}

bool is_shared(const RailJoint& joint, int k) {
  if (k < 3) return std::isinf(joint.stiffness[static_cast<std::size_t>(k)]);
  if (k == kVertical) return std::isinf(joint.rotation_stiffness[1]);
  return k == kLateral && std::isinf(joint.rotation_stiffness[2]);
}

void add_spring(Assembly& part, const Row& row, double stiffness, double damping) {
  if (row.empty()) return;
  Assembly::add(part.stiffness, row, stiffness);
  Assembly::add(part.damping, row, damping);
}

}  // namespace

int joint_node(const Track& track, const RailJoint& joint) {
  const double place = joint.x / track.element_length(), border = std::round(place);
  if (!(std::fabs(place - border) <= kOnBorder))
    refuse("E-TRACK-06",
           "a rail is cut inside an element; expected a joint at a border of two elements");
  if (border < 1. || border > track.elements() - 1.)
    refuse("E-TRACK-07", "a rail is cut at its end; expected a joint between its ends");
  return 2 * static_cast<int>(border);
}

const RailJoint* joint_at(const Track& track, int rail, int node) {
  for (const RailJoint& joint : track.joints)
    if (joint.rails[static_cast<std::size_t>(rail)] && joint_node(track, joint) == node)
      return &joint;
  return nullptr;
}

void check_joints(const Track& track) {
  std::set<std::pair<int, int>> cut;
  for (const RailJoint& joint : track.joints) {
    for (int rail = 0; rail < track.rails; ++rail)
      if (joint.rails[static_cast<std::size_t>(rail)] &&
          !cut.insert({rail, joint_node(track, joint)}).second)
        refuse("E-TRACK-08", "a rail has two joints at one place; expected one");
    for (const auto* values :
         {&joint.stiffness, &joint.damping, &joint.rotation_stiffness, &joint.rotation_damping})
      for (const double value : *values)
        if (!(value >= 0.))
          refuse("E-TRACK-09",
                 "the stiffness or the damping of a joint is negative; expected 0 or more");
    const bool opens = std::isfinite(joint.end_stiffness) && joint.end_stiffness >= 0. &&
                       joint.end_damping >= 0. && std::isfinite(joint.stiffness[0]);
    if ((joint.end_stiffness != 0. || joint.end_damping != 0.) && !opens)
      refuse("E-TRACK-10",
             "rail ends that meet at a joint have a negative or infinite stiffness or damping, or "
             "share their motion along x; expected finite values of 0 or more, and ends that move "
             "apart");
    for (const std::size_t side : {0u, 1u})
      if (!(joint.end_force[side] >= 0.) ||
          (joint.end_force[side] > 0. && joint.end_stiffness == 0.))
        refuse("E-TRACK-11",
               "rail ends are pressed together without a stiffness; expected an end stiffness "
               "above 0");
    if (std::isinf(joint.rotation_stiffness[0]))
      refuse("E-TRACK-12",
             "the stiffness of a joint against twist is infinite; expected a finite value");
  }
  if (track.state && !track.joints.empty())
    refuse("E-TRACK-13",
           "a rail with joints cannot be linearised under its weight; expected it at rest");
}

void number_cut(const Track& track, Assembly& part, int rail, int node) {
  const RailJoint* joint = joint_at(track, rail, node);
  if (joint == nullptr) return;
  auto& ahead = part.line.cuts[static_cast<std::size_t>(rail)][node];
  for (int k = 0; k < 9; ++k) {
    const int behind = part.line.unknown(rail, node, k);
    if (part.line.rigid_section && k == 7) continue;  // one unknown with 5
    ahead[static_cast<std::size_t>(k)] = behind < 0 || is_shared(*joint, k) ? behind : part.count++;
  }
  if (part.line.rigid_section) ahead[7] = ahead[5];
}

void add_joints(const Track& track, Assembly& part, int rail) {
  for (const RailJoint& joint : track.joints) {
    if (!joint.rails[static_cast<std::size_t>(rail)]) continue;
    const int node = joint_node(track, joint);
    const auto row = [&](int k, double factor) { return jump(part.line, rail, node, k, factor); };
    if (joint.end_stiffness > 0.) Assembly::tie(part.stiffness, row(0, 1.));
    for (std::size_t d = 0; d < 3; ++d)
      add_spring(part, row(static_cast<int>(d), 1.), joint.stiffness[d], joint.damping[d]);
    Row twist = row(5, .5);  // (a_z - b_y)/2
    for (const auto& term : row(7, -.5)) twist.push_back(term);
    add_spring(part, twist, joint.rotation_stiffness[0], joint.rotation_damping[0]);
    add_spring(part, row(kVertical, 1.), joint.rotation_stiffness[1], joint.rotation_damping[1]);
    add_spring(part, row(kLateral, 1.), joint.rotation_stiffness[2], joint.rotation_damping[2]);
  }
}

double compression_by_heat(double growth, double flexibility,
                           const std::vector<HeatedGap>& joints) {
  double gaps = 0.;
  for (const HeatedGap& joint : joints) {
    if (joint.end_stiffness == 0.) return 0.;
    gaps += joint.gap;
    flexibility += 1. / joint.end_stiffness;
  }
  return growth > gaps ? (growth - gaps) / flexibility : 0.;
}

void join_closed_ends(Track& track) {
  for (RailJoint& joint : track.joints) {
    if (joint.end_force[0] + joint.end_force[1] == 0.) continue;
    joint.stiffness[0] += joint.end_stiffness;
    joint.damping[0] += joint.end_damping;
    joint.end_stiffness = joint.end_damping = 0.;
    joint.gap = joint.end_force = {};
  }
}

}  // namespace railstep
