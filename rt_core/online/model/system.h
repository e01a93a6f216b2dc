#pragma once
#include <cstdint>

#include "online/beam/chain.h"

namespace railstep {

// Rigid bodies and nonlinear beams, with their joints, springs and forces. Their unknowns are in
// the state's u, v, a, g after those of the track and the wheelsets.
//   beam   displacement from rest of its nodes, 9 each (r, a, b),
//          planar 5 (r_x, r_z, a_y, b_x, b_z)
//   body   displacement of its centre from rest, then the rotation of the step in body axes, which
//          the end of the step adds to the state's quaternion: between steps it is 0;
//          planar x, z, about y
// Structures have no pointers and no gaps, so that arrays of them are in a block as they are here:
// fields of 4 bytes come first and are even in number.

inline constexpr int kMaxSystemRows = 512;
inline constexpr int kMaxSystemParts = 256;
inline constexpr int kMostElementsOfBeam = 10'000;
inline constexpr int kMostSystemItems = 1 << 16;  // markers, motions, forces, or sensors
inline constexpr int kMostPieces = 1 << 22;       // of all motions
inline constexpr int kMostPorts = 1 << 12;        // on rails
inline constexpr int kMostIterations = 1000;      // of Newton, or of a projection
inline constexpr int kMostKeptSteps = 1'000'000;
inline constexpr int kMotionCoefficients = 6;
inline constexpr int kMostNamedRows = 16;     // redundant rows that a frame names
inline constexpr int kMostNodeUnknowns = 27;  // of one part that one row acts on

/// A rigid body about its centre of mass.
struct RigidBodyModel {
  std::int32_t first;  // of its unknowns among the system's
  std::int32_t
      column[6];  // unknown of x, y, z and of rotations about the body's axes; -1: not carried
  std::int32_t unknowns;  // 6 or 3
  double mass;            // kg
  double inertia[9];      // kg m2, in body axes
  double inverse_inertia[9];
  double rest[3];  // of the centre, m
  double radius;   // of gyration, m: a moment over it compares with a force
};

/// A nonlinear beam: a chain of equal straight elements, beam_chain.h.
struct BeamChainModel {
  std::int32_t first;
  std::int32_t unknowns;  // of all its nodes
  std::int32_t planar, elements;
  std::int32_t first_held, held;  // among the system's: those that are 0, from the beam's own first
  double mass[4];                 // of a Chain
  double slope_scale;  // m: half the section's height; force / scale compares with a force
  StraightBeam element;
};

/// A place of a linear track's rail that rows act on. Its nine unknowns are the displacements of
/// r, a, b there; the track's step matrix gives them as free motion - compliance * forces.
struct RailPortModel {
  std::int32_t first;  // of its unknowns among the system's
  std::int32_t rail, element;
  std::int32_t unused;
  double value[3];  // shape functions of the element's nodes
  double rest[9];   // r, a, b
};

enum class PartKind : std::int32_t { ground, body, beam, rail };

/// A point with three directions on a part. Directions are rows of `frame` in the ground's axes,
/// the body's axes, or the section's a x b, a, b.
struct MarkerModel {
  PartKind kind;
  std::int32_t part;  // body, beam, or port on a rail
  std::int32_t node;  // of a beam: first of the three nodes of its element
  std::int32_t unused;
  double position[3];  // on the ground; in body axes from the centre; of a beam or rail 0, y, z, m
  double frame[9];
  double value[3];  // of a beam: shape functions of its three nodes
};

/// Value Phi of a row between its markers A and B. Each is a sum of products of linear functions of
/// points and directions, so that its mean gradient is exact (energy-momentum).
enum class RowKind : std::int32_t {
  along_ground,  // axis k of the ground . (p_B - p_A) - s(t), m
  along_a,       // e_k of A . (p_B - p_A) - s(t), m
  square,        // e_i of A . e_j of B, 1; rotated by s(t): cos(s) e_i . e_j - sin(s) e_l . e_j
  distance,      // (|p_B - p_A|^2 - s^2) / (2 s0), m
  spring,        // |p_B - p_A| - s0, m; a spring and a damper along it
};

/// Joint rows come first, springs after.
struct RowModel {
  RowKind kind;
  std::int32_t a, b;          // markers
  std::int32_t end[2];        // its ends on parts; -1 on the ground
  std::int32_t i, j, l;       // axes
  std::int32_t motion;        // s(t); -1: `offset`
  std::int32_t joint;         // it belongs to
  double offset;              // s0
  double compliance;          // of the augmented Lagrangian, 1 / penalty, m/N; 0: rigid
  double stiffness, damping;  // of springs, N/m, N s/m
};

/// s(t), piece by piece a polynomial in t - start; the first and the last piece continue outside.
struct MotionModel {
  std::int32_t first, pieces;  // among the system's
};

/// A force on a marker's point, or a moment on its body: direction (ground axes) times s(t), or
/// times an input.
struct PointForceModel {
  std::int32_t marker;
  std::int32_t motion;  // s(t); -1: an input instead
  std::int32_t input;   // -1: none
  std::int32_t moment;  // 1: N m on a body
  double direction[3];
};

enum class ConstraintMethod : std::int32_t {
  augmented_lagrangian,
  baumgarte,
  gear_gupta_leimkuhler,
  direct
};

/// When Newton's matrix is made again. It always is when it no longer reduces the residual.
enum class Renew : std::int32_t { every_iteration, every_step, kept };

/// A row's end A (side 0) or B (side 1) on a body, a beam or the track.
struct EndModel {
  std::int32_t row, side;
};

/// A whole system. Rows of joints come first, then those of springs. Parts are bodies, then beams,
/// then the track.
struct SystemModel {
  std::int32_t bodies, beams, markers, joint_rows, spring_rows, motions, forces, sensors, ends;
  std::int32_t ports;            // on rails; their unknowns come last
  std::int32_t first, unknowns;  // in the state, padded to whole panels; parts count from `first`
  std::int32_t held, pieces;     // unknowns of all beams that are 0, pieces of all motions
  std::int32_t traced_joints, traced_springs;  // whose forces a trace shows
  ConstraintMethod constraint_method;
  Renew renew;
  std::int32_t mean;         // 1: forces at the mean of both ends of a step (energy-momentum)
  std::int32_t cap;          // Newton iterations a step
  std::int32_t projections;  // most iterations of a projection
  std::int32_t keep_steps;   // Renew::kept: number of steps for which it is kept
  double alpha, beta;        // Baumgarte: Phi'' + 2 alpha Phi' + beta^2 Phi = 0, 1/s
  double tolerance;          // of forces, over the largest kind of force
  double joint_tolerance;    // m, and 1
  double rank_tolerance;  // a rigid row is redundant if its pivot is below this times its diagonal
  const RigidBodyModel* body;
  const BeamChainModel* beam;
  const MarkerModel* marker;
  const RowModel* row;           // [joint_rows + spring_rows]
  const EndModel* end;           // [ends] of all rows, part after part
  const std::int32_t* part_end;  // [bodies + beams + 2] the first end of a part
  const MotionModel* motion;
  const PointForceModel* force;
  const double* piece_start;          // [pieces] s, rising within a motion
  const double* piece;                // [pieces][kMotionCoefficients]
  const double* beam_rest;            // [unknowns] of beams: positions and slopes
  const std::int32_t* held_unknown;   // [held]
  const std::int32_t* sensor;         // [sensors] markers, the last of all
  const double* sensor_rest;          // [sensors][3] m: origin of displacements
  const std::int32_t* traced_joint;   // [traced_joints]
  const std::int32_t* traced_spring;  // [traced_springs] from the first spring row on
  const double* constant_force;       // [unknowns] N: weight
  const RailPortModel* port;
  const double* port_compliance;  // [9 ports][9 ports] B S^-1 B', m/N, with residual flexibility
  const double* port_shapes;      // [9 ports][parts][lines' unknowns] S^-1 B', m/N; of condensed
                                  // lines under forces held over the step, real and imaginary
  const double* per_length;       // [unknowns] factors that make forces comparable: 1, or 1/m
};

}  // namespace railstep
