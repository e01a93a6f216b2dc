#include "online/system/system_step.h"

#include "online/math/scalar.h"
#include "online/system/rotation.h"
#include "online/system/row.h"
#include "online/system/rows.h"
#include "online/system/track_ports.h"

namespace railstep {

namespace {

SystemStart start_of(const Model& model, const State& s, const Workspace& w) noexcept {
  const std::int32_t at = model.system.first;
  return {s.u + at, s.v + at, w.u_star + at, w.v_star + at, s.quaternion};
}

/// Squared norm of forces, moments of slopes and rotations over lengths of their parts, N2.
struct Square {
  double sum[kLanes] = {};
  void add(const double* force, const double* per_length) noexcept {
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) {
      const double f = force[l] * per_length[l];
      sum[l] += f * f;
    }
  }
};

/// Start of the iterations: the scheme's step with the last accelerations.
void guess(const Model& model, const State& state, const Workspace& workspace,
           SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double per_kg = 1. / model.scheme.kg;
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i) {
    w.x[i] = workspace.u_star[s.first + i] + per_kg * state.g[s.first + i];
    w.shift[i] = 0.;
  }
  for (std::int32_t r = 0; r < system_rows(s); ++r) w.force[r] = state.row_force[r];
}

struct Size {
  double residual, scale;  // N
  double wanted;           // largest of the joint rows, m or 1
};

/// residual = inertia + elastic - outer + G' force.
Size set_residual(const SystemModel& s, SystemWorkspace& w) noexcept {
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.residual[i] = 0.;
  add_row_forces(s, w.gradient, w.force, w.residual);
  Square rows, inertia, elastic, outer, all;
  for (std::int32_t i = 0; i < s.unknowns; i += kLanes) {  // whole panels
    const double* per_length = s.per_length + i;
    rows.add(w.residual + i, per_length);
    inertia.add(w.inertia + i, per_length);
    elastic.add(w.elastic + i, per_length);
    outer.add(w.outer + i, per_length);
#pragma omp simd
    for (int l = 0; l < kLanes; ++l)
      w.residual[i + l] += (w.inertia[i + l] + w.elastic[i + l]) - w.outer[i + l];
    all.add(w.residual + i, per_length);
  }
  double scale = lane_sum(rows.sum);
  for (const Square* kind : {&inertia, &elastic, &outer})
    if (const double own = lane_sum(kind->sum); own > scale) scale = own;
  double sum = lane_sum(all.sum);
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r)
    sum += w.spring_lack[r] * w.spring_lack[r];
  return {square_root(sum), square_root(scale), 0.};
}

/// One Newton step with the present matrix: row forces, then displacements.
/// @param w  w.change must be that of the parts without rows
void newton_step(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const std::int32_t rows = system_rows(s);
  add_row_changes(s, w.slope, w.change, w.wanted);
  solve_rows(model, w, true, w.wanted);
  for (std::int32_t r = 0; r < rows; ++r) w.force[r] += w.wanted[r];
  subtract_row_motion(s, w, w.wanted, w.change);
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.x[i] += w.change[i];
}

/// Largest entry of a Newton step.
double step_size(const SystemModel& s, const SystemWorkspace& w) noexcept {
  double size[kLanes] = {};
  for (std::int32_t i = 0; i < s.unknowns; i += kLanes)
#pragma omp simd
    for (int l = 0; l < kLanes; ++l) size[l] = larger(size[l], magnitude(w.change[i + l]));
  double most = 0.;
  for (const double own : size) most = larger(most, own);
  return most;
}

/// Whether a Newton step is the round-off of the positions, or is small and not smaller than the
/// one before: further steps would change nothing, for any residual of the forces.
/// @param step    its size; 0: no step yet
/// @param before  size of the step before; 0: no step yet
bool is_settled(const SystemModel& s, const SystemWorkspace& w, double step,
                double before) noexcept {
  if (!(step > 0.) || step > 1e-6) return false;  // places stay below 1000 km
  double place = 0.;
  for (std::int32_t i = 0; i < s.unknowns; ++i) place = larger(place, magnitude(w.x[i]));
  for (std::int32_t b = 0; b < s.beams; ++b)
    for (std::int32_t i = 0; i < s.beam[b].unknowns; ++i)
      place = larger(place, magnitude(w.nodes[s.beam[b].first + i]));
  for (std::int32_t m = 0; m < s.markers - s.sensors; ++m)
    for (const double p : w.pose[m].point) place = larger(place, magnitude(p));
  constexpr double ulp = 2.3e-16;
  return step <= 4. * ulp * place ||
         (step <= 4096. * ulp * place && step > .5 * before && before > 0.);
}

/// Gear, Gupta, Leimkuhler: forces hold velocities, and a shift of the positions holds Phi, both in
/// the metric of Newton's matrix. The shift takes the part of Phi that remains after the change by
/// the velocities.
void shift_step(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.change[i] = 0.;
  for (std::int32_t r = 0; r < system_rows(s); ++r)
    w.wanted[r] = r < s.joint_rows ? w.value[r] - w.velocity_part[r] : 0.;
  solve_rows(model, w, false, w.wanted);
  subtract_row_motion(s, w, w.wanted, w.change);
  for (std::int32_t i = 0; i < s.unknowns; ++i) {
    w.x[i] += w.change[i];
    w.shift[i] += w.change[i];
  }
}

/// Extensions of springs at the step's start.
void start_springs(const Model& model, double time, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r) {
    const RowModel& row = s.row[r];
    const double length = row.motion >= 0 ? motion_at(s, row.motion, time).x : row.offset;
    w.start_value[r] = row_value(row, w.start_pose[row.a], w.start_pose[row.b], length);
  }
}

/// First and second rates of the joint rows.
void set_rates(const SystemModel& s, double time, const Motions& at, SystemWorkspace& w) noexcept {
  MarkerJet a{}, b{};
  std::int32_t at_a = -1, at_b = -1;  // rows of a joint share their markers
  for (std::int32_t r = 0; r < s.joint_rows; ++r) {
    const RowModel& row = s.row[r];
    if (row.a != at_a) a = marker_jet(s, s.marker[at_a = row.a], at);
    if (row.b != at_b) b = marker_jet(s, s.marker[at_b = row.b], at);
    const Jet motion = row.motion >= 0 ? motion_at(s, row.motion, time) : Jet{row.offset, 0., 0.};
    const Jet phi = row_jet(row, a, b, motion);
    w.rate[0][r] = phi.v;
    w.rate[1][r] = phi.a;
  }
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r) w.rate[0][r] = w.rate[1][r] = 0.;
}

/// Puts the rates of an order into `wanted`. @returns the largest
double want_rates(const SystemModel& s, int order, SystemWorkspace& w) noexcept {
  double largest = 0.;
  for (std::int32_t r = 0; r < system_rows(s); ++r) {
    w.wanted[r] = w.rate[order - 1][r];
    if (!(magnitude(w.wanted[r]) <= largest)) largest = magnitude(w.wanted[r]);
  }
  return largest;
}

/// Removes from velocities (order 1) or accelerations (2) of the model the part that joints do not
/// allow, in the metric of Newton's matrix (Bayo and Ledesma 1996; Cuadrado and others 1997),
/// capped. `second` takes the same change. Forces change with accelerations: S of a body is kg M,
/// so that M g + G' force keeps its value. The rates must be set before, and are set after.
/// @returns whether the rates are held
bool project(const Model& model, double time, int order, const Motions& at, double* rates,
             double* second, double* row_force, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double per_step = 1. / model.scheme.dt;
  const double tolerance = s.joint_tolerance * (order == 1 ? per_step : per_step * per_step);
  for (std::int32_t done = 0;; ++done) {
    if (want_rates(s, order, w) <= tolerance) return true;
    if (done == s.projections) return false;
    solve_rows(model, w, false, w.wanted);
    if (row_force != nullptr)
      for (std::int32_t r = 0; r < s.joint_rows; ++r) row_force[r] += w.wanted[r] / model.scheme.kg;
    for (double* const taken : {rates, second}) {
      if (taken == nullptr) continue;
      subtract_row_motion(s, w, w.wanted, taken + s.first);
      subtract_line_motion(model, w.gradient, w.wanted, taken, nullptr);  // banded ones alone
    }
    set_rates(s, time, at, w);
  }
}

/// Whether the matrix is made again before iteration `done`. In the second half of the cap it
/// always is: a step that is so far off must not fail for an old matrix.
bool is_renewed(const SystemModel& s, const SystemTangent& t, std::int32_t done,
                bool slow) noexcept {
  if (s.renew == Renew::every_iteration || slow || 2 * done >= s.cap) return true;
  if (done > 0) return false;
  return s.renew == Renew::every_step || !(*t.age > 0.) ||
         *t.age > static_cast<double>(s.keep_steps);
}

/// Names the rows that depended on others when the matrix was made.
void name_redundant(const SystemModel& s, const SystemTangent& t, SystemResult& result) noexcept {
  const auto rank = static_cast<std::int32_t>(*t.rank);
  result.redundant_rows = s.joint_rows - rank;
  if (result.redundant_rows > 0) result.status = result.status | Status::redundant_joint;
  for (std::int32_t i = 0; i < result.redundant_rows && i < kMostNamedRows; ++i)
    result.redundant_row[i] = t.order[rank + i];
}

/// Progress of the iterations: residuals of forces and targets of joints, each against the last
/// one.
struct Search {
  double residual = __builtin_inf(), wanted = __builtin_inf();
  double step = 0., before = 0.;  // sizes of the last two Newton steps
  bool old = true;                // the matrix is of an earlier step
  bool slow = false;              // one did not halve with an old matrix: make it again
  bool grown = false;  // one grew, far off perhaps, with a matrix of an earlier step: begin again

  /// Joints count only with matrices of an earlier step: soft rows yield in proportion to their
  /// force, so that a good step may leave more of Phi than the guess had.
  void compare(const Size& left, double tolerance, bool renew) noexcept {
    const bool was = old && !renew;  // this iterate came by a matrix of an earlier step
    const auto exceeds = [&](double fraction) {
      return !(left.residual <= fraction * residual) ||
             (was && left.wanted > tolerance && !(left.wanted <= fraction * wanted));
    };
    slow = !renew && exceeds(.5);
    grown = was && exceeds(1.);
    residual = left.residual;
    wanted = left.wanted;
  }
  void begin_again() noexcept {
    residual = wanted = __builtin_inf();
    step = before = 0.;
    slow = true;
    grown = false;
  }
};

/// Sets positions of the iterate and takes all forces and rows there.
Size look(const Model& model, const State& state, const SystemStart& start, bool renew,
          SystemWorkspace& w, SystemResult& result) noexcept {
  const double time = static_cast<double>(state.steps + 1) * model.scheme.dt;
  const SystemModel& s = model.system;
  place_parts(model, start, w);
  part_forces(model, start, renew, w);
  outer_forces(model, s.mean != 0 ? time - .5 * model.scheme.dt : time, state.input, w);
  const double wanted = set_rows(model, time, renew, w);
  Size left = set_residual(s, w);
  left.wanted = wanted;
  result.violation = joint_violation(s, w);
  result.force_residual = left.scale > 0. ? left.residual / left.scale : 0.;
  return left;
}

bool is_done(const SystemModel& s, const SystemWorkspace& w, const Size& left, const Search& search,
             const SystemResult& result) noexcept {
  if (!(left.wanted <= s.joint_tolerance)) return false;
  if (s.constraint_method == ConstraintMethod::gear_gupta_leimkuhler &&
      !(result.violation <= s.joint_tolerance))
    return false;
  return result.force_residual <= s.tolerance || is_settled(s, w, search.step, search.before);
}

}  // namespace

void begin_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  const SystemStart start = start_of(model, state, workspace);
  guess(model, state, workspace, w);
  place_start(model, start, w);
  const double time = static_cast<double>(state.steps + 1) * model.scheme.dt;
  if (s.mean != 0) start_springs(model, time - model.scheme.dt, w);
  if (s.renew == Renew::kept) *w.tangent.age += *w.tangent.age > 0. ? 1. : 0.;
}

SystemResult solve_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  const SystemStart start = start_of(model, state, workspace);
  SystemResult result{};
  Search search;
  for (std::int32_t done = 0;; ++done) {
    const bool renew = is_renewed(s, w.tangent, done, search.slow);
    const Size left = look(model, state, start, renew, w, result);
    if (done > 0 && is_done(s, w, left, search, result)) break;
    if (done == s.cap) {
      result.status = Status::cap_reached;
      break;
    }
    result.iterations = done + 1;
    search.compare(left, s.joint_tolerance, renew);
    if (search.grown) {
      search.begin_again();
      guess(model, state, workspace, w);
      continue;
    }
    if (renew) {
      search.old = false;
      solve_ends(model, true, w);
      factor_rows(model, w);
      *w.tangent.age = 1.;
    } else {
      solve_parts(model, w);
    }
    newton_step(model, w);
    search.before = search.step;
    search.step = step_size(s, w);
    if (s.constraint_method == ConstraintMethod::gear_gupta_leimkuhler) shift_step(model, w);
  }
  name_redundant(s, w.tangent, result);
  return result;
}

void leave_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  if (s.ports > 0) {
    solve_ports(s, w);
    for (std::int32_t i = 0; i < 9 * s.ports; ++i)
      w.x[s.port[0].first + i] += w.change[s.port[0].first + i];
    subtract_line_motion(model, w.gradient, w.force, workspace.solved, workspace.imaginary);
  }
  for (std::int32_t i = 0; i < s.unknowns; ++i) workspace.solved[s.first + i] = w.x[i] - w.shift[i];
  for (std::int32_t r = 0; r < system_rows(s); ++r) state.row_force[r] = w.force[r];
  for (std::int32_t i = 0; i < 4 * s.bodies; ++i) state.quaternion[i] = w.quaternion[i];
}

Status finish_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  double* const u = state.u + s.first;
  if (s.constraint_method == ConstraintMethod::gear_gupta_leimkuhler)
    for (std::int32_t i = 0; i < s.unknowns; ++i) u[i] += w.shift[i];
  for (std::int32_t b = 0; b < s.bodies; ++b)
    for (int c = 3; c < 6; ++c)
      if (const std::int32_t k = s.body[b].column[c]; k >= 0) u[s.body[b].first + k] = 0.;
  if (s.constraint_method != ConstraintMethod::augmented_lagrangian || s.mean != 0 ||
      s.joint_rows == 0)
    return Status::ok;
  if (s.renew == Renew::kept) {  // old directions of the joints would remove allowed motion
    solve_ends(model, false, w);
    factor_rows(model, w);
  }
  const Motions at{u, state.v + s.first, state.g + s.first, w.matrix};
  const double time = static_cast<double>(state.steps + 1) * model.scheme.dt;
  set_rates(s, time, at, w);
  const bool velocities = project(model, time, 1, at, state.v, nullptr, nullptr, w);
  const bool accelerations = project(model, time, 2, at, state.g, state.a, state.row_force, w);
  return velocities && accelerations ? Status::ok : Status::cap_reached;
}

}  // namespace railstep
