#pragma once
#include "online/model/model.h"
#include "online/model/system_workspace.h"

namespace railstep {

/// Start of a step: views into the state, from the system's first unknown on.
struct SystemStart {
  const double* u;           // [unknowns]
  const double* v;           // [unknowns]
  const double* u_star;      // [unknowns] of the scheme
  const double* v_star;      // [unknowns]
  const double* quaternion;  // [bodies][4]
};

/// Sets velocities, accelerations, rotations, nodes and poses of the iterate x.
void place_parts(const Model& model, const SystemStart& start, SystemWorkspace& w) noexcept;

/// Sets poses at the step's start, which the mean of both ends needs.
void place_start(const Model& model, const SystemStart& start, SystemWorkspace& w) noexcept;

/// Baumgarte: positions ahead of the iterate by (2 kv + 2 alpha) / (kg + 2 alpha kv + beta^2), a
/// time of about a step. A change d of x changes velocity by kv d, acceleration by kg d, and
/// Phi'' + 2 alpha Phi' + beta^2 Phi by
/// (kg + 2 alpha kv + beta^2) G d + (2 kv + 2 alpha) G' d + G'' d,
/// G' and G'' the gradient's rates. Up to the square of a step this is the gradient ahead.
/// @returns the time, s
double place_ahead(const Model& model, SystemWorkspace& w) noexcept;

/// Elastic and inertia forces of all parts; with `renew` the factors of the beams' matrices too.
/// @returns number of pivots that were not positive
std::int32_t part_forces(const Model& model, const SystemStart& start, bool renew,
                         SystemWorkspace& w) noexcept;

/// Weight and applied forces.
/// @param input  State::input, or null before there is a state
void outer_forces(const Model& model, double time, const double* input,
                  SystemWorkspace& w) noexcept;

/// change of the ports on rails: to free motion - compliance * residual.
void solve_ports(const SystemModel& system, SystemWorkspace& w) noexcept;

/// change = -S^-1 residual, by the present factors.
void solve_parts(const Model& model, SystemWorkspace& w) noexcept;

/// S^-1 g of every end of a row, into tangent.solved.
/// @param parts  also does solve_parts(), with fewer sweeps than alone and the same bits
void solve_ends(const Model& model, bool parts, SystemWorkspace& w) noexcept;

}  // namespace railstep
