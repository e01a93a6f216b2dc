#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/start/static_lines.h"

namespace railstep {

/// Vehicles at rest on a flexible track.
struct SettledVehicles {
  Eigen::VectorXd force;                      // [vehicle wheels] on the wheel, up, N
  std::vector<Eigen::VectorXd> displacement;  // of each vehicle's coordinates
};

/// Equilibrium of all vehicles of a model with the track under each wheel:
///   K q - B' f + weight = 0,   B q + flexibility f + depth(f) = free,
/// by Newton's method; depth is the penetration of a contact under its force.
/// @param flexibility  [wheels][wheels] of the track under the wheels, m/N
/// @param free         [wheels] height there without the vehicles, irregularities included, m
/// Throws Refused if springs and wheels leave a vehicle a free motion, or if a wheel would leave
/// its rail.
SettledVehicles settle_vehicles(const Model& model, const Eigen::MatrixXd& flexibility,
                                const Eigen::VectorXd& free);

/// Settles the vehicles of a model on its track under the acting forces, `time` after the start,
/// and adds the forces of their wheels to these. On a track with one-sided supports the heights
/// under the wheels are not linear in the forces: Newton's method then takes slopes by differences.
/// Throws Refused as settle_vehicles().
SettledVehicles settle_on_track(const Statics& statics, const PackedModel& packed, double gravity,
                                double time, Acting& acting);

}  // namespace railstep
