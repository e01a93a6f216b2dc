#pragma once
#include <array>

#include "offline/pack/pack.h"
#include "offline/pack/released.h"
#include "online/model/state.h"

namespace railstep {

/// The state at step 0 in static equilibrium under the loads, wheelsets, vehicles and weight,
/// contact included: each frictionless wheel of a wheelset carries what the balance of vertical
/// force and roll gives it. Velocities are those of the static shape moving along with loads and
/// wheels, accelerations 0.
/// @returns state_doubles() values
/// Throws Refused if the track has a free rigid mode, if a wheelset or a vehicle
/// would lift a wheel, or if a force pushes a wheelset aside and no flange holds it, or lifts it
/// over its flange, or it is not alone.
std::vector<double> start_in_equilibrium(const Track& track, const PackedModel& packed,
                                         double gravity);

/// The state at step 0 of a track without end in its moving steady state: it is as a bay later,
/// and a bay later again. Loads and wheels press with the force they have at the start, wheels with
/// their static one, on an even track. Of a ring under loads exact, wave by wave, from one passage
/// of the model itself: with z1 = k^n z0 + r turned by the bays gone, z1 = z0. Wheelsets, vehicles
/// and a window then pass bays until each is as the one before to 1e-9. Traffic that stands is in
/// equilibrium.
/// @returns state_doubles() values
/// Throws Refused as start_in_equilibrium(), where the track has ends, where no whole
/// number of steps up to 2^20 is a whole number of bays, and where nothing settles.
std::vector<double> start_moving(const Track& track, const PackedModel& packed, double gravity);

/// Vertical force at t = 0 on a wheel of a wheelset on its rails, N: no force acts on roll, so both
/// carry half. Throws Refused where it has none.
double wheel_load(const WheelsetModel& wheelset);

/// Coordinates of a wheelset that stands on its rails, pressed by its wheel_load().
/// @param height  of the railheads' tops over rest under the left and the right wheel, m
std::array<double, 6> standing_wheelset(const Model& model, const WheelsetModel& wheelset,
                                        const std::array<double, 2>& height);

}  // namespace railstep
