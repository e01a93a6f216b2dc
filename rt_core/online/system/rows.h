#pragma once
#include "online/system/compliance.h"
#include "online/system/marker.h"
#include "online/system/parts.h"

namespace railstep {

/// Generalised force at a marker on the unknowns of unknowns_of(), in the pose at which the step
/// takes forces.
/// @param out  [kMostNodeUnknowns], overwritten for these unknowns
void end_row(const SystemModel& system, const SystemWorkspace& w, std::int32_t marker,
             const MarkerGradient& gradient, double* out) noexcept;

/// Values and gradients of all rows at the iterate, and the change that Newton's step must make in
/// each, m: `wanted`, without the parts' own change. @returns the largest of these over joint rows
/// @param renew  the matrix is made again here: slopes belong to it, and are kept with it in a step
double set_rows(const Model& model, double time, bool renew, SystemWorkspace& w) noexcept;

/// Largest |Phi| of the joint rows.
double joint_violation(const SystemModel& system, const SystemWorkspace& w) noexcept;

/// out += G' force over all rows.
void add_row_forces(const SystemModel& system, const double* gradient, const double* force,
                    double* out) noexcept;

/// out[row] += G change, over all rows.
void add_row_changes(const SystemModel& system, const double* gradient, const double* change,
                     double* out) noexcept;

/// Factor of slope S^-1 gradient' and the rows' own compliance.
void factor_rows(const Model& model, SystemWorkspace& w) noexcept;
/// The same in place: x [rows]. @param all  springs too
void solve_rows(const Model& model, SystemWorkspace& w, bool all, double* x) noexcept;

/// change -= S^-1 G' force.
void subtract_row_motion(const SystemModel& system, const SystemWorkspace& w, const double* force,
                         double* change) noexcept;

/// d(force)/d(Phi) of a spring over a step, N/m.
double spring_slope(const Model& model, const RowModel& row) noexcept;

}  // namespace railstep
