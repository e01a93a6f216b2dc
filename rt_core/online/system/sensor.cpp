#include "online/system/sensor.h"

#include "online/math/float_mode.h"
#include "online/system/marker.h"
#include "online/system/rotation.h"
#include "online/system/row.h"

namespace railstep {

namespace {

constexpr int kMostBodies = kMaxSystemParts;

/// Rotations of all bodies; a system has few.
struct Rotations {
  double of[kMostBodies][9];
  Rotations(const SystemModel& s, const State& state) noexcept {
    for (std::int32_t b = 0; b < s.bodies; ++b) rotation_matrix(state.quaternion + 4 * b, of[b]);
  }
};

Motions motions_of(const SystemModel& s, const State& state, const Rotations& rotations) noexcept {
  return {state.u + s.first, state.v + s.first, state.g + s.first, rotations.of[0]};
}

MarkerPose pose_of(const MarkerJet& jet) noexcept {
  MarkerPose pose;
  for (int c = 0; c < 3; ++c) {
    pose.point[c] = jet.point[c].x;
    for (int k = 0; k < 3; ++k) pose.axis[k][c] = jet.axis[k][c].x;
  }
  return pose;
}

// Never inlined, as sum_of_rows(): none of their arithmetic may move out of the mode that their
// callers set.
[[gnu::noinline]] PointMotion point_motion(const Model& model, const State& state,
                                           std::int32_t sensor) noexcept {
  const SystemModel& s = model.system;
  const Rotations rotations(s, state);
  const MarkerJet jet = marker_jet(s, s.marker[s.sensor[sensor]], motions_of(s, state, rotations));
  PointMotion motion;
  for (int c = 0; c < 3; ++c) {
    motion.position[c] = jet.point[c].x;
    motion.velocity[c] = jet.point[c].v;
    motion.acceleration[c] = jet.point[c].a;
  }
  return motion;
}

[[gnu::noinline]] JointForce sum_of_rows(const Model& model, const State& state,
                                         std::int32_t joint) noexcept {
  const SystemModel& s = model.system;
  const Rotations rotations(s, state);
  const Motions at = motions_of(s, state, rotations);
  const double time = static_cast<double>(state.steps) * model.scheme.dt;
  JointForce sum{};
  for (std::int32_t r = 0; r < system_rows(s); ++r) {
    const RowModel& row = s.row[r];
    if (row.joint != joint) continue;
    const MarkerPose a = pose_of(marker_jet(s, s.marker[row.a], at));
    const MarkerPose b = pose_of(marker_jet(s, s.marker[row.b], at));
    MarkerGradient on_a, on_b;
    const double motion = row.motion >= 0 ? motion_at(s, row.motion, time).x : row.offset;
    row_gradient(row, a, b, row_length(a, b), motion, on_a, on_b);
    for (int c = 0; c < 3; ++c) sum.force[c] -= state.row_force[r] * on_b.point[c];
    for (int k = 0; k < 3; ++k) {
      double moment[3];
      cross(b.axis[k], on_b.axis[k], moment);
      for (int c = 0; c < 3; ++c) sum.moment[c] -= state.row_force[r] * moment[c];
    }
  }
  return sum;
}

}  // namespace

PointMotion sensor_motion(const Model& model, const State& state, std::int32_t sensor) noexcept {
  const FloatMode flushed_to_zero;
  return point_motion(model, state, sensor);
}

JointForce joint_force(const Model& model, const State& state, std::int32_t joint) noexcept {
  const FloatMode flushed_to_zero;
  return sum_of_rows(model, state, joint);
}

}  // namespace railstep
