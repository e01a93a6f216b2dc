#pragma once
#include <vector>

#include "offline/system/multibody.h"
#include "offline/track/track.h"
#include "online/model/system.h"

namespace railstep {

/// A system's model while it is put together; its arrays are what the model's views look into.
struct SystemParts {
  std::vector<RigidBodyModel> bodies;
  std::vector<BeamChainModel> beams;
  std::vector<RailPortModel> ports;
  std::vector<MarkerModel> markers;
  std::vector<RowModel> joint_rows, spring_rows;
  std::vector<MotionModel> motions;
  std::vector<PointForceModel> forces;
  std::vector<std::int32_t> sensors;
  std::vector<RowModel> rows;  // of joints, then of springs
  std::vector<EndModel> ends;
  std::vector<std::int32_t> part_end;
  std::vector<double> piece_start, piece;  // of motions: [pieces], [pieces][kMotionCoefficients]
  std::vector<std::int32_t> held;          // of beams, each from its own first unknown
  std::vector<double> sensor_rest;         // [sensors][3] m
  std::vector<double> constant_force, per_length, beam_rest;  // [unknowns]
  std::int32_t unknowns = 0;

  /// Makes room for all unknowns, in whole panels.
  void pad();
};

/// Bodies and beams: unknowns, inertia, weight. Throws Refused.
void add_parts(const System& system, SystemParts& parts);

/// Motion, markers and rows of joints, springs, forces and sensors. Throws Refused.
/// @param track  beside which the system stands, or null
void add_connections(const System& system, const Track* track, SystemParts& parts);

/// Velocity of every unknown at the start, [unknowns].
std::vector<double> start_velocities(const System& system, const SystemParts& parts);

}  // namespace railstep
