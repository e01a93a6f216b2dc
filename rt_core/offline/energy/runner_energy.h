#pragma once
#include <array>
#include <vector>

#include "offline/energy/suspended_energy.h"
#include "online/contact/wheel_seat.h"
#include "online/runner/runner_contact.h"

namespace railstep {

/// A wheel of a rail vehicle on its rail in a state.
struct StandingWheel {
  WheelForce force;
  double strain;                      // energy of its patches, J
  WheelSeatRow seat[kWheelSeatRows];  // rows of the rail under it; not on_rail on rigid rails
  double moved[kWheelSeatRows];       // of the seat, with its residual displacement, m, m, rad
  double residual[kWheelSeatRows];    // residual displacements alone
  double uneven_y, uneven_z;          // of the unloaded rail, m
  double frame_power;                 // on what the turning of its frame adds to its motion, W
  /// Force on the seat along row k, N, N m.
  double on_seat(int k) const { return k == 2 ? force.on_section : -force.generalised[1 + k]; }
};

/// A rail vehicle in a state, with the forces of the rails on its wheels.
struct StandingRunner {
  double speed;                                      // m/s
  std::vector<std::array<StandingWheel, 2>> wheels;  // [wheelsets][left, right]
};
/// The rates of the rails leave out those of residual flexibility on condensed lines.
StandingRunner standing_runner(const Model& model, const RunnerModel& runner, const State& at);

/// Energy of a rail vehicle in a state, J: of its bodies over the frames that move along the track,
/// spins in full; of its springs, with the geometric stiffness that its preloads make; of its
/// contacts; of the residual flexibility under its wheels.
struct RunnerEnergy {
  double kinetic, strain, contact, residual;
};
RunnerEnergy runner_energy(const Model& model, const RunnerModel& runner,
                           const StandingRunner& standing, const State& at);

/// Flows of energy in a step between two states, J. Means over the step are trapezoidal.
/// `loss` also has the work of the mean force of a contact beyond its spring's energy, its creep
/// and the drive's work.
struct RunnerWork : SuspendedWork {
  double drive;  // of the drive: against creep and acceleration, over uneven rails, and along rails
                 // that give way
  double creep;  // by creep and by the friction of brakes; a spring at a standstill gives back
};
RunnerWork runner_work(const Model& model, const RunnerModel& runner, const StandingRunner& before,
                       const State& from, const StandingRunner& after, const State& to);

/// Work in the first step of the forces that are out of balance at a start, J.
double runner_unbalanced(const Model& model, const RunnerModel& runner,
                         const StandingRunner& standing, const State& at, const State& after);

/// Adds the forces on the seats to those on the unknowns of banded lines.
void add_seat_forces(const Model& model, const StandingRunner& standing, double* force);

}  // namespace railstep
