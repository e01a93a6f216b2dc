#pragma once
#include <Eigen/Core>

#include "online/model/state.h"

namespace railstep {

using BodiesVector = Eigen::Map<const Eigen::VectorXd>;
/// The part of suspended bodies, [size], of values of all unknowns.
inline BodiesVector part_of(const SuspendedModel& bodies, const double* values) {
  return {values + bodies.first, bodies.size};
}

/// Kinetic energy of suspended bodies and strain energy of their springs in a state, J, with the
/// geometric stiffness that preloads make, and without their motion with the frames.
struct SuspendedEnergy {
  double kinetic, strain;
};
SuspendedEnergy suspended_energy(const SuspendedModel& bodies, const State& at);

/// Forces of tables and inputs along the coordinates, N and N m. @param before  steps before the
/// state's
Eigen::VectorXd outer_forces(const Model& model, const SuspendedModel& bodies, const State& at,
                             double before = 0.);

/// Flows of energy in a step between two states, J. If the equation of motion holds at the step's
/// end, dampers dissipate the trapezoidal mean of v' C v, and the loss is LineEnergy::loss with the
/// bodies' matrices. If forces are held over the step, dampers dissipate du' C du / dt exactly; the
/// loss is 0, except for forces of tables and inputs, which are held at their value at the step's
/// end.
struct SuspendedWork {
  double weight;  // of weights and preloads
  double forces;  // of tables and inputs
  double dissipated, loss;
};
SuspendedWork suspended_work(const Model& model, const SuspendedModel& bodies, const State& before,
                             const State& after);

/// Work of the forces that are out of balance at a state on the motion from there, J.
/// @param force  [size] at the interfaces, N and N m
double suspended_unbalanced(const Model& model, const SuspendedModel& bodies,
                            const Eigen::VectorXd& force, const State& at, const State& after);

}  // namespace railstep
