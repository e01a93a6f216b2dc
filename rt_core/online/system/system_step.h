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

/// Newton's iterations of one step, capped. They find the displacements at its end, which go into
/// workspace.solved from the system's first unknown on, as the scheme's correction expects them,
/// and the forces of joints and springs.
SystemResult solve_system(const Model& model, State& state, Workspace& workspace) noexcept;

/// After the scheme's correction: adds rotations to quaternions, and projects velocities and
/// accelerations onto the joints if the constraint method does so. @returns cap_reached if a
/// projection did not end
Status finish_system(const Model& model, State& state, Workspace& workspace) noexcept;

}  // namespace railstep
