#include "online/runner/force_elements.h"

#include "online/math/dense.h"
#include "online/runner/body_force.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// ForceElement::value at a time: limits and damping are never below 0.
double value_at(const ForceElement& e, double time, const State& s) noexcept {
  if (has_curve(e.law)) return 0.;
  const double value = force_at(e.value, time, s.input);
  return value > 0. || e.law == ElementLaw::actuator ? value : 0.;
}

/// Whether the force of an element between two bodies follows its rate.
bool is_damped(const ForceElement& e) noexcept {
  return e.law == ElementLaw::damper || e.law == ElementLaw::controlled ||
         (e.damping > 0. && !is_brake(e));
}
bool has_dampers(const RunnerModel& r) noexcept {
  bool any = false;
  for (std::int32_t j = 0; j < r.force_elements; ++j) any = any || is_damped(r.force_element[j]);
  return any;
}

const double* row_of(const RunnerModel& r, std::int32_t coordinate) noexcept {
  return r.element_row + std::ptrdiff_t{r.size} * coordinate;
}

/// Displacements of a runner's elements by its motions and by the poses of its frames.
/// @param poses, poses_before  at the contacts' instant and at the stage's start; null: no line
struct Moving {
  const RunnerStage& at;
  const State& s;
  const Workspace& w;
  const double *u, *poses, *poses_before;

  double by_motions(std::int32_t row, const double* values) const noexcept {
    return dot(row_of(at.runner, row), values + at.runner.first, at.runner.size);
  }
  double posed(std::int32_t row, const double* at_poses) const noexcept {
    return at_poses == nullptr
               ? 0.
               : by_poses(at.runner, at.runner.frames.elements_moved, row, at_poses);
  }
  void find(std::int32_t row, double& free, double& start) const noexcept {
    const Scheme& c = at.model.scheme;
    const double before = by_motions(row, s.u), moved = posed(row, poses);
    free = before + c.theta * (dot(row_of(at.runner, row), u, at.runner.size) - before);
    start = before + c.theta * ((by_motions(row, w.u_star) + by_motions(row, s.g) / c.kg) - before);
    if (poses == nullptr) return;
    free += moved;
    start += moved;
  }
  /// The rate of a displacement at which all motions are 0.
  double rate_at_zero(std::int32_t row) const noexcept {
    const double own = at.held < 1.
                           ? -at.rate * by_motions(row, s.u)
                           : by_motions(row, w.v_star) - at.rate * by_motions(row, w.u_star);
    if (poses_before == nullptr) return own;
    const double moved = posed(row, poses);
    return own - at.rate * moved +
           (moved - posed(row, poses_before)) / (at.model.scheme.theta * at.stage.span);
  }
};

}  // namespace

void find_elements(const RunnerStage& at, const State& s, const Workspace& w, const double* u,
                   double* free, double* start) noexcept {
  const RunnerModel& r = at.runner;
  if (r.force_elements == 0) return;
  const double theta = at.model.scheme.theta, time = at.time(theta);
  double pose[kMostPoses], before[kMostPoses];
  const double* const poses = poses_of(at.model, r, at.along(theta, s), pose);
  const double* const poses_before =
      poses != nullptr && has_dampers(r) ? poses_of(at.model, r, at.along(0., s), before) : nullptr;
  const Moving moving{at, s, w, u, poses, poses_before};
  const Travelled frame = travelled(r.travel, time);
  for (std::int32_t j = 0; j < r.force_elements; ++j) {
    const ForceElement& e = r.force_element[j];
    const std::int32_t i = e.coordinate;
    ElementStep& step = w.element_step[r.first_force_element + j];
    step = {s.element_memory + e.memory, value_at(e, time, s), at.rate, 0.};
    moving.find(i, free[i], start[i]);
    if (e.loaded != 0) moving.find(i + 1, free[i + 1], start[i + 1]);
    // Whole turns of a brake count from its memory.
    const double from = is_friction(e.law) ? e.per_way * frame.distance - step.memory[0] : 0.;
    free[i] += from;
    start[i] += from;
    if (e.law != ElementLaw::spring)
      step.rate_at_zero = e.per_way * frame.speed - at.rate * from + moving.rate_at_zero(i);
    start[i] -= r.element_compliance[i] *
                element_force(e, step, start[i], e.loaded != 0 ? start[i + 1] : 0.).force;
  }
}

void evaluate_element(const RunnerModel& runner, std::int32_t j, const Workspace& w,
                      const double* z, double* force, const LawSlopes* slopes) noexcept {
  const ForceElement& e = runner.force_element[j];
  const bool loaded = e.loaded != 0;
  const ElementForce own =
      element_force_behind(e, w.element_step[runner.first_force_element + j],
                           runner.element_compliance[e.coordinate], z[0], loaded ? z[1] : 0.);
  force[0] = own.force;
  if (loaded) force[1] = 0.;
  if (slopes == nullptr) return;
  slopes->spread[0] = 1.;
  slopes->slope[0] = own.slope;
  if (!loaded) return;
  slopes->spread[1] = 0.;
  slopes->slope[1] = own.load_slope;
}

void keep_elements(const RunnerModel& runner, const double* z, const double* force,
                   const Workspace& w, State& s) noexcept {
  for (std::int32_t j = 0; j < runner.force_elements; ++j) {
    const ForceElement& e = runner.force_element[j];
    const std::int32_t i = e.coordinate;
    keep_element(e, w.element_step[runner.first_force_element + j],
                 z[i] + runner.element_compliance[i] * force[i], e.loaded != 0 ? z[i + 1] : 0.,
                 s.element_memory + e.memory);
  }
}

StandingElement standing_element(const Model& model, const RunnerModel& runner, std::int32_t j,
                                 const State& at, const double* poses) noexcept {
  const ForceElement& e = runner.force_element[j];
  const double time = static_cast<double>(at.steps) * model.scheme.dt;
  const auto moved = [&](std::int32_t row) noexcept {
    double z = dot(row_of(runner, row), at.u + runner.first, runner.size);
    if (poses != nullptr) z += by_poses(runner, runner.frames.elements_moved, row, poses);
    return z;
  };
  ElementStep step{at.element_memory + e.memory, value_at(e, time, at), 0., 0.};
  double z = moved(e.coordinate);
  if (e.law != ElementLaw::spring) {
    const Travelled frame = travelled(runner.travel, time);
    z += e.per_way * frame.distance;
    step.rate_at_zero = dot(row_of(runner, e.coordinate), at.v + runner.first, runner.size) +
                        e.per_way * frame.speed;
  }
  if (is_damped(e) && poses != nullptr) {
    double before[kMostPoses];
    if (const double* const last = poses_before(model, runner, at, before); last != nullptr)
      step.rate_at_zero += (by_poses(runner, runner.frames.elements_moved, e.coordinate, poses) -
                            by_poses(runner, runner.frames.elements_moved, e.coordinate, last)) /
                           model.scheme.dt;
  }
  const double from = is_friction(e.law) ? z - step.memory[0] : z;
  const double load = e.loaded != 0 ? moved(e.coordinate + 1) : 0.;
  // Nothing damps the rate of a displacement without mass: the spring's force is the damper's.
  if (e.law == ElementLaw::damper && e.loaded != 0)
    return {step, z, z, load, {-e.load_stiffness * load, 0., 0.}};
  return {step, z, from, load, element_force(e, step, from, load)};
}

}  // namespace railstep
