#pragma once
#include <array>
#include <vector>

#include "offline/start/static_lines.h"

namespace railstep {

/// Rail vehicles in their steady motion, with the forces of their wheels.
struct SettledRunners {
  std::vector<SteadyRunning> steady;  // of each
  /// [wheelsets of all][left, right] forces on the wheel.
  std::vector<std::array<WheelForce, 2>> wheels;
  /// Deflections of the dampers of each that are in series with springs; settle_runners() fills
  /// them.
  std::vector<std::vector<double>> series = {};
};

/// Rail vehicles on even, rigid rails.
SettledRunners runners_on_even_rails(const PackedModel& packed);

/// Adds the forces of the wheels to those on the lines, with everything moved on by `time`, s.
void add_forces(const PackedModel& packed, const SettledRunners& runners, const Configuration& at,
                double time, Acting& acting);

/// Rail vehicles on rails as they lie. The vehicles stand on rails that are uneven in height. Along
/// y each wheelset goes with its rails, at the yaw at which it rolls along them, and the springs
/// make the other bodies follow.
/// @param acting  with add_forces() of the runners `pressing`, from its port `first_port` on
SettledRunners settle_runners(const PackedModel& packed, const SettledRunners& pressing,
                              const Configuration& at, double time, const Acting& acting,
                              std::size_t first_port);

/// Forces at the start that a runner's constraints take by its acceleration alone: ahead by its
/// drive, then the tension of each rod, N. Springs are as in steady motion then.
/// @param time  s, in the first step
Eigen::VectorXd constraint_forces_of_acceleration(const RunnerModel& runner, double time);

/// Fills State::seat: the seats as they lie under the forces of the wheels, the rails at rest.
void put_seats(const Model& model, State& state);

/// Fills State::element_memory of a runner whose motions are in a state: friction has come to its
/// displacement in one way from rest, and brakes have not slid.
void start_elements(const Model& model, const RunnerModel& runner, State& state);

}  // namespace railstep
