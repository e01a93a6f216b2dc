#pragma once
#include "online/math/newton.h"
#include "online/model/state.h"
#include "online/runner/runner_contact.h"

namespace railstep {

inline constexpr int kMostInterfaces = kMotions * kMaxWheelsetsOfRunner + kMaxStopsOfRunner;
/// Tolerance of Newton's method: penetrations are differences of lengths that are 1e4 times as
/// large.
inline constexpr double kRunnerTolerance = 1e-10;

/// One runner in a stage, and the instants at which its equation and its contacts hold.
struct RunnerStage {
  const Model& model;
  const RunnerModel& runner;
  const Stage& stage;
  double held;  // fraction of the stage at which the equation of motion holds
  double
      rate;  // change of a motion's rate at the contacts' instant by a change of the motion there
  double before(double fraction) const noexcept {
    return stage.before + (1. - fraction) * stage.span;
  }
  double time(double fraction) const noexcept {
    return static_cast<double>(stage.step) * model.scheme.dt - before(fraction);
  }
};
RunnerStage stage_of(const Model& model, const RunnerModel& runner, const Stage& stage) noexcept;

/// Displacements at the stage's end without contact, and in the state the forces of the
/// constraints.
/// @param u  [size] out
void move_freely(const RunnerStage& at, State& s, const Workspace& w, double* u) noexcept;

/// The motions of one wheelset at the contacts' instant.
struct WheelsetMotion {
  double free[kMotions];          // without contact
  double start[kMotions];         // as the last acceleration leads to it
  double rate_at_zero[kMotions];  // rates are `rate` times the motions, and this
};
/// @param u  of move_freely()
void find_motion(const RunnerStage& at, int wheelset, const State& s, const Workspace& w,
                 const double* u, WheelsetMotion& motion) noexcept;

/// Displacements of a runner's stops at the contacts' instant. @param free, start  [stops] out
void find_stops(const RunnerStage& at, const State& s, const Workspace& w, const double* u,
                double* free, double* start) noexcept;

/// The law of a stop, for solve_laws().
void stop_law(const StopModel& stop, double z, double* force, const LawSlopes* slopes) noexcept;

/// Adds the displacements by forces on the wheelsets and stops, and the forces of the constraints.
/// @param force  [interface_size()] @param reaction  [constraint_count()]
void move_by(const RunnerModel& runner, const double* force, double* u, double* reaction) noexcept;

/// The law of one wheelset: its six motions, then those of the seats under its left and right
/// wheel, if they give way: y, z and roll.
struct WheelsetLaw {
  const RunnerModel* runner;
  int wheelset;
  bool seated;
  RailsUnder rails;
  /// Rates are these times the motions, of the wheelset and of the seats, and `rate_at_zero`.
  double speed, rate, seat_rate;
  /// Motions are those at theta of a step. Rates are in its middle, this much earlier, s, and so
  /// are yaw and y, on which creep depends: where it looks ahead of its rates the vehicle hunts too
  /// late. z and roll, by which the contact's stiff spring is pressed, stay together.
  double later;
  /// On a rail that rises at this rate by its unevenness the contact moves ahead on the wheel, by
  /// as much as makes up for the wheel's own rise, m/s.
  double uneven_rate[2];
  double rate_at_zero[kMotions + 6];
  double kept[2][kWheelForces];  // State::wheel_force of the last evaluation
  bool lost;                     // a wheel was free there
  bool slides;                   // the creep of a wheel has saturated

  int size() const noexcept { return seated ? kMotions + 6 : kMotions; }
  /// @param slopes  out: of the normal and creep forces of both wheels, which are kWheelsetRank
  ///                scalars. How their directions turn, and the creep moment, change it too little
  ///                in a step to be worth their work. Null: none
  /// @param steep   [kWheelsetRank] out: slopes of the normal forces, as roots of depths; of other
  ///                scalars they do not change
  void evaluate(const double* z, double* force, const LawSlopes* slopes, double* steep) noexcept;
};

/// The law of a wheelset without its rates at zero.
WheelsetLaw law_of(const RunnerStage& at, int wheelset, bool seated) noexcept;

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
/// Events of the last evaluation: contact_lost, full_slip.
Status events_of(const WheelsetLaw& law) noexcept;

}  // namespace railstep
