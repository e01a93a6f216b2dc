#pragma once
#include "online/model/state.h"

namespace railstep {

/// Kinetic energy of a vehicle's bodies and strain energy of its springs in a state, J, without its
/// motion along x.
struct VehicleEnergy {
  double kinetic, strain;
};
VehicleEnergy vehicle_energy(const VehicleModel& vehicle, const State& at);

/// Flows of energy in a step between two states, J. If the equation of motion holds at the step's
/// end, dampers dissipate the trapezoidal mean of v' C v, and the loss is LineEnergy::loss with the
/// vehicle's matrices. If forces are held over the step, dampers dissipate du' C du / dt exactly;
/// the loss is 0, except for forces of tables and inputs, which are held at their value at the
/// step's end.
struct VehicleWork {
  double weight, forces, dissipated, loss;
};
VehicleWork vehicle_work(const Model& model, const VehicleModel& vehicle, const State& before,
                         const State& after);

/// B' f + forces - weight - M g - C v - K u at a state, times the vehicle's motion from there, J:
/// the work of the forces that are out of balance at a start.
double vehicle_unbalanced(const Model& model, const VehicleModel& vehicle, const State& at,
                          const State& after);

}  // namespace railstep
