#include "online/model/load_track.h"

#include "online/math/dense.h"
#include "online/math/finite.h"
#include "online/model/external_input.h"
#include "online/model/load_design_line.h"
#include "online/model/load_runner.h"
#include "online/model/load_values.h"
#include "online/model/progress.h"
#include "online/model/state.h"

namespace railstep {

namespace {

/// Whether the force grows with the penetration.
bool contact_is_valid(const ContactLaw& c) noexcept {
  return c.hertz > 0. || (c.stiffness > 0. && c.damping >= 0.);
}

bool endless_is_valid(const Endless& e, std::int32_t elements) noexcept {
  if (e.bays == 0) return true;
  return e.bay_elements > 0 && std::int64_t{e.bays} * e.bay_elements == elements &&
         e.bay_length > 0. && e.origin >= 0. && e.progress.period > 0 && e.progress.bays >= 0 &&
         e.progress.bays <= e.progress.period && e.progress.advance >= 0 &&
         e.progress.advance < kBay;
}

bool line_is_valid(const Model& m, const LineModel& line) noexcept {
  if (line.size % kLanes != 0 || line.first + line.size > m.line_unknowns) return false;
  if (m.endless.bays > 0 && line.size > 0 &&
      !(within(line.shift.from, line.size, 0, line.size - 1) && line.shift.own &&
        line.shift.other && line.shift.fill))
    return false;
  const std::int64_t most = (m.form == Form::condensed ? line.modal.rows : line.size) - 1;
  for (const std::int32_t* table : line.unknown_of)
    if (!within(table, std::int64_t{27} * m.elements, -1, most)) return false;
  if (m.form == Form::condensed)
    return line.size == 0 ||
           (line.modal.rate.re && line.modal.rate.im && line.modal.keep.re && line.modal.keep.im &&
            line.modal.old_force.re && line.modal.old_force.im && line.modal.new_force.re &&
            line.modal.new_force.im && line.modal.held_force.re && line.modal.held_force.im &&
            (line.modal.rows == 0 || line.modal.shape));
  const auto diagonals_are_valid = [&](const Diagonals& d) noexcept {
    return within(d.offset, d.count, -line.size, line.size) && (d.count == 0 || d.value);
  };
  return line.step.left % kLanes == 0 && line.step.inverse &&
         (line.step.left == 0 || (line.step.forward && line.step.backward)) &&
         diagonals_are_valid(line.mass) && diagonals_are_valid(line.damping);
}

/// Whether it is a rotation, to rounding.
bool is_rotation(const Cant& cant) noexcept {
  const double off = (cant.cosine * cant.cosine + cant.sine * cant.sine) - 1.;
  return off > -1e-14 && off < 1e-14 && cant.cosine > 0.;
}

bool signal_is_valid(const SignalModel& s) noexcept {
  return s.intervals == 0 || (s.step > 0. && s.coefficient != nullptr);
}

/// Whether a load does not stop before its start, seen along its motion (track/moving_load.cpp).
bool load_is_valid(const LoadModel& l) noexcept {
  if (l.table_points > 0 && l.table == nullptr) return false;
  const bool ahead = l.travel.speed >= 0. ? l.stop > -kMostNumber : l.stop < kMostNumber;
  return ahead && travel_is_valid(l.travel);
}

/// Each external wheel has its own inputs.
bool external_wheels_are_valid(const Model& m) noexcept {
  for (std::int32_t i = 0; i < m.external_wheels; ++i)
    if (m.external_wheel[i].input + kExternalInputs > m.inputs) return false;
  return true;
}

/// Flanges are in the order of their wheelsets, one pair each.
bool flanges_are_valid(const Model& m) noexcept {
  for (std::int32_t i = 0; i < m.flanges; ++i) {
    const FlangeModel& f = m.flange[i];
    if (f.wheelset >= m.wheelsets || (i > 0 && f.wheelset <= m.flange[i - 1].wheelset))
      return false;
  }
  return true;
}

bool wheelset_is_valid(const Model& m, const WheelsetModel& w) noexcept {
  return w.size == kMotions && suspended_is_valid(m, w) && w.cap >= 1 && w.radius > 0. &&
         are_above_zero(w.mass, kMotions);
}

bool vehicle_is_valid(const Model& m, const SuspendedModel& v) noexcept {
  return suspended_is_valid(m, v) && are_above_zero(v.mass, v.size) &&
         diagonal_is_above_zero(v.inverse, v.size);
}

/// Whether a contact of each kind is where its number says, with bodies that have it.
bool has_its_place(const Model& m, ContactId i) noexcept {
  const ContactModel& c = m.contact[i];
  if (i < tread_count(m))
    return c.kind == ContactKind::tread && i == tread_of(c.bodies, c.rail) && c.law.hertz > 0.;
  if (i >= wheel_count(m)) {
    const std::int32_t pair = flange_pair(m, i);
    return c.kind == ContactKind::flange && i == flange_contact(m, flange_number(pair, c.rail)) &&
           c.bodies == m.flange[pair].wheelset;
  }
  return c.kind == ContactKind::wheel && c.bodies < m.vehicles && c.row && c.moved &&
         dot(c.row, c.moved, m.vehicle[c.bodies].size) > 0.;
}

bool contact_is_valid(const Model& m, ContactId i) noexcept {
  const ContactModel& c = m.contact[i];
  return has_its_place(m, i) && contact_is_valid(c.law) && signal_is_valid(c.tread) &&
         (is_flange(m, i) ? c.load_point == kNoLoadPoint : c.load_point >= 0);
}

/// Values may be a little below 0, where elements yield more than a rail does. Their sum with the
/// lines' compliance is above 0 if pack_residual.cpp made them; if it is not, the solve of the
/// ports says so and gives no force.
bool residual_is_valid(const Model& m) noexcept {
  const ResidualModel& r = m.residual;
  const bool tables = r.under != nullptr || r.axis != nullptr || r.seat != nullptr ||
                      m.track_sensor.residual != nullptr;
  if (tables && (r.points < 3 || r.elements < 1)) return false;
  for (std::int32_t i = 0; i < m.loads && tables; ++i)
    if (m.load[i].load_point >= r.load_points) return false;
  for (const ContactId i : contacts(m))
    if (tables && m.contact[i].load_point >= r.load_points) return false;
  for (std::int32_t i = 0; i < m.runners && tables; ++i)
    if (m.runner[i].load_point[0] >= r.load_points || m.runner[i].load_point[1] >= r.load_points)
      return false;
  for (std::int32_t i = 0; i < m.external_wheels && tables; ++i)
    if (m.external_wheel[i].load_point >= r.load_points) return false;
  for (std::int32_t i = 0; i < r.load_points; ++i)
    for (std::int32_t j = 0; j < r.load_points; ++j)
      if (r.pair[i][j].value != nullptr && r.pair_points < 3) return false;
  return true;
}

bool p_delta_is_valid(const PDeltaModel& t) noexcept {
  return (t.lever[0] == nullptr && t.lever[1] == nullptr) ||
         (t.elements_per_bay > 0 && t.points >= 3);
}

/// Whether every table lies within the track and after the one before it.
bool tables_are_valid(const Model& m) noexcept {
  const TrackSensorModel& p = m.track_sensor;
  if (p.tables == 0) return true;
  if (!p.first || !p.ends || p.ends[0] != 0 || p.ends[p.tables] != p.elements) return false;
  for (std::int32_t i = 0; i < p.tables; ++i) {
    const std::int64_t count = std::int64_t{p.ends[i + 1]} - p.ends[i];
    if (count < 0 || p.first[i] < 0 || p.first[i] + count > m.elements) return false;
  }
  return true;
}

bool track_sensors_are_valid(const Model& m) noexcept {
  const TrackSensorModel& p = m.track_sensor;
  if (p.start == nullptr || p.start[0] != 0 || p.start[p.count] != p.entries) return false;
  for (std::int32_t i = 0; i < p.count; ++i)
    if (p.start[i] > p.start[i + 1]) return false;
  const std::int64_t values = std::int64_t{3} * m.unknowns + m.fixed.count;
  return within(p.index, p.entries, 0, values - 1) && within(p.table, p.count, -1, p.tables - 1) &&
         (p.count == 0 || (p.rest && p.along)) && (p.entries == 0 || p.value) &&
         tables_are_valid(m);
}

/// Whether the panels of each fixed port lie in their lines.
bool panels_are_valid(const Model& m) noexcept {
  const std::int32_t* at = m.fixed.panels;
  for (std::int32_t j = 0; j < m.fixed.count; ++j)
    for (std::int32_t l = 0; l < m.lines; ++l, at += 2)
      if (at[0] < 0 || at[0] > at[1] || at[1] > m.line[l].size / kLanes) return false;
  return true;
}

bool fixed_ports_are_valid(const Model& m) noexcept {
  const FixedPortModel& p = m.fixed;
  if (p.count == 0) return true;
  if (!p.stiffness || !p.damping || !p.gap || !p.response || !p.compliance) return false;
  // A port on a held place has no compliance.
  if (!are_not_negative(p.stiffness, p.count) || !are_not_negative(p.damping, p.count) ||
      !diagonal_is_not_negative(p.compliance, p.count))
    return false;
  if (m.form == Form::condensed) return p.shape != nullptr;
  if (p.start == nullptr || p.start[0] != 0 || p.start[p.count] != p.entries) return false;
  for (std::int32_t i = 0; i < p.count; ++i)
    if (p.start[i] > p.start[i + 1]) return false;
  return within(p.index, p.entries, 0, m.line_unknowns - 1) && (p.entries == 0 || p.value) &&
         panels_are_valid(m);
}

}  // namespace

bool track_is_valid(const Model& m) noexcept {
  if (m.elements < 1 || !endless_is_valid(m.endless, m.elements)) return false;
  if (!(m.element_length > 0.) || m.line_unknowns % kLanes != 0) return false;
  if (m.lines == 0 && m.line_unknowns != 0) return false;
  for (std::int32_t i = 0; i < m.lines; ++i)
    if (!line_is_valid(m, m.line[i])) return false;
  for (std::int32_t i = 0; i < m.loads; ++i)
    if (!load_is_valid(m.load[i])) return false;
  for (const Cant& cant : m.cant)
    if (!is_rotation(cant)) return false;
  for (std::int32_t i = 0; i < m.wheelsets; ++i)
    if (!wheelset_is_valid(m, m.wheelset[i])) return false;
  if (!flanges_are_valid(m)) return false;
  for (std::int32_t i = 0; i < m.vehicles; ++i)
    if (!vehicle_is_valid(m, m.vehicle[i])) return false;
  for (const ContactId i : contacts(m))
    if (!contact_is_valid(m, i)) return false;
  if (!design_line_is_valid(m.design_line) || !runners_are_valid(m)) return false;
  for (std::int32_t i = 0; i < m.signals; ++i)
    if (m.signal[i].direction < 1 || !signal_is_valid(m.signal[i].signal)) return false;
  return external_wheels_are_valid(m) && residual_is_valid(m) && p_delta_is_valid(m.p_delta) &&
         track_sensors_are_valid(m) && fixed_ports_are_valid(m);
}

bool inputs_are_valid(const Model& m) noexcept {
  for (std::int32_t i = 0; i < m.inputs; ++i)
    if (!is_above_zero(m.input_limit[i])) return false;
  return true;
}

}  // namespace railstep
