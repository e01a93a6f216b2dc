#include "online/model/load_system.h"

#include "online/math/finite.h"
#include "online/math/lanes.h"
#include "online/model/state.h"

namespace railstep {

namespace {

template <int N>
bool are_moderate(const double (&values)[N]) noexcept {
  for (const double x : values)
    if (!is_moderate(x)) return false;
  return true;
}

bool is_index(std::int32_t i, std::int64_t count) noexcept { return i >= 0 && i < count; }

bool are_indices(const std::int32_t* values, std::int64_t n, std::int64_t count) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!is_index(values[i], count)) return false;
  return true;
}

bool solve_is_valid(const Scheme& c, const SystemModel& s) noexcept {
  if (s.cap < 1 || s.keep_steps < 1) return false;
  if (s.mean != 0 && s.constraint_method != ConstraintMethod::augmented_lagrangian &&
      s.constraint_method != ConstraintMethod::direct)
    return false;
  return is_above_zero(c.kg) && is_not_negative(c.kv) && is_not_negative(s.alpha) &&
         is_not_negative(s.beta) && is_above_zero(s.tolerance) &&
         is_above_zero(s.joint_tolerance) && s.rank_tolerance >= 0. && s.rank_tolerance < 1.;
}

/// Whether compliances of the ports on rails are not negative.
bool compliances_are_valid(const SystemModel& s) noexcept {
  const std::int64_t n = std::int64_t{9} * s.ports;
  for (std::int64_t i = 0; i < n; ++i)
    if (!(s.port_compliance[i * n + i] >= 0.)) return false;
  return true;
}

/// Whether a track beside the system has ends and holds forces as the system does; without a track,
/// whether there are no parts of one.
bool stands_alone_or_beside(const Model& m) noexcept {
  const SystemModel& s = m.system;
  if (s.first < m.line_unknowns || s.unknowns != m.unknowns - s.first || m.endless.bays != 0)
    return false;
  if (m.elements > 0)
    return (s.mean != 0) == (m.form == Form::condensed) &&
           s.constraint_method != ConstraintMethod::gear_gupta_leimkuhler &&
           (s.ports == 0 || (s.port_compliance && (s.port_shapes || m.line_unknowns == 0) &&
                             compliances_are_valid(s)));
  return s.ports == 0 && s.first == 0 && m.lines == 0 && m.loads == 0 && m.signals == 0 &&
         m.form == Form::banded && m.wheelsets == 0 && m.vehicles == 0 && m.vehicle_wheels == 0 &&
         m.runners == 0 && m.fixed.count == 0 && m.external_wheels == 0;
}

/// Whether each unknown belongs to one direction or rotation.
bool columns_are_valid(const RigidBodyModel& b) noexcept {
  if (b.unknowns != 3 && b.unknowns != 6) return false;
  std::uint32_t carried = 0;
  for (const std::int32_t column : b.column) {
    if (column == -1) continue;
    if (!is_index(column, b.unknowns) || (carried >> column & 1u) != 0u) return false;
    carried |= 1u << column;
  }
  return carried == (1u << b.unknowns) - 1u;
}

bool body_is_valid(const RigidBodyModel& b) noexcept {
  if (!columns_are_valid(b) || !is_above_zero(b.mass) || !is_above_zero(b.radius)) return false;
  for (const int diagonal : {0, 4, 8})
    if (!(b.inertia[diagonal] > 0.) || !(b.inverse_inertia[diagonal] > 0.)) return false;
  return are_moderate(b.inertia) && are_moderate(b.inverse_inertia) && are_moderate(b.rest);
}

bool beam_is_valid(const SystemModel& s, const BeamChainModel& b) noexcept {
  if (b.planar < 0 || b.planar > 1 || b.elements < 1 || b.elements > kMostElementsOfBeam)
    return false;
  if (b.unknowns != beam_width(b) * chain_nodes(b.elements)) return false;
  if (b.first_held < 0 || b.held < 0 || std::int64_t{b.first_held} + b.held > s.held) return false;
  for (int k = 0; k < 3; ++k)
    if (!is_above_zero(b.mass[k])) return false;
  return is_moderate(b.mass[3]) && is_above_zero(b.slope_scale) &&
         is_above_zero(b.element.per_length) && are_moderate(b.element.preload) &&
         are_moderate(b.element.stiffness) &&
         are_indices(s.held_unknown + b.first_held, b.held, b.unknowns);
}

bool port_is_valid(const Model& m, const RailPortModel& p) noexcept {
  return (p.rail == 0 || p.rail == 1) && is_index(p.element, m.elements) && are_moderate(p.value) &&
         are_moderate(p.rest);
}

/// Whether parts follow each other: bodies, beams, ports, then less than a panel of padding.
bool parts_are_valid(const Model& m) noexcept {
  const SystemModel& s = m.system;
  if (s.bodies + s.beams < 1 || s.unknowns % kLanes != 0) return false;
  std::int64_t at = 0;
  for (std::int32_t i = 0; i < s.bodies; ++i) {
    if (s.body[i].first != at || !body_is_valid(s.body[i])) return false;
    at += s.body[i].unknowns;
  }
  for (std::int32_t i = 0; i < s.beams; ++i) {
    if (s.beam[i].first != at || !beam_is_valid(s, s.beam[i])) return false;
    at += s.beam[i].unknowns;
  }
  for (std::int32_t i = 0; i < s.ports; ++i, at += 9)
    if (s.port[i].first != at || !port_is_valid(m, s.port[i])) return false;
  return at <= s.unknowns && s.unknowns - at < kLanes;
}

bool marker_is_valid(const SystemModel& s, const MarkerModel& m) noexcept {
  if (!are_moderate(m.position) || !are_moderate(m.frame) || !are_moderate(m.value)) return false;
  switch (m.kind) {
    case PartKind::ground:
      return true;
    case PartKind::body:
      return is_index(m.part, s.bodies);
    case PartKind::beam:
      return is_index(m.part, s.beams) &&
             is_index(m.node, chain_nodes(s.beam[m.part].elements) - 2);
    case PartKind::rail:
      return is_index(m.part, s.ports);
  }
  return false;
}

/// Part of a valid marker among bodies, beams, the track; -1 on the ground.
std::int32_t part_of(const SystemModel& s, const MarkerModel& m) noexcept {
  switch (m.kind) {
    case PartKind::body:
      return m.part;
    case PartKind::beam:
      return s.bodies + m.part;
    case PartKind::rail:
      return s.bodies + s.beams;
    case PartKind::ground:
      break;
  }
  return -1;
}

bool motions_are_valid(const SystemModel& s) noexcept {
  for (std::int32_t i = 0; i < s.motions; ++i) {
    const MotionModel& own = s.motion[i];
    if (own.first < 0 || own.pieces < 1 || std::int64_t{own.first} + own.pieces > s.pieces)
      return false;
  }
  return s.pieces == 0 || (s.piece_start && s.piece);
}

/// Checks the law of a row only; its markers and motions are checked elsewhere.
bool law_is_valid(const SystemModel& s, std::int32_t r) noexcept {
  const RowModel& row = s.row[r];
  for (const double x : {row.offset, row.compliance, row.stiffness, row.damping})
    if (!is_moderate(x)) return false;
  if (r >= s.joint_rows)
    return row.kind == RowKind::spring && is_not_negative(row.stiffness) &&
           is_not_negative(row.damping) && row.stiffness + row.damping > 0.;
  if (row.kind < RowKind::along_ground || row.kind >= RowKind::spring) return false;
  return is_not_negative(row.compliance) &&
         (row.kind != RowKind::distance || is_above_zero(row.offset));
}

/// Number of markers that a step places: all but those of sensors, which come last.
std::int32_t placed(const SystemModel& s) noexcept { return s.markers - s.sensors; }

bool row_is_valid(const SystemModel& s, std::int32_t r) noexcept {
  const RowModel& row = s.row[r];
  const std::int32_t rows = system_rows(s);
  if (!law_is_valid(s, r) || !is_index(row.a, placed(s)) || !is_index(row.b, placed(s)))
    return false;
  if (!is_index(row.i, 3) || !is_index(row.j, 3) || !is_index(row.l, 3)) return false;
  if (row.motion < -1 || row.motion >= s.motions || !is_index(row.joint, rows)) return false;
  for (std::int32_t side = 0; side < 2; ++side) {
    const std::int32_t end = row.end[side];
    const bool grounded = part_of(s, s.marker[side == 0 ? row.a : row.b]) < 0;
    if (grounded ? end != -1 : !is_index(end, s.ends)) return false;
    if (!grounded && (s.end[end].row != r || s.end[end].side != side)) return false;
  }
  return true;
}

/// Whether every end belongs to its row and to the part that lists it. Rows must be valid.
bool ends_are_valid(const SystemModel& s) noexcept {
  const std::int32_t parts = s.bodies + s.beams + 1;
  if (s.part_end[0] != 0 || s.part_end[parts] != s.ends) return false;
  for (std::int32_t p = 0; p < parts; ++p)
    if (s.part_end[p] > s.part_end[p + 1]) return false;
  for (std::int32_t p = 0; p < parts; ++p)
    for (std::int32_t e = s.part_end[p]; e < s.part_end[p + 1]; ++e) {
      const EndModel& end = s.end[e];
      if (!is_index(end.row, system_rows(s)) || !is_index(end.side, 2)) return false;
      const RowModel& row = s.row[end.row];
      if (row.end[end.side] != e) return false;
      if (part_of(s, s.marker[end.side == 0 ? row.a : row.b]) != p) return false;
    }
  return true;
}

/// @param inputs  of the model
bool force_is_valid(const SystemModel& s, const PointForceModel& f, std::int32_t inputs) noexcept {
  const bool given = f.motion == -1 && is_index(f.input, inputs);
  const bool timed = is_index(f.motion, s.motions) && f.input == -1;
  if (!is_index(f.marker, placed(s)) || !(given || timed) || !are_moderate(f.direction))
    return false;
  const PartKind on = s.marker[f.marker].kind;
  return f.moment == 0 || (f.moment == 1 && on == PartKind::body);
}

bool is_read(const SystemModel& s) noexcept {
  if (!are_indices(s.sensor, s.sensors, s.markers)) return false;
  if (s.sensors > 0 && s.sensor_rest == nullptr) return false;
  return are_indices(s.traced_joint, s.traced_joints, system_rows(s)) &&
         are_indices(s.traced_spring, s.traced_springs, s.spring_rows);
}

}  // namespace

bool system_is_valid(const Model& m) noexcept {
  const SystemModel& s = m.system;
  if (!solve_is_valid(m.scheme, s) || !stands_alone_or_beside(m) || !parts_are_valid(m))
    return false;
  if (!s.constant_force || !s.per_length || !s.beam_rest || s.sensors > s.markers) return false;
  for (std::int32_t i = 0; i < s.markers; ++i)
    if (!marker_is_valid(s, s.marker[i])) return false;
  if (!motions_are_valid(s)) return false;
  for (std::int32_t r = 0; r < system_rows(s); ++r)
    if (!row_is_valid(s, r)) return false;
  for (std::int32_t i = 0; i < s.forces; ++i)
    if (!force_is_valid(s, s.force[i], m.inputs)) return false;
  return ends_are_valid(s) && is_read(s);
}

bool system_start_is_valid(const Model& m) noexcept {
  const double* q = m.start + (start_doubles(m) - system_start_doubles(m.system));
  for (std::int32_t b = 0; b < m.system.bodies; ++b, q += 4) {
    const double off = ((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3])) - 1.;
    if (!(off > -1e-9 && off < 1e-9)) return false;
  }
  return true;
}

}  // namespace railstep
