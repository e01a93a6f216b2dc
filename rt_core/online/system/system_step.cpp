#include "online/system/system_step.h"

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

double square_root(double x) noexcept { return __builtin_sqrt(x); }

/// Norm of forces, moments of slopes and turns over lengths of their parts, N.
double force_norm(const SystemModel& s, const double* force) noexcept {
  double sum = 0.;
  for (std::int32_t i = 0; i < s.unknowns; ++i) {
    const double f = force[i] * s.per_length[i];
    sum += f * f;
  }
  return square_root(sum);
}

/// Where the iterations begin: the scheme's step with the last accelerations.
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
};

/// residual = inertia + elastic - outer + G' force.
Size set_residual(const SystemModel& s, SystemWorkspace& w) noexcept {
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.residual[i] = 0.;
  add_row_forces(s, w.gradient, w.force, w.residual);
  double scale = force_norm(s, w.residual);
  for (const double* kind : {w.inertia, w.elastic, w.outer})
    if (const double own = force_norm(s, kind); own > scale) scale = own;
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i)
    w.residual[i] += (w.inertia[i] + w.elastic[i]) - w.outer[i];
  double sum = 0.;
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r)
    sum += w.spring_lack[r] * w.spring_lack[r];
  const double own = force_norm(s, w.residual);
  return {square_root(own * own + sum), scale};
}

/// One Newton step with the matrix that stands: row forces, then displacements.
void newton_step(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const std::int32_t rows = system_rows(s);
  solve_parts(model, w);
  add_row_changes(s, w.gradient, w.change, w.wanted);
  solve_rows(model, w, true, w.wanted);
  for (std::int32_t r = 0; r < rows; ++r) w.force[r] += w.wanted[r];
  subtract_row_motion(s, w, w.wanted, w.change);
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.x[i] += w.change[i];
}

double larger(double a, double b) noexcept { return b > a ? b : a; }
double magnitude(double x) noexcept { return x < 0. ? -x : x; }

/// Largest entry of a Newton step.
double step_size(const SystemModel& s, const SystemWorkspace& w) noexcept {
  double size = 0.;
  for (std::int32_t i = 0; i < s.unknowns; ++i) size = larger(size, magnitude(w.change[i]));
  return size;
}

/// Whether a Newton step is the round-off of the places that forces are taken at, or is small and
/// no smaller than the one before: more of them find nothing, whatever is left of the forces.
/// @param before  size of the step before, 0: none
bool is_settled(const SystemModel& s, const SystemWorkspace& w, double step,
                double before) noexcept {
  double place = 0.;
  for (std::int32_t i = 0; i < s.unknowns; ++i) place = larger(place, magnitude(w.x[i]));
  for (std::int32_t b = 0; b < s.beams; ++b)
    for (std::int32_t i = 0; i < s.beam[b].unknowns; ++i)
      place = larger(place, magnitude(w.nodes[s.beam[b].first + i]));
  for (std::int32_t m = 0; m < s.markers; ++m)
    for (const double p : w.pose[m].point) place = larger(place, magnitude(p));
  constexpr double ulp = 2.3e-16;
  return step <= 4. * ulp * place ||
         (step <= 4096. * ulp * place && step > .5 * before && before > 0.);
}

/// Gear, Gupta, Leimkuhler: the force keeps the velocities, a shift of the positions Phi. Both in
/// the metric of Newton's matrix; what is left of Phi after the change that velocities take.
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

/// Extensions of springs where the step starts.
void start_springs(const Model& model, double time, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t r = s.joint_rows; r < system_rows(s); ++r) {
    const RowModel& row = s.row[r];
    const double length = row.motion >= 0 ? motion_at(s.motion[row.motion], time).x : row.offset;
    w.start_value[r] = row_value(row, w.start_pose[row.a], w.start_pose[row.b], length);
  }
}

/// Hands the step's end to the scheme's correction.
void leave(const Model& model, SystemWorkspace& w, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  if (s.ports > 0) {
    solve_ports(s, w);
    for (std::int32_t i = 0; i < 9 * s.ports; ++i)
      w.x[s.port[0].first + i] += w.change[s.port[0].first + i];
    subtract_line_motion(model, w.gradient, w.force, workspace.solved);
  }
  for (std::int32_t i = 0; i < s.unknowns; ++i) workspace.solved[s.first + i] = w.x[i] - w.shift[i];
  for (std::int32_t r = 0; r < system_rows(s); ++r) state.row_force[r] = w.force[r];
  for (std::int32_t i = 0; i < 4 * s.bodies; ++i) state.quaternion[i] = w.quaternion[i];
}

/// Takes from velocities (order 1) or accelerations (2) of the model what joints do not allow, in
/// the metric of Newton's matrix (Bayo and Ledesma 1996; Cuadrado and others 1997), capped.
/// `second` takes the same change. With accelerations go the forces that belong to them: S is kg M
/// of a body, so that M g + G' force stays what it was.
/// @returns whether they are held
bool project(const Model& model, double time, int order, const Motions& at, double* rates,
             double* second, double* row_force, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double per_step = 1. / model.scheme.dt;
  const double tolerance = s.joint_tolerance * (order == 1 ? per_step : per_step * per_step);
  for (std::int32_t done = 0;; ++done) {
    double largest = 0.;
    for (std::int32_t r = 0; r < system_rows(s); ++r) {
      w.wanted[r] = 0.;
      if (r >= s.joint_rows) continue;
      const RowModel& row = s.row[r];
      const Jet motion =
          row.motion >= 0 ? motion_at(s.motion[row.motion], time) : Jet{row.offset, 0., 0.};
      const Jet phi = row_jet(row, marker_jet(s, s.marker[row.a], at),
                              marker_jet(s, s.marker[row.b], at), motion);
      w.wanted[r] = order == 1 ? phi.v : phi.a;
      const double size = w.wanted[r] < 0. ? -w.wanted[r] : w.wanted[r];
      if (!(size <= largest)) largest = size;
    }
    if (largest <= tolerance) return true;
    if (done == s.projections) return false;
    solve_rows(model, w, false, w.wanted);
    if (row_force != nullptr)
      for (std::int32_t r = 0; r < s.joint_rows; ++r) row_force[r] += w.wanted[r] / model.scheme.kg;
    for (double* const taken : {rates, second}) {
      if (taken == nullptr) continue;
      subtract_row_motion(s, w, w.wanted, taken + s.first);
      subtract_line_motion(model, w.gradient, w.wanted, taken);
    }
  }
}

/// Whether the matrix is made anew before iteration `done`.
bool is_renewed(const SystemModel& s, const SystemTangent& t, std::int32_t done,
                bool slow) noexcept {
  if (s.renew == Renew::every_iteration || slow) return true;
  if (done > 0) return false;
  return s.renew == Renew::every_step || !(*t.age > 0.) ||
         *t.age > static_cast<double>(s.keep_steps);
}

/// Rows that hang on others where the matrix was made.
void name_redundant(const SystemModel& s, const SystemTangent& t, SystemResult& result) noexcept {
  const auto rank = static_cast<std::int32_t>(*t.rank);
  result.redundant_rows = s.joint_rows - rank;
  if (result.redundant_rows > 0) result.status = result.status | Status::redundant_joint;
  for (std::int32_t i = 0; i < result.redundant_rows && i < kMostNamedRows; ++i)
    result.redundant_row[i] = t.order[rank + i];
}

/// Energy-momentum takes a row's gradient at the mean, where Newton's matrix wants that of the end
/// on one side: at a singular position stiff rows make its iterations diverge. They begin again,
/// once, with rows so much softer.
constexpr double kSofter = 1e5;

/// How the iterations go on: what forces lack and what joints want, each against the one before.
struct Progress {
  double residual = __builtin_inf(), wanted = __builtin_inf();
  bool slow = false;   // one did not halve with a matrix that stood: make it anew
  bool grown = false;  // one grew, far off perhaps, with a matrix of an earlier step: begin again

  /// Joints count with matrices of an earlier step alone: soft rows give way in proportion to their
  /// force, so that a good step may leave more of Phi than the guess had.
  /// @param stood  whether this iterate came by a matrix that stood
  /// @param old    whether that is one of an earlier step
  void look(double residual_now, double wanted_now, double tolerance, bool stood,
            bool old) noexcept {
    const auto over = [&](double part) {
      return !(residual_now <= part * residual) ||
             (old && wanted_now > tolerance && !(wanted_now <= part * wanted));
    };
    slow = stood && over(.5);
    grown = old && over(1.);
    residual = residual_now;
    wanted = wanted_now;
  }
};

}  // namespace

SystemResult solve_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  const SystemStart start = start_of(model, state, workspace);
  const double time = static_cast<double>(state.steps + 1) * model.scheme.dt;
  SystemResult result{};
  guess(model, state, workspace, w);
  read_ports(model, workspace.solved, w.free_ports);
  place_start(model, start, w);
  if (s.mean != 0) start_springs(model, time - model.scheme.dt, w);
  if (s.renew == Renew::kept) *w.tangent.age += *w.tangent.age > 0. ? 1. : 0.;
  Progress progress;
  bool old = true;  // the matrix is of an earlier step
  double step = 0., soft = 1.;
  bool settled = false;
  const bool may_soften = s.mean != 0 && s.hold == Hold::augmented_lagrangian;
  for (std::int32_t done = 0;; ++done) {
    place_parts(model, start, w);
    const bool renew = is_renewed(s, w.tangent, done, progress.slow);
    part_forces(model, start, renew, w);
    outer_forces(model, s.mean != 0 ? time - .5 * model.scheme.dt : time, w);
    const double wanted = set_rows(model, time, w);
    const Size size = set_residual(s, w);
    result.violation = joint_violation(s, w);
    result.force_residual = size.scale > 0. ? size.residual / size.scale : 0.;
    const bool held = wanted <= s.joint_tolerance && (s.hold != Hold::gear_gupta_leimkuhler ||
                                                      result.violation <= s.joint_tolerance);
    if (done > 0 && (result.force_residual <= s.tolerance || settled) && held) break;
    if (done == s.cap && may_soften && soft < kSofter) {
      soft = kSofter;
      progress = {.slow = true};
      step = 0.;
      settled = false;
      guess(model, state, workspace, w);
      done = -1;
      continue;
    }
    if (done == s.cap) {
      result.status = Status::cap_reached;
      break;
    }
    result.iterations = done + 1;
    progress.look(size.residual, wanted, s.joint_tolerance, !renew, old && !renew);
    if (progress.grown) {
      progress = {.slow = true};
      step = 0.;
      settled = false;
      guess(model, state, workspace, w);
      continue;
    }
    if (renew) {
      old = false;
      solve_ends(model, w);
      factor_rows(model, soft, w);
      *w.tangent.age = 1.;
    }
    newton_step(model, w);
    const double last = step;
    step = step_size(s, w);
    settled = is_settled(s, w, step, last);
    if (s.hold == Hold::gear_gupta_leimkuhler) shift_step(model, w);
  }
  leave(model, w, state, workspace);
  name_redundant(s, w.tangent, result);
  return result;
}

Status finish_system(const Model& model, State& state, Workspace& workspace) noexcept {
  const SystemModel& s = model.system;
  SystemWorkspace w = system_workspace_on(s, workspace.system, state.kept);
  double* const u = state.u + s.first;
  if (s.hold == Hold::gear_gupta_leimkuhler)
    for (std::int32_t i = 0; i < s.unknowns; ++i) u[i] += w.shift[i];
  for (std::int32_t b = 0; b < s.bodies; ++b)
    for (int c = 3; c < 6; ++c)
      if (const std::int32_t k = s.body[b].column[c]; k >= 0) u[s.body[b].first + k] = 0.;
  if (s.hold != Hold::augmented_lagrangian || s.mean != 0 || s.joint_rows == 0) return Status::ok;
  if (s.renew == Renew::kept) {  // an old direction of the joints would take what they allow
    solve_ends(model, w);
    factor_rows(model, 1., w);
  }
  const Motions at{u, state.v + s.first, state.g + s.first, w.matrix};
  const double time = static_cast<double>(state.steps + 1) * model.scheme.dt;
  const bool velocities = project(model, time, 1, at, state.v, nullptr, nullptr, w);
  const bool accelerations = project(model, time, 2, at, state.g, state.a, state.row_force, w);
  return velocities && accelerations ? Status::ok : Status::cap_reached;
}

}  // namespace railstep
