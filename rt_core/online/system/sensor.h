#pragma once
#include "online/model/state.h"

namespace railstep {

/// A point's motion, ground axes.
struct PointMotion {
  double position[3];      // m
  double velocity[3];      // m/s
  double acceleration[3];  // m/s2
};

/// Motion of a system's sensor in a state.
PointMotion sensor_motion(const Model& model, const State& state, std::int32_t sensor) noexcept;

/// In the energy-momentum scheme forces and accelerations are those of the last step's middle.
/// Action of one joint's rows or springs on part B in a state: the resulting force, and the moment
/// about the joint's point on B, ground axes, N and N m.
struct JointForce {
  double force[3];
  double moment[3];
};
JointForce joint_force(const Model& model, const State& state, std::int32_t joint) noexcept;

}  // namespace railstep
