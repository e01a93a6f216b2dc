#pragma once
#include "online/math/newton.h"
#include "online/runner/runner_contact.h"

namespace railstep {

/// One runner in a stage, and the instants at which its equation and its contacts hold.
struct RunnerStage {
  const Model& model;
  const RunnerModel& runner;
  const Stage& stage;
  double held;  // fraction of the stage at which the equation of motion holds
  /// Change of a motion's rate at the contacts' instant by a change of the motion there.
  double rate;
  double before(double fraction) const noexcept {
    return stage.before + (1. - fraction) * stage.span;
  }
  double time(double fraction) const noexcept {
    return static_cast<double>(stage.step) * model.scheme.dt - before(fraction);
  }
  /// Where the runner is at an instant of the stage. @param s  at its start
  AlongTrack along(double fraction, const State& s) const noexcept {
    const double rolled = ahead_of(runner, s.u + runner.first) +
                          fraction * stage.span * ahead_of(runner, s.v + runner.first);
    return {stage.step, before(fraction), rolled, ahead_of(runner, s.v + runner.first)};
  }
};
RunnerStage stage_of(const Model& model, const RunnerModel& runner, const Stage& stage) noexcept;

/// The law of one wheelset: its six motions, then those of the seats under its left and right
/// wheel, if they give way: y, z and roll.
struct WheelsetLaw {
  const RunnerModel* runner;
  int wheelset;
  bool seated;
  RailsUnder rails;
  /// Rates are the motions of the wheelset and of the seats times these, plus `rate_at_zero`.
  double rate, seat_rate;
  double ahead;        // speed of the wheelset along the track, m/s
  Rolling rolling[2];  // of its wheels
  /// Motions are those at theta of a step. Rates are those in its middle, this much earlier, s. Yaw
  /// and y, on which creep depends, are also taken there: if they led their rates, hunting would
  /// begin at too high a speed. z and roll, which press the contact's stiff spring, both stay at
  /// theta.
  double later;
  /// On a rail that rises at this rate by its unevenness the contact moves ahead on the wheel, by
  /// as much as makes up for the wheel's own rise, m/s.
  double uneven_rate[2];
  double rate_at_zero[kMotions + 6];
  /// [2] where its wheels touch by their profiles, of find_contacts(); null: treads are cones.
  ProfileWheel* profile;
  /// Where coordinates are scalars, the scalars are the coordinates over these, m/N and rad/(N m):
  /// forces, as those of other laws are. Otherwise the numbers of one matrix differ by 1e19.
  double fold[kMotions + 6];
  double kept[2][kWheelForces];  // State::wheel_force of the last evaluation
  double creepage[2][3];         // State::creepage
  bool lost;                     // a wheel was free there
  bool slides;                   // the creep of a wheel has saturated
  bool at_edge;                  // a wheel touches at the end of a profile

  int size() const noexcept { return seated ? kMotions + 6 : kMotions; }
  /// Scalars of the law: normal force, creep along and across of each cone or patch. If there are
  /// more scalars than coordinates, the coordinates take their place. Known after find_contacts().
  int rank() const noexcept;
  /// Finds where profiles touch. All evaluations keep this until follow_contacts().
  /// @param z  [size] motions to which the step leads, as predicted before it
  void find_contacts(const double* z) noexcept;
  /// Finds the contacts of those wheels again whose planes of contact have turned by more than
  /// 0.005 rad since they were found. @param z  [size] motions @returns whether there is one
  bool follow_contacts(const double* z) noexcept;
  /// Takes `fold` from the compliance of each coordinate, or the largest of them if one is held.
  /// @param Y  [n][n] NewtonProblem::Y @param first  of the law's coordinates in it
  void find_fold(const double* Y, int n, int first) noexcept;
  /// @param slopes  out: of the rank() scalars. How cones turn the directions of forces, and the
  ///                moments of creep, are left out: they change the slopes too little in a step.
  ///                Null: none
  /// @param steep   [rank] out: slopes of the normal forces, by cones the roots of depths; entries
  ///                of other scalars are left
  void evaluate(const double* z, double* force, const LawSlopes* slopes, double* steep) noexcept;

 private:
  struct Placed {
    double u[kMotions], v[kMotions];
    RailsUnder under;
    RailRate moving[2];
  };
  void place(const double* z, Placed& at) const noexcept;
  template <typename Wanted>
  bool find_contacts_where(const double* z, const Wanted& wanted) noexcept;
  int contacts(int side) const noexcept;
  bool is_folded() const noexcept;
  WheelForce on_cone(const Placed& at, int side, const LawSlopes* slopes,
                     double* steep) const noexcept;
  WheelForce on_profile(const Placed& at, int side, const LawSlopes* slopes,
                        double* steep) const noexcept;
};

/// The law of a wheelset without its rates at zero. @param s  at the stage's start
WheelsetLaw law_of(const RunnerStage& at, int wheelset, bool seated, const State& s) noexcept;

/// Solves with the laws of wheelsets, and once more where the solution moved contacts far from
/// where they were found. Where a throat rides on a gauge corner on a rail that gives way, the
/// forces of the last step mislead: each step would overshoot the one before.
/// @param law    [sets]
/// @param z      motions of one wheelset after the other: `solve` starts there, and leaves what it
///               found
/// @param solve  solve(): NewtonResult
template <typename Solve>
NewtonResult solve_and_follow(WheelsetLaw* law, int sets, const double* z,
                              const Solve& solve) noexcept {
  const NewtonResult first = solve();
  bool again = false;
  for (int i = 0; i < sets; ++i, z += law->size(), ++law) again = law->follow_contacts(z) || again;
  if (!again || first.status == NewtonStatus::bad_input) return first;
  NewtonResult last = solve();
  if (first.iterations > last.iterations) last.iterations = first.iterations;
  return last;
}

/// Events of the last evaluation: contact_lost, full_slip, beyond_profile.
Status events_of(const WheelsetLaw& law) noexcept;

}  // namespace railstep
