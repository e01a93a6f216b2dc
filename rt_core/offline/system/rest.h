#pragma once
#include <functional>
#include <memory>
#include <vector>

namespace railstep {

class PackedSystem;

/// Where a system and its track stand still.
struct Rest {
  std::vector<double> u;           // [unknowns] displacements; turns are in the quaternions
  std::vector<double> v;           // [unknowns] of the shape that moving loads carry along
  std::vector<double> quaternion;  // [bodies][4]
  std::vector<double> row_force;   // [rows] N
};

/// A load of the track on its way: m, m/s, m.
struct PathOfLoad {
  double start, speed, length;
};

/// The same system by backward Euler with steps of dt, loads where they are `shift` seconds later.
using StillSystem = std::function<std::unique_ptr<PackedSystem>(double dt, double shift)>;

/// Static equilibrium at t = 0, from where the parts are given: steps of backward Euler from rest
/// with time held, whose fixed point is the equilibrium whatever the step; velocities are kept
/// while kinetic energy grows and dropped where it falls (kinetic damping, Cundall 1976), so that
/// slow motions arrive too. Steps lengthen while Newton's method bears it. It ends where a step
/// from rest has no acceleration over 1e-9 m/s2 (rad/s2), or moves by round-off alone. Throws
/// Refused, naming what moves most, where that is not found.
Rest find_rest(const StillSystem& make, const std::vector<PathOfLoad>& loads);

}  // namespace railstep
