#pragma once
#include "online/math/table.h"
#include "online/model/state.h"

namespace railstep {

/// Place of a vertical force on a rail, for the residual flexibility.
struct RailForce {
  std::int32_t load_point, element;  // kNoLoadPoint: without residual displacement
  double xi;
  double force;   // N, up positive
  Cubic between;  // in the tables between load points

  RailForce() = default;  // without values: lists of them are long
  RailForce(const Model& model, std::int32_t at, std::int32_t of_element, double own_xi,
            double newton) noexcept
      : load_point(at), element(of_element), xi(own_xi), force(newton) {
    if (model.residual.pair_points > 0) between = cubic(model.residual.pair_points, xi);
  }
};

/// Element and xi of a place along the model's elements, m; clipped to the elements.
RailForce rail_force(const Model& model, std::int32_t load_point, double x, double force) noexcept;

inline constexpr int kMaxRailForces =
    kMaxLoads + kMaxWheels + kMaxExternalWheels + 2 * kMaxRunnerWheelsets;

/// Vertical forces of all loads, then all wheels, then all external wheels, then all wheels of
/// runners, as published.
/// @param forces  [kMaxRailForces]
/// @returns number of forces
int rail_forces(const Model& model, const Outputs& outputs, RailForce* forces) noexcept;

/// Residual displacement of a force's own point per newton, m/N; 0 if it is not modelled.
double residual_under(const Model& model, const RailForce& at) noexcept;

/// The same for the rail's axis under the force.
double residual_axis(const Model& model, const RailForce& at) noexcept;

/// The same for the place of another port.
double residual_between(const Model& model, const RailForce& force, const RailForce& at) noexcept;

/// Residual displacement of the point under one of the forces by all forces, m.
double residual_displacement(const Model& model, const RailForce* forces, int count,
                             int at) noexcept;

/// The same of the first points. @param moved  [points] out
void residual_displacements(const Model& model, const RailForce* forces, int count, int points,
                            double* moved) noexcept;

/// Residual part of a track sensor's value by all forces.
double residual_of_track_sensor(const Model& model, std::int32_t track_sensor,
                                const RailForce* forces, int count) noexcept;

}  // namespace railstep
