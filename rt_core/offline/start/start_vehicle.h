#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/start/static_lines.h"

namespace railstep {

/// Vehicles at rest on what gives way under their wheels.
struct SettledVehicles {
  Eigen::VectorXd force;                      // [vehicle wheels] on the wheel, up, N
  std::vector<Eigen::VectorXd> displacement;  // of each vehicle's coordinates
};

/// Equilibrium of all vehicles of a model with the track under them, wheel by wheel:
///   K q - B' f + weight = 0,   B q + flexibility f + depth(f) = free,
/// depth the penetration that a contact needs for its force, by Newton's method.
/// @param flexibility  [wheels][wheels] of the track under the wheels, m/N
/// @param free         [wheels] height there without the vehicles, irregularities included, m
/// Throws Refused where springs and wheels leave a vehicle a free motion, or where
/// a wheel would leave its rail.
SettledVehicles settle_vehicles(const Model& model, const Eigen::MatrixXd& flexibility,
                                const Eigen::VectorXd& free);

/// The vehicles of a model at rest on its track under what acts, `time` later than at the start,
/// and adds the forces of their wheels to it. Where the track is one-sided the heights under the
/// wheels are no linear function of the forces: Newton's method with their slopes by differences.
/// Throws Refused as settle_vehicles().
SettledVehicles settle_on_track(const Statics& statics, const PackedModel& packed, double gravity,
                                double time, Acting& acting);

}  // namespace railstep
