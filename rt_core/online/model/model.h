#pragma once
#include <cstdint>

#include "online/math/band.h"
#include "online/math/diagonals.h"

namespace railstep {

inline constexpr int kMaxLines = 16;  // independent systems a track falls into
inline constexpr int kMaxLoads = 32;

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

/// Everything a step needs; immutable, may be shared by threads.
struct Model {
  Scheme scheme;
  std::int32_t lines, loads, elements, unknowns;  // unknowns of all lines, padded
  std::int32_t residual_points;                   // intervals of a residual table per element
  std::int32_t steps_per_frame;
  double element_length;  // m
  LineModel line[kMaxLines];
  LoadModel load[kMaxLoads];
};

}  // namespace railstep
