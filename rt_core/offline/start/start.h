#pragma once
#include <array>

#include "offline/pack/pack.h"
#include "offline/pack/released.h"
#include "offline/start/static_lines.h"
#include "online/model/state.h"

namespace railstep {

/// The state at step 0 in static equilibrium under loads, wheelsets, vehicles and weight, contact
/// included. Vertical force and roll balance give the load of each frictionless wheel of a
/// wheelset. Velocities are those of the static shape that moves along with loads and wheels;
/// accelerations are 0.
/// @param beside  forces that press too
/// @param rate    [beside.contacts] of the change of these, N/s; empty: they do not change
/// @returns state_doubles() values
/// Throws Refused if the track has a free rigid mode, or if a wheelset or a vehicle would lift a
/// wheel. Under a lateral force on a wheelset it also throws if no flange holds the wheelset, if
/// the force lifts it over its flange, or if there are other wheelsets or vehicles.
std::vector<double> start_in_equilibrium(const Track& track, const PackedModel& packed,
                                         double gravity, const Acting& beside = {},
                                         const std::vector<double>& rate = {});

/// Forces of all wheels over the unknowns of each line of the model, in the equilibrium at t = 0
/// and where they are `time` later. On condensed lines these are the forces of all that presses but
/// `beside`, as far as the modes take them: they move full lines as they move the modes.
/// Throws Refused as start_in_equilibrium().
std::vector<Eigen::VectorXd> standing_line_forces(const Track& track, const PackedModel& packed,
                                                  double gravity, const Acting& beside,
                                                  double time);

/// Where something that runs on the rails is at t = 0, m, and its speed, m/s.
struct StartingPlace {
  double place, speed;
};
/// Finds the starting places of all loads and wheels.
std::vector<StartingPlace> starting_places(const Model& model);

/// The state at step 0 of a track without end in its moving steady state: the motion repeats from
/// bay to bay. Loads press with their force at the start, wheels with their static force, on an
/// even track. For a ring under loads the state is exact. It is solved wave by wave from one
/// passage of the model itself: z1 = k^n z0 + r, turned by the bays that were passed, equals z0.
/// Wheelsets, vehicles and a window then pass bays until each passage equals the one before to
/// 1e-9. Traffic without speed is in equilibrium.
/// @returns state_doubles() values
/// Throws Refused as start_in_equilibrium(), and also if the track has ends, if no number of steps
/// up to 2^20 is a whole number of bays, or if the motion does not settle.
std::vector<double> start_moving(const Track& track, const PackedModel& packed, double gravity);

}  // namespace railstep
