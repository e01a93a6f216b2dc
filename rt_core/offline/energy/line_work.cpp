#include "offline/energy/line_work.h"

#include "offline/energy/suspended_energy.h"

namespace railstep {
namespace {

/// A runner at an instant: where it is, and its motions and rates.
struct RunnerAt {
  AlongTrack where;
  Eigen::VectorXd u, v;
};
RunnerAt in_state(const RunnerModel& runner, const State& at) {
  return {along_in(runner, at), part_of(runner, at.u), part_of(runner, at.v)};
}
/// In the middle of a step.
RunnerAt halfway(const Model& model, const RunnerModel& runner, const State& from,
                 const State& to) {
  RunnerAt a = in_state(runner, from), b = in_state(runner, to);
  const auto mean = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return .5 * (x + y);
  };
  return {{to.steps, .5 * model.scheme.dt, .5 * (a.where.ahead + b.where.ahead),
           .5 * (a.where.speed + b.where.speed)},
          mean(a.u, b.u),
          mean(a.v, b.v)};
}

/// Forces of a design line over all coordinates.
/// @param gained  acceleration of a free runner over its frame, m/s2
Eigen::VectorXd line_forces(const Model& model, const RunnerModel& runner, const RunnerAt& at,
                            double gained) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(runner.size);
  if (!is_there(model.design_line)) return force;
  OnLine on = on_line(model, runner, at.where);
  on.faster += gained;
  add_line_forces(model, runner, on, model.scheme.dt, at.u.data(), at.v.data(), force.data());
  return force;
}

}  // namespace

std::vector<StandingElement> standing_elements(const Model& model, const RunnerModel& runner,
                                               const State& at) {
  std::vector<double> pose(kMostPoses);
  const double* const poses = poses_of(model, runner, along_in(runner, at), pose.data());
  std::vector<StandingElement> all;
  all.reserve(static_cast<std::size_t>(runner.force_elements));
  for (std::int32_t j = 0; j < runner.force_elements; ++j)
    all.push_back(standing_element(model, runner, j, at, poses));
  return all;
}

Eigen::VectorXd line_forces(const Model& model, const RunnerModel& runner, const State& at) {
  return line_forces(model, runner, in_state(runner, at), 0.);
}

double frames_work(const Model& model, const RunnerModel& runner, const State& from,
                   const State& to, const Eigen::VectorXd& du) {
  if (!is_there(model.design_line)) return 0.;
  const double dt = model.scheme.dt;
  const double gained =
      (ahead_of(runner, to.v + runner.first) - ahead_of(runner, from.v + runner.first)) / dt;
  const RunnerAt before = in_state(runner, from), after = in_state(runner, to);
  const Eigen::VectorXd force =
      model.form == Form::condensed
          ? line_forces(model, runner, halfway(model, runner, from, to), gained)
          : Eigen::VectorXd(.5 * (line_forces(model, runner, before, gained) +
                                  line_forces(model, runner, after, gained)));
  double sum = force.dot(du);
  const double way =
      on_line(model, runner, after.where).place - on_line(model, runner, before.where).place;
  for (std::int32_t i = 0; i < runner.wheelsets && runner.rolls_freely == 0; ++i)
    sum += force[runner.wheelset[i].first + index_of(BodyMotion::pitch)] *
           (way / runner.wheelset[i].radius);
  std::vector<double> pose(2 * std::size_t{kMostPoses});
  const double *const first = poses_of(model, runner, before.where, pose.data()),
                      *const last = poses_of(model, runner, after.where, pose.data() + kMostPoses);
  const std::vector<StandingElement> was = standing_elements(model, runner, from),
                                     is = standing_elements(model, runner, to);
  for (std::size_t j = 0; j < was.size(); ++j) {
    const std::int32_t row = runner.force_element[j].coordinate;
    sum -= .5 * (was[j].force.force + is[j].force.force) *
           (by_poses(runner, runner.frames.elements_moved, row, last) -
            by_poses(runner, runner.frames.elements_moved, row, first));
  }
  for (std::int32_t j = 0; j < runner.rods; ++j)
    sum += .5 *
           (reactions_of(model, from, runner)[1 + j] + reactions_of(model, to, runner)[1 + j]) *
           (by_poses(runner, runner.frames.rods, j, last) -
            by_poses(runner, runner.frames.rods, j, first));
  return sum;
}

}  // namespace railstep
