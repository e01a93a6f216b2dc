#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "offline/start/start.h"

namespace railstep {

class PackedSystem;

/// Positions and forces of a system and its track at rest.
struct Rest {
  std::vector<double> u;           // [unknowns] displacements; rotations are in the quaternions
  std::vector<double> v;           // [unknowns] of the shape that moves along with the loads
  std::vector<double> quaternion;  // [bodies][4]
  std::vector<double> row_force;   // [rows] N
  std::vector<RailPortModel> port;
  std::vector<double> port_force;      // [9 ports] against the rails, N and N m
  std::vector<double> port_rate = {};  // of these as loads and wheels move along, N/s; or empty
};

/// The same system by backward Euler with steps of dt, with loads and wheels at their places
/// `shift` s later.
using StillSystem = std::function<std::unique_ptr<PackedSystem>(double dt, double shift)>;

/// Static equilibrium at t = 0, searched from the given positions. Steps of backward Euler with
/// time held have the equilibrium as their fixed point, for every step length. Velocities are kept
/// while kinetic energy grows and set to 0 when it falls (kinetic damping, Cundall 1976), so that
/// slow motions arrive too. Steps get longer while Newton's method converges. The search ends when
/// a step from rest has no acceleration above 1e-9 m/s2 (rad/s2), or moves by round-off only.
/// Throws Refused with the name of the part that moves most if no equilibrium is found.
/// @param running  places of loads and wheels on a rail of a length, m
Rest find_rest(const StillSystem& make, const std::vector<StartingPlace>& running, double length);

}  // namespace railstep
