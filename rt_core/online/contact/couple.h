#pragma once
#include "online/model/state.h"

namespace railstep {

/// What the coupled solve of a step met.
struct CoupleResult {
  Status status;
  std::int32_t iterations;
  double violation;        // of the guides, m or rad
  double gap[kMaxWheels];  // [contacts] m, negative in contact
  double x[kMaxWheels];    // of the contact along the model's elements, undeformed, m
  bool on_rail[kMaxWheels];
};

/// Wheelsets, their guides, vehicles, their contacts with the rails, and what of the track is
/// one-sided: finds the contacts at a stage's end, solves the track for its own right-hand side (in
/// workspace.solved) and for each wheel, then all ports' forces and guides together, and leaves
/// behind the displacements of all in solved.
CoupleResult couple(const Model& model, const Stage& stage, State& state,
                    Workspace& workspace) noexcept;

/// After the scheme's correction: velocities and accelerations of guided coordinates are put onto
/// the guide (augmented Lagrangian; the inertia is diagonal, so the projection is exact).
void project_guides(const Model& model, const Stage& stage, State& state) noexcept;

}  // namespace railstep
