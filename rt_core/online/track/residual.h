#pragma once
#include "online/model/state.h"

namespace railstep {

/// Where a vertical force acts on a rail, for the residual flexibility.
struct RailForce {
  std::int32_t load_point,
      element;  // kNoLoadPoint makes and feels no residual displacement
  double xi;
  double force;  // N, up positive
};

/// An element and its xi for a place along the model's elements, m; clipped to them.
RailForce rail_force(const Model& model, std::int32_t load_point, double x, double force) noexcept;

inline constexpr int kMaxRailForces = kMaxLoads + kMaxWheels + kMaxExternalWheels;

/// Vertical forces of all loads, then all wheels, then all external wheels, as published.
/// @param forces  [kMaxRailForces]
/// @returns how many
int rail_forces(const Model& model, const Outputs& outputs, RailForce* forces) noexcept;

/// Residual displacement per newton of a force's own point, m/N; 0 where none is modelled.
double residual_under(const Model& model, const RailForce& at) noexcept;

/// The same of the rail's axis under the force.
double residual_axis(const Model& model, const RailForce& at) noexcept;

/// The same at the place of another port.
double residual_between(const Model& model, const RailForce& force, const RailForce& at) noexcept;

/// What all forces add to the displacement of the point under one of them, m.
double residual_displacement(const Model& model, const RailForce* forces, int count,
                             int at) noexcept;

/// What all forces add to a track sensor's value.
double residual_of_track_sensor(const Model& model, std::int32_t track_sensor,
                                const RailForce* forces, int count) noexcept;

}  // namespace railstep
