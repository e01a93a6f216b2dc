#include "build/build_joints.h"

namespace railstep {
namespace {

/// Compression of a rail by heat, N. Heat closes all joints of a rail or none:
/// scene_rail_joints.cpp refuses the cases between.
double compression_of(const Scene& scene, std::size_t side, double area,
                      const std::vector<RailJoint>& joints) {
  const RailScene& own = side == 1 && scene.right_rail ? *scene.right_rail : scene.rail;
  std::vector<HeatedGap> gaps;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].rails[side])
      gaps.push_back({scene.joint_gaps[i].cold.value_or(0.), joints[i].end_stiffness});
  if (gaps.empty()) return 0.;
  const double length = scene.track.length();
  return compression_by_heat(own.expansion * own.temperature_rise * length,
                             length / (own.young * area), gaps);
}

}  // namespace

HeatedJoints heated_joints(const Scene& scene, const std::array<double, 2>& areas,
                           const std::array<double, 2>& heights) {
  HeatedJoints heated{scene.joints, {}};
  for (std::size_t i = 0; i < heated.joints.size(); ++i) {
    const JointGap& gap = scene.joint_gaps[i];
    if (!gap.cold) continue;
    heated.joints[i].end_stiffness =
        gap.end_stiffness.value_or(scene.rail.young * areas[0] / heights[0]);
    heated.joints[i].end_damping = gap.end_damping;
  }
  for (std::size_t side = 0; side < static_cast<std::size_t>(scene.track.rails); ++side) {
    const double pressed = compression_of(scene, side, areas[side], heated.joints);
    heated.compression[side] = pressed;
    for (std::size_t i = 0; i < heated.joints.size(); ++i) {
      RailJoint& joint = heated.joints[i];
      if (!joint.rails[side] || joint.end_stiffness == 0.) continue;
      joint.end_force[side] = pressed;
      joint.gap[side] = pressed > 0. ? -pressed / joint.end_stiffness
                                     : *scene.joint_gaps[i].cold - scene.joint_gaps[i].grown[side];
    }
  }
  if (scene.track.rails == 1)
    for (RailJoint& joint : heated.joints) {
      joint.end_force[1] = joint.end_force[0];
      joint.gap[1] = joint.gap[0];
    }
  return heated;
}

}  // namespace railstep
