#pragma once
#include "online/math/newton.h"
#include "online/model/state.h"
#include "online/runner/force_elements.h"
#include "online/runner/wheelset_law.h"

namespace railstep {

inline constexpr int kMostInterfaces = kMotions * kMaxWheelsetsOfRunner + 2 * kMaxForceElements;
/// Tolerance of Newton's method: penetrations are differences of lengths that are 1e4 times as
/// large.
inline constexpr double kRunnerTolerance = 1e-10;

/// Displacements at the stage's end without contact, and in the state the forces of the
/// constraints.
/// @param u  [size] out
void move_freely(const RunnerStage& at, State& s, const Workspace& w, double* u) noexcept;

/// The motions of one wheelset at the contacts' instant.
struct WheelsetMotion {
  double free[kMotions];   // without contact; x and spin of free runners from the stage's start
  double start[kMotions];  // as the last acceleration leads to it
  double rate_at_zero[kMotions];  // rates are `rate` times the motions, and this
};
/// @param u  of move_freely()
void find_motion(const RunnerStage& at, int wheelset, const State& s, const Workspace& w,
                 const double* u, WheelsetMotion& motion) noexcept;

/// Adds the displacements by forces on the wheelsets and of force elements, and the forces of the
/// constraints.
/// @param force  [interface_size()] @param reaction  [constraint_count()]
void move_by(const RunnerModel& runner, const double* force, double* u, double* reaction) noexcept;

/// NewtonProblem::diagonal of a runner's coordinates: with the compliance that force elements meet
/// by themselves. @param diagonal  [interface_size()] out
void find_diagonal(const RunnerModel& runner, double* diagonal) noexcept;

/// Stores the forces on the wheels of a wheelset as a law last found them.
void keep_wheel_forces(const RunnerModel& runner, int wheelset, const WheelsetLaw& law,
                       State& s) noexcept;

struct RunnerResult {
  Status status;
  int iterations;  // the most of Newton's
};

/// Displacements of all runners at the end of a stage on rigid rails, in `solved`, and the forces
/// on their wheels. The wheels meet the rails by Newton's method over the motions of the wheelsets.
RunnerResult solve_runners(const Model& model, const Stage& stage, State& s, Workspace& w) noexcept;

Status status_of(NewtonStatus met) noexcept;

}  // namespace railstep
