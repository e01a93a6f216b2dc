#pragma once
#include "online/contact/external.h"
#include "online/model/state.h"
#include "online/system/system_step.h"

namespace railstep {

/// Results of the coupled solve of a step.
struct CoupleResult {
  Status status;
  std::int32_t iterations;
  double violation;        // of the guides, m or rad
  double gap[kMaxWheels];  // [contacts] m, negative in contact
  double x[kMaxWheels];    // of the contact along the model's elements, undeformed, m
  bool on_rail[kMaxWheels];
  SystemResult system;  // of one that holds the rails, else 0
};

/// Couples wheelsets, guides, vehicles, contacts with the rails and one-sided springs of the track.
/// It finds the contacts at a stage's end and the response of the track to its own right-hand side
/// (in workspace.solved) and to each wheel, then solves for all ports' forces and guides together.
/// A system of bodies that holds the rails is solved with them, and ends with leave_system().
/// At the end workspace.solved has all displacements but those of a system.
/// @param external  [external_wheels] whose forces are in workspace.solved
CoupleResult couple(const Model& model, const Stage& stage, const ExternalContact* external,
                    State& state, Workspace& workspace) noexcept;

/// After the scheme's correction, projects velocities and accelerations of guided coordinates onto
/// the guide (not by Baumgarte; the inertia is diagonal, so that the projection is exact).
void project_guides(const Model& model, const Stage& stage, State& state) noexcept;

}  // namespace railstep
