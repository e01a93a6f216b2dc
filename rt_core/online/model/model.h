#pragma once
#include <cstdint>

#include "online/math/band.h"
#include "online/math/diagonals.h"

namespace railstep {

inline constexpr int kMaxLines = 16;  // independent systems a track falls into
inline constexpr int kMaxLoads = 32;
inline constexpr int kMaxWheelsets = 4;
inline constexpr int kMaxWheels = 2 * kMaxWheelsets;
inline constexpr int kMaxBodyForces = 4;

/// Coefficients of a one-step scheme with constant matrices, made offline. With g the true
/// acceleration (M g + C v + K u = f at every step) and a the algorithmic one (Arnold and Bruls
/// 2007):
///   u* = u + uv v + ua a + ug g,   v* = v + va a + vg g,   (K + kv C + kg M) u1 = f + M kg u* +
///   C (kv u* - v*),   v1 = v* + kv (u1 - u*),   g1 = kg (u1 - u*),   a1 = ag g1 + a0 g + aa a.
struct Scheme {
  double dt;  // s
  double uv, ua, ug, va, vg, kv, kg, ag, a0, aa;
};

/// One independent linear system of the track; views into the model's block.
struct LineModel {
  std::int32_t first;              // of its unknowns among the state's
  Band step;                       // factor of K + kv C + kg M
  Diagonals mass, damping;         // padded to whole panels
  const std::int32_t* unknown_of;  // [nodes][9], -1 where not carried
  double rail_factor[2];           // weight of the line in left and right rail
  std::int32_t mirrored;           // right rail: y components change sign
};

/// A prescribed force that runs along a rail.
struct LoadModel {
  double row[9];              // of a node: position, y slope, z slope; gives the loaded point's z
  std::int32_t rail;          // 0 left, 1 right
  double start, speed, stop;  // m, m/s, m; taken off beyond stop
  double force;               // N along z, up positive
  std::int32_t table_points;  // 0: constant
  const double* table;        // [table_points][2]  s, factor; linear between, constant outside
  const double* residual;     // [elements][residual_points + 1]  m/N at equal xi, or null
};

/// A force on a wheelset's centre over time.
struct BodyForce {
  std::int32_t direction, points;  // 0 x, 1 y, 2 z; rows of the table
  const double* table;             // [points][2]  s, N; linear between, constant outside
};

enum class Guide : std::int32_t { augmented_lagrangian, baumgarte };

/// A rigid wheelset on both rails: coordinates x, y, z of its centre from its start, then roll,
/// spin and yaw; cylinders of one radius roll on circular railhead crowns without friction. The
/// guide holds x = speed t and yaw = 0.
struct WheelsetModel {
  std::int32_t first;  // of its six coordinates among the state's unknowns
  double mass[6];      // kg, kg, kg, roll, spin, yaw inertia kg m2
  double weight;       // N, down; of the wheelset and what it carries
  double radius, tread_half_width;
  double start, speed;  // of the centre, m, m/s
  double rest_z;        // height of the centre over the rails' axes when it touches, m
  double hertz;         // C of P = C d^1.5, N/m^1.5
  Guide guide;
  std::int32_t cap;    // iterations of the augmented Lagrangian
  double tolerance;    // m and rad
  double alpha, beta;  // of Baumgarte, 1/s
  std::int32_t forces;
  BodyForce force[kMaxBodyForces];
  const double* residual[2];  // per rail [elements][residual_points + 1]  m/N, or null
};

/// Everything a step needs; immutable, may be shared by threads.
struct Model {
  Scheme scheme;
  std::int32_t lines, loads, wheelsets, elements;
  std::int32_t unknowns;         // of all lines, padded, and 8 per wheelset
  std::int32_t residual_points;  // intervals of a residual table per element
  std::int32_t steps_per_frame;
  double element_length;         // m
  double rail_y[2];              // of the rails' axes, m
  double head_z;                 // of the railhead's top over the axis, m
  double crown_radius;           // m
  double head_half_width;        // m
  const double* constant_force;  // [unknowns] N, or null: the track's weight
  LineModel line[kMaxLines];
  LoadModel load[kMaxLoads];
  WheelsetModel wheelset[kMaxWheelsets];
};

}  // namespace railstep
