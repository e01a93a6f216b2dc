#pragma once
#include <cstddef>
#include <initializer_list>

#include "online/model/system.h"

namespace railstep {

/// Pose of a marker: its point, then its three directions, in ground axes.
struct MarkerPose {
  double point[3];
  double axis[3][3];
};

/// Gradient of a row's value by the point and by the directions e_k of the marker at one end. Per
/// unit of the row's force it is the force on the point, and the force f on each direction (for a
/// body the moment e_k x f).
struct MarkerGradient {
  double point[3];
  double axis[3][3];
  bool has_axes;  // else all of `axis` is 0
};

/// Parts of Newton's matrix. They are in the state if the matrix is kept over steps, else in the
/// workspace.
struct SystemTangent {
  double* factor;       // of every beam, one after another
  double* solved;       // S^-1 g: per end of a body [6], per beam
                        // [groups][unknowns][kEndGroup], per end of the track [9 ports]
  double* compliance;   // [rows][rows] between rows, factored
  double* scale;        // [rows]
  std::int32_t* order;  // [rows]
  double* rank;         // [1] of the joint rows
  double* age;          // [1] steps since it was made; 0: never
};

/// Scratch of a system's step, in one block of the caller.
struct SystemWorkspace {
  double* x;               // [unknowns] displacements at the step's end, the iterate
  double* shift;           // [unknowns] Gear, Gupta, Leimkuhler: the part of x without velocity
  double* v;               // [unknowns] velocities of x
  double* g;               // [unknowns] accelerations of x
  double* residual;        // [unknowns] N
  double* change;          // [unknowns]
  double* elastic;         // [unknowns] N
  double* inertia;         // [unknowns] N
  double* outer;           // [unknowns] N, weight and applied forces
  double* nodes;           // [unknowns] of beams, positions at which forces are taken
  double* half_change;     // [unknowns] of beams, energy-momentum
  double* free_ports;      // [9 ports] displacements of the track without rows
  double* quaternion;      // [bodies][4] at the step's end
  double* matrix;          // [bodies][9] of it
  double* start_matrix;    // [bodies][9] at the step's start
  double* centre;          // [bodies][3] where forces are taken, m
  MarkerPose* pose;        // [markers] at the step's end
  MarkerPose* start_pose;  // [markers]
  MarkerPose* force_pose;  // [markers] where forces are taken: the end, or the mean of both
  double* gradient;        // [ends][kMostNodeUnknowns] of a row by the unknowns of its end
  double* ahead;           // [unknowns] Baumgarte: displacements ahead of the step's end
  double* ahead_matrix;    // [bodies][9]
  MarkerPose* ahead_pose;  // [markers]
  double* slope;           // [ends][kMostNodeUnknowns] of `wanted`; mostly `gradient` itself
  double* value;           // [rows] Phi at the end
  double* start_value;     // [rows] of springs, energy-momentum
  double* wanted;          // [rows]
  double* spring_lack;     // [rows] of springs: force by their law less their force, N
  double* velocity_part;   // [rows] of `wanted`, Gear, Gupta, Leimkuhler
  double* rate[2];         // [rows] of joints: first and second derivative of Phi; of springs 0
  double* force;           // [rows] the iterate
  double* scratch;         // [rows]
  double* tangents;        // of the largest beam
  SystemTangent tangent;
};

inline std::int32_t system_rows(const SystemModel& s) noexcept {
  return s.joint_rows + s.spring_rows;
}
/// Whether `wanted` of a row has another derivative by x than the gradient of the row's force.
inline bool has_slopes(const SystemModel& s) noexcept {
  return s.mean != 0 || s.constraint_method == ConstraintMethod::baumgarte;
}
inline std::int32_t beam_width(const BeamChainModel& beam) noexcept {
  return beam.planar != 0 ? kPlanarUnknowns : 9;
}
/// Ends of rows on a part; parts are bodies, then beams, then the track.
inline std::int32_t part_ends(const SystemModel& s, std::int32_t part) noexcept {
  return s.part_end[part + 1] - s.part_end[part];
}
/// S^-1 g of a beam's ends is in groups of kEndGroup ends, [groups][unknowns][kEndGroup]; one solve
/// serves a group.
inline constexpr std::int32_t kEndGroup = 4;
inline std::int32_t beam_groups(const SystemModel& s, std::int32_t beam) noexcept {
  return (part_ends(s, s.bodies + beam) + kEndGroup - 1) / kEndGroup;
}
inline std::int64_t end_group_doubles(const BeamChainModel& beam) noexcept {
  return std::int64_t{kEndGroup} * beam.unknowns;
}
/// Index of an unknown for end number `end` of a beam in these groups.
inline std::int64_t end_group_place(const BeamChainModel& beam, std::int32_t end,
                                    std::int32_t unknown) noexcept {
  return end_group_doubles(beam) * (end / kEndGroup) + std::int64_t{kEndGroup} * unknown +
         end % kEndGroup;
}

std::int64_t system_tangent_doubles(const SystemModel& system) noexcept;
/// Size of quaternions and row forces.
inline std::int64_t system_start_doubles(const SystemModel& system) noexcept {
  return system.unknowns == 0 ? 0 : 4LL * system.bodies + system_rows(system);
}
/// Size of quaternions, row forces, and the tangent if it is kept.
std::int64_t system_state_doubles(const SystemModel& system) noexcept;
std::int64_t system_workspace_doubles(const SystemModel& system) noexcept;

/// Views over the caller's memory.
SystemTangent system_tangent_on(const SystemModel& system, double* memory) noexcept;
/// @param kept  the tangent's memory in the state, or null
SystemWorkspace system_workspace_on(const SystemModel& system, double* memory,
                                    double* kept) noexcept;

}  // namespace railstep
