#pragma once
#include "online/contact/coupling.h"
#include "online/runner/runner_step.h"

namespace railstep {

// Runners in a step's coupled problem: each wheelset with the seats under its wheels is one law,
// and every contact and one-sided spring is one. Newton's method solves all of them together.

/// Finds the seats under all wheels of runners, where the forces of the stage act.
void locate_wheel_seats(const Model& model, const Stage& stage, const State& s, const Workspace& w,
                        Coupling& c) noexcept;

/// Adds the effect of the rails' roll to seats that mirror. Their displacements must be known.
void lean_wheel_seats(const Model& model, Coupling& c) noexcept;

/// Adds the residual flexibility between the rows of each seat to W.
void add_seat_flexibility(const Model& model, Coupling& c) noexcept;

/// All of the runners for one stage.
struct CoupledRunners {
  int scalars;  // contacts and one-sided springs, before the wheelsets among the coordinates
  WheelsetLaw law[kMaxSeatedWheelsets];
  /// Coordinates without forces of this step; where Newton's method starts, then what it found.
  double z_free[kMostNewton], motion[kMostNewton];
  double force[kMostNewton];
};

/// Moves the runners without contact into `solved`, and fills Y and the laws of the wheelsets.
/// Rows, W and track_free of the seats must be known.
void couple_runners(const Model& model, const Stage& stage, State& s, Workspace& w,
                    const Coupling& c, CoupledRunners& runners) noexcept;

/// Moves the seat of a row, by a displacement that W does not give.
void move_seat(const Coupling& c, int row, double by, CoupledRunners& runners) noexcept;

/// Index of a scalar law among the ports.
inline int port_of(const Coupling& c, int scalar) noexcept {
  return scalar < c.contacts ? scalar : c.rows + (scalar - c.contacts);
}

/// Solves all laws. The free depths of scalar laws must be the first of z_free.
/// Forces against all rows go into c.force, and depths of scalar laws into c.penetration.
NewtonResult solve_coupled_runners(const Model& model, const Workspace& w, Coupling& c,
                                   CoupledRunners& runners) noexcept;

/// Moves the runners by their forces, and stores these.
/// @returns events_of() all wheelsets, off_rail where one is beyond the rail's ends
Status move_coupled_runners(const Model& model, const Coupling& c, const CoupledRunners& runners,
                            State& s, Workspace& w) noexcept;

}  // namespace railstep
