#pragma once
#include "online/model/travel_model.h"

namespace railstep {

inline constexpr int kMaxBodyForces = 4;  // on one wheelset or vehicle

/// A force along a coordinate of a wheelset or a vehicle: a table over time, or an input.
struct BodyForce {
  std::int32_t direction, points;  // the coordinate; rows of the table, 0: input
  const double* table;             // [points][2]  s, N or N m; linear between, constant outside
  std::int32_t input;              // index of the input, or -1
};

/// Rigid bodies on linear springs and dampers, in frames that move along the track,
///   M q'' + C q' + K q = rest + forces of tables and inputs + what acts at their interfaces.
/// Wheelsets and vehicles differ in their interfaces: contacts, and springs that are not linear.
/// The equation holds at the fraction s = held_fraction() of the step.
struct SuspendedModel {
  std::int32_t first, size;           // its coordinates among the state's unknowns
  double start;                       // place of its origin at t = 0, m
  TravelModel travel;                 // of the frames, from start
  const double *mass, *rest;          // [size] diagonal, kg, kg m2; N, N m: preloads less weights
  const double *damping, *stiffness;  // [size][size] symmetric
  const double* inverse;              // [size][size] symmetric, of s K + s kv C + kg M
  std::int32_t forces;
  BodyForce force[kMaxBodyForces];
};

}  // namespace railstep
