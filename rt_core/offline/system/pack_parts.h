#pragma once
#include <vector>

#include "offline/system/multibody.h"
#include "offline/track/track.h"
#include "online/model/system.h"

namespace railstep {

/// A system's model while it is built. The model's views look into its arrays.
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

  /// Extends the arrays over all unknowns to whole panels.
  void pad();
};

/// Adds unknowns, inertia and weight of bodies and beams. Throws Refused.
void add_parts(const System& system, SystemParts& parts);

/// Adds motions, markers and rows of joints, springs, forces and sensors. Throws Refused.
/// @param track  the track beside the system, or null
void add_connections(const System& system, const Track* track, SystemParts& parts);

/// Velocity of every unknown at the start, [unknowns].
std::vector<double> start_velocities(const System& system, const SystemParts& parts);

}  // namespace railstep
