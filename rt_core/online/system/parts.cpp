#include "online/system/parts.h"

#include "online/model/beam_chain.h"
#include "online/model/state.h"
#include "online/system/marker.h"
#include "online/system/rotation.h"
#include "online/system/row.h"
#include "online/system/rows.h"
#include "online/system/track_ports.h"

namespace railstep {

namespace {

/// The rotation unknowns of a body as a vector in its axes.
void rotation_of(const RigidBodyModel& body, const double* x, double* out) noexcept {
  for (int c = 0; c < 3; ++c) {
    const std::int32_t k = body.column[3 + c];
    out[c] = k >= 0 ? x[body.first + k] : 0.;
  }
}

void set_rotation(const RigidBodyModel& body, const double* from, double* out) noexcept {
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = body.column[3 + c]; k >= 0) out[body.first + k] = from[c];
}

void place_nodes(const SystemModel& s, const SystemStart& start, SystemWorkspace& w) noexcept {
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    const std::int32_t first = beam.first;
    const double* rest = s.beam_rest + first;
    if (s.mean == 0) {
#pragma omp simd
      for (std::int32_t i = 0; i < beam.unknowns; ++i)
        w.nodes[first + i] = rest[i] + w.x[first + i];
      continue;
    }
#pragma omp simd
    for (std::int32_t i = 0; i < beam.unknowns; ++i) {
      w.nodes[first + i] = rest[i] + .5 * (start.u[first + i] + w.x[first + i]);
      w.half_change[first + i] = .5 * (w.x[first + i] - start.u[first + i]);
    }
  }
}

/// Centre of a body at which forces are taken, as for poses of markers.
void place_centre(const SystemModel& s, std::int32_t b, const SystemStart& start,
                  SystemWorkspace& w) noexcept {
  const RigidBodyModel& body = s.body[b];
  for (int c = 0; c < 3; ++c) {
    w.centre[3 * b + c] = body.rest[c];
    if (const std::int32_t k = body.column[c]; k >= 0)
      w.centre[3 * b + c] +=
          s.mean != 0 ? .5 * (start.u[body.first + k] + w.x[body.first + k]) : w.x[body.first + k];
  }
}

/// J g + v x J v, in the body's axes at the step's end.
void rotation_inertia(const RigidBodyModel& body, const double* v, const double* g,
                      double* out) noexcept {
  double momentum[3], gyroscopic[3];
  rotate(body.inertia, v, momentum);
  cross(v, momentum, gyroscopic);
  rotate(body.inertia, g, out);
  for (int c = 0; c < 3; ++c) out[c] += gyroscopic[c];
}

/// Change of the angular momentum over the step, in the body's axes at its start: a free body
/// keeps it, and its energy, to round-off (Simo and Wong 1991, with Cayley's rotation).
void mean_rotation_inertia(const RigidBodyModel& body, double per_step, const double* change,
                           const double* v0, const double* v1, double* out) noexcept {
  constexpr double upright[4] = {1., 0., 0., 0.};
  double q[4], R[9], old[3], fresh[3];
  rotated_by_mean(upright, change, q);
  rotation_matrix(q, R);
  rotate(body.inertia, v1, fresh);
  rotate(R, fresh, fresh);
  rotate(body.inertia, v0, old);
  for (int c = 0; c < 3; ++c) out[c] = per_step * (fresh[c] - old[c]);
}

void body_inertia(const Model& model, const RigidBodyModel& body, const SystemStart& start,
                  SystemWorkspace& w) noexcept {
  double v[3], g[3], moment[3];
  rotation_of(body, w.v, v);
  rotation_of(body, w.g, g);
  if (model.system.mean != 0) {
    double v0[3], change[3];
    rotation_of(body, start.v, v0);
    rotation_of(body, w.x, change);
    mean_rotation_inertia(body, 1. / model.scheme.dt, change, v0, v, moment);
  } else {
    rotation_inertia(body, v, g, moment);
  }
  set_rotation(body, moment, w.inertia);
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = body.column[c]; k >= 0)
      w.inertia[body.first + k] = body.mass * w.g[body.first + k];
}

void beam_elastic(const Model& model, const BeamChainModel& beam, bool renew,
                  SystemWorkspace& w) noexcept {
  const double* half = model.system.mean != 0 ? w.half_change + beam.first : nullptr;
  const double* nodes = w.nodes + beam.first;
  double* const force = w.elastic + beam.first;
  if (renew)
    beam_tangents(beam, nodes, half, force, w.tangents);
  else
    beam_forces(beam, nodes, half, force);
}

/// S of a body is kg M. Gyroscopic terms and those of rotating axes are h |w| / 2 of it and left to
/// the iterations.
void solve_body(const RigidBodyModel& body, double per_kg, const double* force,
                double* out) noexcept {
  double moment[3] = {}, rate[3];
  for (int c = 0; c < 3; ++c) {
    if (body.column[c] >= 0) out[body.column[c]] = per_kg / body.mass * force[body.column[c]];
    if (body.column[3 + c] >= 0) moment[c] = per_kg * force[body.column[3 + c]];
  }
  rotate(body.inverse_inertia, moment, rate);
  for (int c = 0; c < 3; ++c)
    if (body.column[3 + c] >= 0) out[body.column[3 + c]] = rate[c];
}

/// change = -residual; for bodies -S^-1 residual.
void start_change(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double per_kg = 1. / model.scheme.kg;
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.change[i] = -w.residual[i];
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    double* const own = w.change + s.body[b].first;
    double force[6];
    for (std::int32_t k = 0; k < s.body[b].unknowns; ++k) force[k] = own[k];
    solve_body(s.body[b], per_kg, force, own);
  }
}

/// S^-1 g of the ends on a beam, four side by side. Another right-hand side is solved with the last
/// four if these are not full.
/// @param other  [unknowns] in and out; null without one
void solve_beam_ends(const SystemModel& s, std::int32_t b, const double* factor, double* solved,
                     const double* gradient, double* other) noexcept {
  const BeamChainModel& beam = s.beam[b];
  const std::int32_t first = s.part_end[s.bodies + b], ends = part_ends(s, s.bodies + b);
  const std::int32_t groups = beam_groups(s, b);
  for (std::int64_t i = 0; i < groups * end_group_doubles(beam); ++i) solved[i] = 0.;
  for (std::int32_t e = 0; e < ends; ++e) {
    const EndModel& end = s.end[first + e];
    const RowModel& row = s.row[end.row];
    const UnknownRange at = unknowns_of(s, s.marker[end.side == 0 ? row.a : row.b]);
    for (std::int32_t k = 0; k < at.count; ++k)
      solved[end_group_place(beam, e, at.first - beam.first + k)] =
          gradient[std::ptrdiff_t{kMostNodeUnknowns} * (first + e) + k];
  }
  const bool along = other != nullptr && ends % kEndGroup != 0;
  const std::int32_t last = kEndGroup * groups - 1;  // free if the last group is not full
  for (std::int32_t i = 0; along && i < beam.unknowns; ++i)
    solved[end_group_place(beam, last, i)] = other[i];
  for (std::int32_t g = 0; g < groups; ++g)
    beam_solve(s, beam, factor, solved + g * end_group_doubles(beam));
  for (std::int32_t i = 0; along && i < beam.unknowns; ++i) {
    double& own = solved[end_group_place(beam, last, i)];
    other[i] = own;
    own = 0.;
  }
  if (other != nullptr && !along) beam_solve_one(s, beam, factor, other);
}

/// y += C f of all ports.
void add_port_motion(const SystemModel& s, double factor, const double* force,
                     double* out) noexcept {
  const std::int32_t n = 9 * s.ports;
  for (std::int32_t i = 0; i < n; ++i) {
    double sum = 0.;
    for (std::int32_t k = 0; k < n; ++k)
      sum += s.port_compliance[std::ptrdiff_t{n} * i + k] * force[k];
    out[i] += factor * sum;
  }
}

/// C g of an end on a rail. @returns number of values
std::int32_t solve_track_end(const SystemModel& s, std::int32_t end, const double* gradient,
                             double* solved) noexcept {
  const std::int32_t n = 9 * s.ports, port = port_of_end(s, end);
  for (std::int32_t i = 0; i < n; ++i) {
    const double* C = s.port_compliance + std::ptrdiff_t{n} * i + 9 * port;
    double sum = 0.;
    for (int k = 0; k < 9; ++k) sum += C[k] * gradient[k];
    solved[i] = sum;
  }
  return n;
}

/// Adds an applied force or moment on the unknowns of its part. A moment on a body acts in the axes
/// that the step uses: those of the start for the mean of both ends.
void applied(const SystemModel& s, const SystemWorkspace& w, const PointForceModel& force,
             double size, double* row) noexcept {
  const MarkerModel& marker = s.marker[force.marker];
  MarkerGradient gradient{};
  double own[3];
  for (int c = 0; c < 3; ++c) own[c] = gradient.point[c] = size * force.direction[c];
  if (force.moment == 0) return end_row(s, w, force.marker, gradient, row);
  rotate_back((s.mean != 0 ? w.start_matrix : w.matrix) + 9 * marker.part, own, own);
  for (int c = 0; c < 3; ++c)
    if (const std::int32_t k = s.body[marker.part].column[3 + c]; k >= 0) row[k] = own[c];
}

}  // namespace

void place_start(const Model& model, const SystemStart& start, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t b = 0; b < s.bodies; ++b)
    rotation_matrix(start.quaternion + 4 * b, w.start_matrix + 9 * b);
  if (s.mean == 0) return;
  for (std::int32_t m = 0; m < s.markers - s.sensors; ++m)
    w.start_pose[m] = marker_pose(s, s.marker[m], start.u, w.start_matrix);
}

void place_parts(const Model& model, const SystemStart& start, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double kv = model.scheme.kv, kg = model.scheme.kg;
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i) {
    const double change = (w.x[i] - w.shift[i]) - start.u_star[i];
    w.v[i] = start.v_star[i] + kv * change;
    w.g[i] = kg * change;
  }
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    double change[3];
    rotation_of(s.body[b], w.x, change);
    const double* q0 = start.quaternion + 4 * b;
    if (s.mean != 0)
      rotated_by_mean(q0, change, w.quaternion + 4 * b);
    else
      rotated(q0, change, w.quaternion + 4 * b);
    rotation_matrix(w.quaternion + 4 * b, w.matrix + 9 * b);
    place_centre(s, b, start, w);
  }
  place_nodes(s, start, w);
  for (std::int32_t m = 0; m < s.markers - s.sensors; ++m) {
    w.force_pose[m] = w.pose[m] = marker_pose(s, s.marker[m], w.x, w.matrix);
    if (s.mean == 0) continue;
    for (int c = 0; c < 3; ++c) {
      w.force_pose[m].point[c] = .5 * (w.start_pose[m].point[c] + w.pose[m].point[c]);
      for (int k = 0; k < 3; ++k)
        w.force_pose[m].axis[k][c] = .5 * (w.start_pose[m].axis[k][c] + w.pose[m].axis[k][c]);
    }
  }
}

double place_ahead(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  const double kv = model.scheme.kv, kg = model.scheme.kg;
  const double time = 2. * (kv + s.alpha) / ((kg + 2. * s.alpha * kv) + s.beta * s.beta);
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.ahead[i] = w.x[i] + time * w.v[i];
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    double change[3], q[4];
    rotation_of(s.body[b], w.v, change);
    for (double& c : change) c *= time;
    rotated(w.quaternion + 4 * b, change, q);
    rotation_matrix(q, w.ahead_matrix + 9 * b);
  }
  for (std::int32_t m = 0; m < s.markers - s.sensors; ++m)
    w.ahead_pose[m] = marker_pose(s, s.marker[m], w.ahead, w.ahead_matrix);
  return time;
}

std::int32_t part_forces(const Model& model, const SystemStart& start, bool renew,
                         SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.inertia[i] = w.elastic[i] = 0.;  // padding too
  for (std::int32_t b = 0; b < s.bodies; ++b) body_inertia(model, s.body[b], start, w);
  std::int32_t lost = 0;
  double* factor = w.tangent.factor;
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    beam_elastic(model, beam, renew, w);
    if (renew)
      lost += beam_factor(s, beam, model.scheme.kg, s.mean != 0 ? .5 : 1., w.tangents, factor);
    beam_inertia(beam, w.g + beam.first, w.inertia + beam.first);
    factor += beam_factor_doubles(beam);
  }
  for (std::int32_t i = 0; i < 9 * s.ports; ++i)
    w.inertia[s.port[0].first + i] = w.elastic[s.port[0].first + i] = 0.;
  return lost;
}

void outer_forces(const Model& model, double time, const double* input,
                  SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
#pragma omp simd
  for (std::int32_t i = 0; i < s.unknowns; ++i) w.outer[i] = s.constant_force[i];
  for (std::int32_t f = 0; f < s.forces; ++f) {
    const PointForceModel& force = s.force[f];
    const MarkerModel& marker = s.marker[force.marker];
    const double size =
        force.input >= 0 ? held_input(input, force.input) : motion_at(s, force.motion, time).x;
    const UnknownRange at = unknowns_of(s, marker);
    double row[kMostNodeUnknowns] = {};
    applied(s, w, force, size, row);
    for (std::int32_t k = 0; k < at.count; ++k) w.outer[at.first + k] += row[k];
  }
}

void solve_ports(const SystemModel& s, SystemWorkspace& w) noexcept {
  const std::int32_t at = s.port[0].first;
  for (std::int32_t i = 0; i < 9 * s.ports; ++i) w.change[at + i] = w.free_ports[i] - w.x[at + i];
  add_port_motion(s, -1., w.residual + at, w.change + at);
}

void solve_parts(const Model& model, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  start_change(model, w);
  const double* factor = w.tangent.factor;
  for (std::int32_t b = 0; b < s.beams; ++b) {
    const BeamChainModel& beam = s.beam[b];
    beam_solve_one(s, beam, factor, w.change + beam.first);
    factor += beam_factor_doubles(beam);
  }
  if (s.ports > 0) solve_ports(s, w);
}

void solve_ends(const Model& model, bool parts, SystemWorkspace& w) noexcept {
  const SystemModel& s = model.system;
  if (parts) start_change(model, w);
  double* solved = w.tangent.solved;
  for (std::int32_t b = 0; b < s.bodies; ++b)
    for (std::int32_t e = s.part_end[b]; e < s.part_end[b + 1]; ++e, solved += 6)
      solve_body(s.body[b], 1. / model.scheme.kg,
                 w.gradient + std::ptrdiff_t{kMostNodeUnknowns} * e, solved);
  const double* factor = w.tangent.factor;
  for (std::int32_t b = 0; b < s.beams; ++b) {
    double* const change = parts ? w.change + s.beam[b].first : nullptr;
    solve_beam_ends(s, b, factor, solved, w.gradient, change);
    solved += beam_groups(s, b) * end_group_doubles(s.beam[b]);
    factor += beam_factor_doubles(s.beam[b]);
  }
  const std::int32_t track = s.bodies + s.beams;
  for (std::int32_t e = s.part_end[track]; e < s.part_end[track + 1]; ++e)
    solved += solve_track_end(s, e, w.gradient + std::ptrdiff_t{kMostNodeUnknowns} * e, solved);
  if (parts && s.ports > 0) solve_ports(s, w);
}

}  // namespace railstep
