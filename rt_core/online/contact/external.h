#pragma once
#include "online/track/line.h"
#include "online/track/residual.h"

namespace railstep {

/// Contact of a wheel of a vehicle outside the model in a step. The place is an input. The rows are
/// frozen on the configuration that the state's velocities lead to.
struct ExternalContact {
  bool on_rail;
  RailRow row[3];   // displacement of that point of the railhead along x, y, z of the track
  double offset;    // second order of its height in the rail's roll, m: track/p_delta.h
  double roll;      // of the section under it, rad
  double place;     // along the model's elements, m
  double force[3];  // N on the rail, 0 off it
  RailForce port;   // of the vertical force, for the residual flexibility
};

/// The directions of all external wheels are numbered: direction d of wheel n is row 3 n + d.
struct ExternalRow {
  std::int32_t wheel, direction;  // 0 x, 1 y, 2 z
};
constexpr std::int32_t external_row(std::int32_t wheel, std::int32_t direction) noexcept {
  return 3 * wheel + direction;
}
constexpr ExternalRow external_row_at(std::int32_t row) noexcept { return {row / 3, row % 3}; }

/// Places all external wheels by the inputs of a step. @param contact  [external_wheels]
/// overwritten
void place_external(const Model& model, std::int64_t step, const double* input,
                    const Configuration& located, ExternalContact* contact) noexcept;

/// The same on the state at the step's start, whose inputs are those of the step.
/// @param scaled  [unknowns] scratch
void place_in_step(const Model& model, std::int64_t step, const State& state, double* scaled,
                   ExternalContact* contact) noexcept;

/// Places them in this way and applies their forces to the lines: on the right-hand side of banded
/// lines, held over the step on condensed ones, as for wheels in the model.
void apply_external_forces(const Model& model, std::int64_t step, const State& state,
                           Workspace& workspace, ExternalContact* contact) noexcept;

/// Publishes displacements by the lines, places and forces of a state.
void publish_external(const Model& model, const State& state, const ExternalContact* contact,
                      Outputs& outputs) noexcept;

/// Publishes velocities of the rail under the wheels. @param workspace  scratch
void publish_external_rates(const Model& model, const State& state, const ExternalContact* contact,
                            Workspace& workspace, Outputs& outputs) noexcept;

/// Displacement of one contact's point per newton at another, for all rows: symmetric, m/N, with
/// residual flexibility.
/// @param compliance  [3 external_wheels][3 external_wheels] overwritten; 0 off the rail
void external_compliance(const Model& model, const ExternalContact* contact, Workspace& workspace,
                         double* compliance) noexcept;

}  // namespace railstep
