#pragma once
#include <type_traits>

#include "online/model/system.h"

namespace railstep {

/// Whether a structure has these fields and no gap, so that it is the same on every machine.
template <typename T>
constexpr bool is_flat(std::size_t words_of_4, std::size_t words_of_8) noexcept {
  return std::is_trivially_copyable_v<T> && words_of_4 % 2 == 0 &&
         sizeof(T) == 4 * words_of_4 + 8 * words_of_8;
}
static_assert(is_flat<RigidBodyModel>(8, 23));
static_assert(is_flat<StraightBeam>(0, 1 + kStraightPreloads + kStraightConstants));
static_assert(is_flat<BeamChainModel>(6, 5 + 1 + kStraightPreloads + kStraightConstants));
static_assert(is_flat<RailPortModel>(4, 12));
static_assert(is_flat<MarkerModel>(4, 15));
static_assert(is_flat<RowModel>(10, 4));
static_assert(is_flat<MotionModel>(2, 0));
static_assert(is_flat<PointForceModel>(4, 3));
static_assert(is_flat<EndModel>(2, 0));

template <typename Archive>
void describe_counts(Archive& a, SystemModel& s) {
  a.count(s.bodies, kMaxSystemParts);
  a.count(s.beams, kMaxSystemParts - s.bodies);
  a.count(s.ports, kMostPorts);
  for (std::int32_t* items : {&s.markers, &s.motions, &s.forces, &s.sensors})
    a.count(*items, kMostSystemItems);
  a.count(s.joint_rows, kMaxSystemRows);
  a.count(s.spring_rows, kMaxSystemRows - s.joint_rows);
  a.count(s.ends, 2 * kMaxSystemRows);
  a.count(s.held, s.unknowns);
  a.count(s.pieces, kMostPieces);
  a.count(s.traced_joints, kMostSystemItems);
  a.count(s.traced_springs, kMostSystemItems);
}

template <typename Archive>
void describe_solve(Archive& a, SystemModel& s) {
  std::int32_t method = static_cast<std::int32_t>(s.constraint_method),
               renew = static_cast<std::int32_t>(s.renew);
  a.count(method, static_cast<std::int32_t>(ConstraintMethod::direct));
  a.count(renew, static_cast<std::int32_t>(Renew::kept));
  s.constraint_method = static_cast<ConstraintMethod>(method);
  s.renew = static_cast<Renew>(renew);
  a.count(s.mean, 1);
  a.count(s.cap, kMostIterations);
  a.count(s.projections, kMostIterations);
  a.count(s.keep_steps, kMostKeptSteps);
  for (double* x : {&s.alpha, &s.beta, &s.tolerance, &s.joint_tolerance, &s.rank_tolerance})
    a.real(*x);
}

/// @param lines     numbers of a port's shape
/// @param unknowns  of the model
template <typename Archive>
void describe(Archive& a, SystemModel& s, std::int64_t lines, std::int32_t unknowns) {
  a.count(s.first, unknowns);
  describe_counts(a, s);
  describe_solve(a, s);
  const std::int64_t ports = std::int64_t{9} * s.ports;
  a.structures(s.body, s.bodies);
  a.structures(s.beam, s.beams);
  a.structures(s.port, s.ports);
  a.structures(s.marker, s.markers);
  a.structures(s.row, s.joint_rows + s.spring_rows);
  a.structures(s.end, s.ends);
  a.integers(s.part_end, s.bodies + s.beams + 2);
  a.structures(s.motion, s.motions);
  a.reals(s.piece_start, s.pieces);
  a.reals(s.piece, std::int64_t{kMotionCoefficients} * s.pieces);
  a.structures(s.force, s.forces);
  a.integers(s.held_unknown, s.held);
  a.reals(s.beam_rest, s.unknowns);
  a.reals(s.constant_force, s.unknowns);
  a.reals(s.per_length, s.unknowns);
  a.reals(s.port_compliance, ports * ports);
  a.reals(s.port_shapes, ports * lines);
  a.integers(s.sensor, s.sensors);
  a.reals(s.sensor_rest, std::int64_t{3} * s.sensors);
  a.integers(s.traced_joint, s.traced_joints);
  a.integers(s.traced_spring, s.traced_springs);
}

}  // namespace railstep
