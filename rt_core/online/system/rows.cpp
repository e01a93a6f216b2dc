#include "online/system/rows.h"

#include "online/math/scalar.h"
#include "online/system/rotation.h"
#include "online/system/row.h"

namespace railstep {

namespace {

const MarkerModel& marker_of(const SystemModel& s, const EndModel& end) noexcept {
  const RowModel& row = s.row[end.row];
  return s.marker[end.side == 0 ? row.a : row.b];
}

Jet motion_of(const SystemModel& s, const RowModel& row, double time) noexcept {
  return row.motion >= 0 ? motion_at(s, row.motion, time) : Jet{row.offset, 0., 0.};
}

Pivoted pivoted(const SystemModel& s, const SystemTangent& t) noexcept {
  return {t.compliance,   t.scale,      t.order,
          system_rows(s), s.joint_rows, static_cast<std::int32_t>(*t.rank)};
}

/// Target of a joint row: Phi, or the function of it that the constraint method holds, in the row's
/// unit. Newton's step changes it by G times the change of x.
double joint_wanted(const Model& model, const RowModel& row, const SystemWorkspace& w, double value,
                    Jet s) noexcept {
  const SystemModel& system = model.system;
  if (system.constraint_method == ConstraintMethod::augmented_lagrangian ||
      system.constraint_method == ConstraintMethod::direct)
    return value;
  const Motions at{w.x, w.v, w.g, w.matrix};
  const Jet phi = row_jet(row, marker_jet(system, system.marker[row.a], at),
                          marker_jet(system, system.marker[row.b], at), s);
  const double kv = model.scheme.kv, kg = model.scheme.kg;
  if (system.constraint_method == ConstraintMethod::gear_gupta_leimkuhler) return phi.v / kv;
  const double damp = 2. * system.alpha, stiff = system.beta * system.beta;
  return ((phi.a + damp * phi.v) + stiff * phi.x) / ((kg + damp * kv) + stiff);
}

/// Force of a spring by its law less its present force, N.
double spring_lack(const Model& model, std::int32_t r, const SystemWorkspace& w, Jet s) noexcept {
  const SystemModel& system = model.system;
  const RowModel& row = system.row[r];
  double law;
  if (system.mean != 0) {
    const double change = w.value[r] - w.start_value[r];
    law = row.stiffness * (w.start_value[r] + .5 * change) + row.damping / model.scheme.dt * change;
  } else {
    const Motions at{w.x, w.v, w.g, w.matrix};
    const Jet phi = row_jet(row, marker_jet(system, system.marker[row.a], at),
                            marker_jet(system, system.marker[row.b], at), s);
    law = row.stiffness * phi.x + row.damping * phi.v;
  }
  return law - w.force[r];
}

/// Gradients of both ends of a row, where forces are taken.
void set_gradient(const SystemModel& s, std::int32_t r, double motion, const std::int32_t* end,
                  SystemWorkspace& w) noexcept {
  const RowModel& row = s.row[r];
  MarkerGradient of_end[2];
  double length = 0.;
  if (row.kind == RowKind::spring) {
    length = row_length(w.pose[row.a], w.pose[row.b]);
    if (s.mean != 0) length = .5 * (length + row_length(w.start_pose[row.a], w.start_pose[row.b]));
  }
  row_gradient(row, w.force_pose[row.a], w.force_pose[row.b], length, motion, of_end[0], of_end[1]);
  for (int side = 0; side < 2; ++side)
    if (end[side] >= 0)
      end_row(s, w, side == 0 ? row.a : row.b, of_end[side],
              w.gradient + std::ptrdiff_t{kMostNodeUnknowns} * end[side]);
}

/// Forces on a body's rotation D of the step, R1 = R0 cay(D), from moments at the step's end in the
/// body's axes at its start: T' moment, as dR1 R1' = R0 [T dD]x R0' with
/// T = (1 + [D]x / 2) / (1 + |D|^2 / 4) (Hairer, Lubich, Wanner 2006, IV.8.3).
void moment_to_cayley(const RigidBodyModel& body, const double* x, double* row) noexcept {
  double moment[3] = {}, D[3] = {}, part[3];
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = body.column[3 + c]; k >= 0) {
      moment[c] = row[k];
      D[c] = x[body.first + k];
    }
  cross(D, moment, part);
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = body.column[3 + c]; k >= 0)
      row[k] = (moment[c] - .5 * part[c]) / (1. + .25 * dot(D, D));
}

/// Derivative of `wanted` in Newton's step, if it is not the gradient of the row's force: the
/// gradient at the step's end (energy-momentum), or for joint rows ahead of it (Baumgarte,
/// place_ahead).
/// @param motion  at the same time
void set_slope(const SystemModel& s, std::int32_t r, double motion, const std::int32_t* end,
               SystemWorkspace& w) noexcept {
  const RowModel& row = s.row[r];
  const bool mean = s.mean != 0, ahead = !mean && r < s.joint_rows;
  const MarkerPose* const pose = ahead ? w.ahead_pose : w.pose;
  const double* const x = ahead ? w.ahead : w.x;
  const double* const matrix = mean ? w.start_matrix : ahead ? w.ahead_matrix : w.matrix;
  MarkerGradient of_end[2];
  row_gradient(row, pose[row.a], pose[row.b], row_length(pose[row.a], pose[row.b]), motion,
               of_end[0], of_end[1]);
  for (int side = 0; side < 2; ++side) {
    if (end[side] < 0) continue;
    const std::int32_t m = side == 0 ? row.a : row.b;
    const MarkerModel& on = s.marker[m];
    double* const out = w.slope + std::ptrdiff_t{kMostNodeUnknowns} * end[side];
    if (on.kind != PartKind::body) {
      generalised_force(s, on, pose[m], nullptr, nullptr, of_end[side], out);
      continue;
    }
    const RigidBodyModel& body = s.body[on.part];
    double centre[3];
    for (int c = 0; c < 3; ++c)
      centre[c] = body.rest[c] + (body.column[c] >= 0 ? x[body.first + body.column[c]] : 0.);
    generalised_force(s, on, pose[m], centre, matrix + 9 * on.part, of_end[side], out);
    if (mean) moment_to_cayley(body, x, out);
  }
}

double lanes_dot(const double* g, const double* solved, std::int32_t stride,
                 std::int32_t count) noexcept {
  double sum = 0.;
  for (std::int32_t k = 0; k < count; ++k) sum += g[k] * solved[stride * k];
  return sum;
}

/// Adds the compliance by the ends of one part.
/// @param lane    start of S^-1 g of an end of the part
template <class Lane>
void add_part(const SystemModel& s, std::int32_t part, std::int32_t stride,
              const SystemWorkspace& w, const Lane& lane) noexcept {
  const std::int32_t rows = system_rows(s);
  for (std::int32_t e = s.part_end[part]; e < s.part_end[part + 1]; ++e) {
    const UnknownRange at = unknowns_of(s, marker_of(s, s.end[e]));
    const double* g = w.slope + std::ptrdiff_t{kMostNodeUnknowns} * e;
    double* const row = w.tangent.compliance + std::ptrdiff_t{rows} * s.end[e].row;
    for (std::int32_t f = s.part_end[part]; f < s.part_end[part + 1]; ++f)
      row[s.end[f].row] += lanes_dot(g, lane(f, at.first), stride, at.count);
  }
}

/// Rank tolerance for pivots of rows with a compliance: round-off only.
constexpr double kYieldingRank = 1e-15;

/// Factor of slope S^-1 gradient' and the rows' own compliance.
/// @param yields  joint rows have one too
void factor_yielding(const Model& model, bool yields, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const std::int32_t rows = system_rows(s);
  for (std::int32_t i = 0; i < rows * rows; ++i) w.tangent.compliance[i] = 0.;
  const double* solved = w.tangent.solved;
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    add_part(s, b, 1, w, [&](std::int32_t f, std::int32_t first) {
      return solved + 6 * (f - s.part_end[b]) + (first - s.body[b].first);
    });
    solved += std::ptrdiff_t{6} * part_ends(s, b);
  }
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    const std::int32_t part = s.bodies + b;
    add_part(s, part, kEndGroup, w, [&](std::int32_t f, std::int32_t first) {
      return solved + end_group_place(beam, f - s.part_end[part], first - beam.first);
    });
    solved += beam_groups(s, b) * end_group_doubles(beam);
  }
  const std::int32_t track = s.bodies + s.beams;
  add_part(s, track, 1, w, [&](std::int32_t f, std::int32_t first) {
    return solved + std::ptrdiff_t{9} * s.ports * (f - s.part_end[track]) +
           (first - s.port[0].first);
  });
  for (std::int32_t r = 0; r < rows; ++r)
    w.tangent.compliance[std::ptrdiff_t{rows} * r + r] += r >= s.joint_rows
                                                              ? 1. / spring_slope(model, s.row[r])
                                                          : yields ? s.row[r].compliance
                                                                   : 0.;
  *w.tangent.rank = 0.;
  Pivoted f = pivoted(s, w.tangent);
  factor_pivoted(f, yields ? kYieldingRank : s.rank_tolerance);
  *w.tangent.rank = f.rank;
}

}  // namespace

void end_row(const SystemModel& system, const SystemWorkspace& w, std::int32_t marker,
             const MarkerGradient& gradient, double* out) noexcept {
  const MarkerModel& on = system.marker[marker];
  double centre[3] = {};
  const double* matrix = nullptr;
  if (on.kind == PartKind::body) {
    matrix = (system.mean != 0 ? w.start_matrix : w.matrix) + 9 * on.part;
    for (int c = 0; c < 3; ++c) centre[c] = w.centre[3 * on.part + c];
  }
  generalised_force(system, on, w.force_pose[marker], centre, matrix, gradient, out);
}

double spring_slope(const Model& model, const RowModel& row) noexcept {
  return model.system.mean != 0 ? .5 * row.stiffness + row.damping / model.scheme.dt
                                : row.stiffness + row.damping * model.scheme.kv;
}

double set_rows(const Model& model, double time, bool renew, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  double largest = 0.;
  const bool slopes = has_slopes(s) && (renew || s.renew == Renew::kept);
  const double ahead =
      slopes && s.constraint_method == ConstraintMethod::baumgarte ? place_ahead(model, w) : 0.;
  for (std::int32_t r = 0; r < system_rows(s); ++r) {
    const RowModel& row = s.row[r];
    const Jet motion = motion_of(s, row, time);
    w.value[r] = row_value(row, w.pose[row.a], w.pose[row.b], motion.x);
    set_gradient(s, r, motion.x, row.end, w);
    if (slopes) set_slope(s, r, motion.x + ahead * motion.v, row.end, w);
    if (r < s.joint_rows) {
      w.velocity_part[r] = w.wanted[r] = joint_wanted(model, row, w, w.value[r], motion);
      if (!(magnitude(w.wanted[r]) <= largest)) largest = magnitude(w.wanted[r]);
    } else {
      w.spring_lack[r] = spring_lack(model, r, w, motion);
      w.wanted[r] = w.spring_lack[r] / spring_slope(model, row);
    }
  }
  return largest;
}

double joint_violation(const SystemModel& system, const SystemWorkspace& w) noexcept {
  double largest = 0.;
  for (std::int32_t r = 0; r < system.joint_rows; ++r)
    if (!(magnitude(w.value[r]) <= largest)) largest = magnitude(w.value[r]);
  return largest;
}

void add_row_forces(const SystemModel& system, const double* gradient, const double* force,
                    double* out) noexcept {
  for (std::int32_t e = 0; e < system.ends; ++e) {
    const UnknownRange at = unknowns_of(system, marker_of(system, system.end[e]));
    const double* g = gradient + std::ptrdiff_t{kMostNodeUnknowns} * e;
    const double f = force[system.end[e].row];
    for (std::int32_t k = 0; k < at.count; ++k) out[at.first + k] += f * g[k];
  }
}

void add_row_changes(const SystemModel& system, const double* gradient, const double* change,
                     double* out) noexcept {
  for (std::int32_t e = 0; e < system.ends; ++e) {
    const UnknownRange at = unknowns_of(system, marker_of(system, system.end[e]));
    out[system.end[e].row] +=
        lanes_dot(gradient + std::ptrdiff_t{kMostNodeUnknowns} * e, change + at.first, 1, at.count);
  }
}

void factor_rows(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const bool yields = s.constraint_method == ConstraintMethod::augmented_lagrangian;
  factor_yielding(model, yields && s.mean == 0, w);
  // If a step passes a singular position, G S^-1 G_m' has pivots below zero, which a compliance of
  // similar size would bring to zero. So it is only for rows that depend on each other.
  if (yields && s.mean != 0 && *w.tangent.rank < s.joint_rows) factor_yielding(model, true, w);
}

void solve_rows(const Model& model, SystemWorkspace& w, bool all, double* x) noexcept {
  solve_pivoted(pivoted(model.system, w.tangent), all, x, w.scratch);
}

void subtract_row_motion(const SystemModel& system, const SystemWorkspace& w, const double* force,
                         double* change) noexcept {
  const SystemModel& s = system;
  const double* solved = w.tangent.solved;
  for (std::int32_t b = 0; b < s.bodies; ++b)
    for (std::int32_t e = s.part_end[b]; e < s.part_end[b + 1]; ++e, solved += 6) {
      const double f = force[s.end[e].row];
      for (std::int32_t k = 0; k < s.body[b].unknowns; ++k)
        change[s.body[b].first + k] -= f * solved[k];
    }
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    const std::int32_t first = s.part_end[s.bodies + b], ends = part_ends(s, s.bodies + b);
    for (std::int32_t g = 0; g < beam_groups(s, b); ++g, solved += end_group_doubles(beam)) {
      double f[kEndGroup] = {};
      for (std::int32_t l = 0; l < kEndGroup && kEndGroup * g + l < ends; ++l)
        f[l] = force[s.end[first + kEndGroup * g + l].row];
      for (std::int32_t k = 0; k < beam.unknowns; ++k) {
        const double* x = solved + std::ptrdiff_t{kEndGroup} * k;
        change[beam.first + k] -= (f[0] * x[0] + f[1] * x[1]) + (f[2] * x[2] + f[3] * x[3]);
      }
    }
  }
  const std::int32_t track = s.bodies + s.beams, moved = 9 * s.ports;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e, solved += moved)
    for (std::int32_t k = 0; k < moved; ++k)
      change[s.port[0].first + k] -= force[s.end[e].row] * solved[k];
}

}  // namespace railstep
