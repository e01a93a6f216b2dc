#pragma once
#include "online/model/state.h"

namespace railstep {

/// Kinetic energy of a vehicle's bodies and strain energy of its springs in a state, J. What it
/// does along x is left out.
struct VehicleEnergy {
  double kinetic, strain;
};
VehicleEnergy vehicle_energy(const VehicleModel& vehicle, const State& at);

/// What passes in a step between two states, J. Where the equation of motion holds at the step's
/// end dampers take the trapezoidal mean of v' C v, and the loss is LineEnergy::loss with the
/// vehicle's matrices; where forces are held over the step they take du' C du / dt exactly and
/// nothing is lost, but of a table's or an input's force, held at its value at the step's end.
struct VehicleWork {
  double weight, forces, dissipated, loss;
};
VehicleWork vehicle_work(const Model& model, const VehicleModel& vehicle, const State& before,
                         const State& after);

/// B' f + forces - weight - M g - C v - K u at a state, along what the vehicle goes from there, J:
/// what a start leaves out of balance.
double vehicle_unbalanced(const Model& model, const VehicleModel& vehicle, const State& at,
                          const State& after);

}  // namespace railstep
