#pragma once
#include "online/model/state.h"

namespace railstep {

/// Results of the solve of a system's step.
struct SystemResult {
  Status status;
  std::int32_t iterations;
  double violation;       // largest |Phi| of the joints at the step's end, m, or 1
  double force_residual;  // over the largest kind of force
  std::int32_t redundant_rows;
  std::int32_t redundant_row[kMostNamedRows];
};

/// Begins a step: the iterate is the scheme's step with the last accelerations. The free motion of
/// the ports must be known before the iterations, SystemWorkspace::free_ports.
void begin_system(const Model& model, State& state, Workspace& workspace) noexcept;

/// Newton's iterations from the present iterate, capped. They find the displacements at the step's
/// end and the forces of joints and springs.
SystemResult solve_system(const Model& model, State& state, Workspace& workspace) noexcept;

/// Ends a step: passes the displacements to the scheme's correction, in workspace.solved from the
/// system's first unknown on, and moves the lines by the forces of the rows.
void leave_system(const Model& model, State& state, Workspace& workspace) noexcept;

/// After the scheme's correction: adds rotations to quaternions, and projects velocities and
/// accelerations onto the joints if the constraint method does so. @returns cap_reached if a
/// projection did not end
Status finish_system(const Model& model, State& state, Workspace& workspace) noexcept;

}  // namespace railstep
