#include "online/runner/runner_step.h"

#include "online/math/dense.h"
#include "online/runner/runner_contact.h"
#include "online/runner/suspended.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// The forces of the frames' acceleration and the wheelsets' spins, N and N m. The gyroscopic
/// moments are those of the rates that the last acceleration leads to.
/// @param force  [size] out
void find_frame_forces(const RunnerStage& at, const State& s, const Workspace& w,
                       double* force) noexcept {
  const RunnerModel& r = at.runner;
  const Travelled way = travelled(r.travel, at.time(at.held));
  const double later = at.held * at.model.scheme.kv / at.model.scheme.kg;
  const auto rate = [&](std::int32_t k) noexcept {
    const double v0 = s.v[r.first + k], v1 = w.v_star[r.first + k];
    return (v0 + at.held * (v1 - v0)) + later * s.g[r.first + k];
  };
  for (std::int32_t k = 0; k < r.size; ++k) force[k] = 0.;
  for (std::int32_t b = 0; b < r.bodies; ++b)
    force[kMotions * b] -= r.mass[kMotions * b] * way.acceleration;
  for (std::int32_t i = 0; i < r.wheelsets; ++i) {
    const RunnerWheelset& set = r.wheelset[i];
    const std::int32_t roll = set.first + index_of(BodyMotion::roll),
                       spin = set.first + index_of(BodyMotion::pitch),
                       yaw = set.first + index_of(BodyMotion::yaw);
    const double beyond = r.rolls_freely != 0 ? s.v[r.first + spin] : 0.;
    const double momentum = set.spin_inertia * (way.speed / set.radius + beyond);
    force[roll] += momentum * rate(yaw);
    force[yaw] -= momentum * rate(roll);
    force[spin] -= set.spin_inertia * (way.acceleration / set.radius);
  }
  if (!is_there(at.model.design_line)) return;
  OnLine on = on_line(at.model, r, at.along(at.held, s));
  if (r.rolls_freely != 0) {
    on.faster += (rate(0) - s.v[r.first]) / (at.held * at.stage.span);
    on.speed = way.speed + rate(0);
  }
  // The motions to which the last acceleration leads.
  double u[kMaxRunnerUnknowns];
  for (std::int32_t k = 0; k < r.size; ++k) {
    const double before = s.u[r.first + k];
    const double end = w.u_star[r.first + k] + s.g[r.first + k] / at.model.scheme.kg;
    u[k] = before + at.held * (end - before);
  }
  add_line_forces(at.model, r, on, at.model.scheme.dt, u, s.v + r.first, force);
}

/// Keeps the lengths of rods between bodies whose frames stand turned and aside of each other.
void keep_rods(const RunnerStage& at, const State& s, double* u, double* reaction) noexcept {
  const RunnerModel& r = at.runner;
  const std::int32_t poses = kMotions * r.frames.pairs;
  double pose[kMostPoses];
  static_cast<void>(poses_of(at.model, r, at.along(1., s), pose));
  columns_multiply_add(r.frames.rod_moved, pose, u, r.size, poses);
  for (std::int32_t c = 0; c < constraint_count(r); ++c)
    reaction[c] += by_poses(r, r.frames.rod_reaction, c, pose);
}

/// The way of a runner that rolls freely and the spins of its wheelsets, which grow without end and
/// strain nothing but what holds to the ground: sums of large numbers would leave a force.
/// @param force  [size] adds what ground takes of the way
/// @param from   [size] out
void leave_way(const RunnerModel& r, const State& s, double* force, double* from) noexcept {
  const double way = s.u[r.first];
  for (std::int32_t k = 0; k < r.size; ++k) {
    from[k] = 0.;
    force[k] -= r.by_way[k] * way;
  }
  for (std::int32_t b = 0; b < r.bodies; ++b) from[kMotions * b] = way;
  for (std::int32_t i = 0; i < r.wheelsets; ++i) {
    const std::int32_t spin = r.wheelset[i].first + index_of(BodyMotion::pitch);
    from[spin] = s.u[r.first + spin];
  }
}

}  // namespace

void move_freely(const RunnerStage& at, State& s, const Workspace& w, double* u) noexcept {
  const RunnerModel& r = at.runner;
  double force[kMaxRunnerUnknowns], from[kMaxRunnerUnknowns];
  find_frame_forces(at, s, w, force);
  const bool free = r.rolls_freely != 0;
  if (free) leave_way(r, s, force, from);
  move_freely(at.model, r, at.time(at.held), s, w, free ? from : nullptr, force, u);
  double* const reaction = reactions_of(at.model, s, r);
  for (std::int32_t c = 0; c < constraint_count(r); ++c)
    reaction[c] = dot(r.reaction + std::ptrdiff_t{r.size} * c, force, r.size);
  if (r.rods > 0 && is_there(at.model.design_line)) keep_rods(at, s, u, reaction);
}

void find_motion(const RunnerStage& at, int wheelset, const State& s, const Workspace& w,
                 const double* u, WheelsetMotion& motion) noexcept {
  const Scheme& c = at.model.scheme;
  for (int k = 0; k < kMotions; ++k) {
    const std::int32_t own = at.runner.wheelset[wheelset].first + k, all = at.runner.first + own;
    motion.free[k] = s.u[all] + c.theta * (u[own] - s.u[all]);
    motion.start[k] = s.u[all] + c.theta * ((w.u_star[all] + s.g[all] / c.kg) - s.u[all]);
    motion.rate_at_zero[k] =
        at.held < 1. ? -at.rate * s.u[all] : w.v_star[all] - at.rate * w.u_star[all];
    const bool grows = k == index_of(BodyMotion::x) || k == index_of(BodyMotion::pitch);
    if (at.runner.rolls_freely == 0 || !grows) continue;
    // A way counts from the stage's start: Newton's method ends by the size of its coordinates.
    motion.free[k] -= s.u[all];
    motion.start[k] -= s.u[all];
    motion.rate_at_zero[k] += at.rate * s.u[all];
  }
}

void move_by(const RunnerModel& runner, const double* force, double* u, double* reaction) noexcept {
  const auto add = [&](const double* column, double by) noexcept {
#pragma omp simd
    for (std::int32_t k = 0; k < runner.size; ++k) u[k] += column[k] * by;
  };
  const std::int32_t motions = kMotions * runner.wheelsets;
  for (std::int32_t i = 0; i < motions; ++i) {
    const std::int32_t own = runner.wheelset[i / kMotions].first + i % kMotions;
    add(runner.inverse + std::ptrdiff_t{runner.size} * own, force[i]);
    for (std::int32_t c = 0; c < constraint_count(runner); ++c)
      reaction[c] += runner.reaction[std::ptrdiff_t{runner.size} * c + own] * force[i];
  }
  for (std::int32_t j = 0; j < runner.element_coordinates; ++j) {
    const double* const row = runner.element_row + std::ptrdiff_t{runner.size} * j;
    add(runner.element_moved + std::ptrdiff_t{runner.size} * j, force[motions + j]);
    for (std::int32_t c = 0; c < constraint_count(runner); ++c)
      reaction[c] += dot(runner.reaction + std::ptrdiff_t{runner.size} * c, row, runner.size) *
                     force[motions + j];
  }
}

void find_diagonal(const RunnerModel& r, double* diagonal) noexcept {
  const std::int32_t n = interface_size(r), motions = kMotions * r.wheelsets;
  for (std::int32_t i = 0; i < n; ++i)
    diagonal[i] = r.compliance[i * n + i] + (i < motions ? 0. : r.element_compliance[i - motions]);
}

Status status_of(NewtonStatus met) noexcept {
  switch (met) {
    case NewtonStatus::converged:
      return Status::ok;
    case NewtonStatus::cap_reached:
      return Status::cap_reached;
    case NewtonStatus::weak_pivot:
    case NewtonStatus::bad_input:
      break;
  }
  return Status::contact_ill_posed;
}

namespace {

RunnerResult solve_runner(const RunnerStage& at, State& s, Workspace& w) noexcept {
  const RunnerModel& r = at.runner;
  double* const u = w.solved + r.first;
  move_freely(at, s, w, u);
  LawBlock block[kMaxWheelsetsOfRunner + kMaxForceElements];
  WheelsetLaw law[kMaxWheelsetsOfRunner];
  double z_free[kMostInterfaces], z[kMostInterfaces], force[kMostInterfaces];
  for (int i = 0; i < r.wheelsets; ++i) {
    WheelsetMotion motion;
    find_motion(at, i, s, w, u, motion);
    law[i] = law_of(at, i, false, s);
    if (has_profiles(r.contact)) law[i].profile = profile_wheels(w, r.first_wheelset + i);
    for (int k = 0; k < kMotions; ++k) {
      z_free[kMotions * i + k] = motion.free[k];
      z[kMotions * i + k] = motion.start[k];
      law[i].rate_at_zero[k] = motion.rate_at_zero[k];
    }
    law[i].find_contacts(z + kMotions * i);
    law[i].find_fold(r.compliance, interface_size(r), kMotions * i);
  }
  const std::int32_t motions = kMotions * r.wheelsets;
  find_elements(at, s, w, u, z_free + motions, z + motions);
  for (std::int32_t j = 0; j < r.force_elements; ++j)
    block[r.wheelsets + j] = element_block(r.force_element[j], motions);
  double diagonal[kMostInterfaces];
  find_diagonal(r, diagonal);
  const NewtonResult met = solve_and_follow(law, r.wheelsets, z, [&]() noexcept {
    for (int i = 0; i < r.wheelsets; ++i) block[i] = {kMotions * i, kMotions, law[i].rank()};
    return solve_laws(
        {interface_size(r), r.wheelsets + r.force_elements, r.compliance, block, z_free, w.newton,
         kRunnerTolerance, r.force_elements > 0 ? diagonal : nullptr},
        [&](int b, const double* at_z, double* f, const LawSlopes* slopes, double* steep) noexcept {
          const int element = b - r.wheelsets;
          if (element < 0) return law[b].evaluate(at_z, f, slopes, steep);
          evaluate_element(r, element, w, at_z, f, slopes);
        },
        force, z);
  });
  // The last point that was tried need not be the best one.
  double steep[kMostLaw];
  for (int i = 0; i < r.wheelsets && met.status != NewtonStatus::converged; ++i)
    law[i].evaluate(z + kMotions * i, force + kMotions * i, nullptr, steep);
  move_by(r, force, u, reactions_of(at.model, s, r));
  keep_elements(r, z + motions, force + motions, w, s);
  RunnerResult result{status_of(met.status), met.iterations};
  for (int i = 0; i < r.wheelsets; ++i) {
    result.status = result.status | events_of(law[i]);
    keep_wheel_forces(r, i, law[i], s);
  }
  return result;
}

}  // namespace

void keep_wheel_forces(const RunnerModel& runner, int wheelset, const WheelsetLaw& law,
                       State& s) noexcept {
  const std::int32_t set = runner.first_wheelset + wheelset;
  for (int side = 0; side < 2; ++side) {
    for (int d = 0; d < kWheelForces; ++d) wheel_force_of(s, set, side)[d] = law.kept[side][d];
    if (runner.rolls_freely == 0) continue;
    double* const creepage = creepage_of(s, set, side);
    for (int k = 0; k < 3; ++k) creepage[k] = law.creepage[side][k];
    creepage[3] = law.rolling[side].over < 0. ? -1. : 1.;
  }
}

RunnerResult solve_runners(const Model& model, const Stage& stage, State& s,
                           Workspace& w) noexcept {
  RunnerResult sum{Status::ok, 0};
  for (std::int32_t i = 0; i < model.runners; ++i) {
    const RunnerResult own = solve_runner(stage_of(model, model.runner[i], stage), s, w);
    sum.status = sum.status | own.status;
    if (own.iterations > sum.iterations) sum.iterations = own.iterations;
  }
  return sum;
}

}  // namespace railstep
