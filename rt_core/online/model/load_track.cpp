#include "online/model/load_track.h"

#include "online/math/dense.h"
#include "online/math/finite.h"
#include "online/math/newton.h"
#include "online/model/external_input.h"
#include "online/model/load_design_line.h"
#include "online/model/progress.h"
#include "online/model/state.h"

namespace railstep {

namespace {

bool within(const std::int32_t* values, std::int64_t n, std::int64_t least,
            std::int64_t most) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (values[i] < least || values[i] > most) return false;
  return true;
}

bool are_above_zero(const double* values, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(values[i] > 0.)) return false;
  return true;
}

bool are_moderate(const double* values, std::int64_t n) noexcept {
  bool moderate = true;
  for (std::int64_t i = 0; i < n; ++i) moderate = moderate && is_moderate(values[i]);
  return moderate;
}
bool are_not_negative(const double* values, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(values[i] >= 0.)) return false;
  return true;
}

/// Whether the diagonal of a matrix [n][n] is above 0.
bool diagonal_is_above_zero(const double* matrix, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(matrix[i * n + i] > 0.)) return false;
  return true;
}

bool diagonal_is_not_negative(const double* matrix, std::int64_t n) noexcept {
  for (std::int64_t i = 0; i < n; ++i)
    if (!(matrix[i * n + i] >= 0.)) return false;
  return true;
}

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

bool travel_is_valid(const TravelModel& t) noexcept { return t.rows == 0 || t.table != nullptr; }

bool force_is_valid(const Model& m, const BodyForce& f) noexcept {
  return f.input >= 0 ? f.input < m.inputs : f.points > 0 && f.table != nullptr;
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

bool suspended_is_valid(const Model& m, const SuspendedModel& b) noexcept {
  if (b.first < m.line_unknowns || b.first + b.size > m.unknowns || b.size < 1) return false;
  for (std::int32_t i = 0; i < b.forces; ++i)
    if (b.force[i].direction >= b.size || !force_is_valid(m, b.force[i])) return false;
  return travel_is_valid(b.travel) && b.mass && b.rest && b.damping && b.stiffness && b.inverse &&
         are_not_negative(b.mass, b.size) && diagonal_is_not_negative(b.inverse, b.size);
}

bool wheelset_is_valid(const Model& m, const WheelsetModel& w) noexcept {
  return w.size == kMotions && suspended_is_valid(m, w) && w.cap >= 1 && w.radius > 0. &&
         are_above_zero(w.mass, kMotions);
}

bool vehicle_is_valid(const Model& m, const SuspendedModel& v) noexcept {
  return suspended_is_valid(m, v) && are_above_zero(v.mass, v.size) &&
         diagonal_is_above_zero(v.inverse, v.size);
}

bool friction_is_valid(const RollingFriction& f) noexcept {
  if (f.places > 0 && f.parts == nullptr) return false;
  for (std::int32_t i = 0; i < f.places; ++i) {
    const double* const row = f.parts + std::ptrdiff_t{3} * i;
    if (!are_above_zero(row + 1, 2) || (i > 0 && !(row[0] > row[-3]))) return false;
  }
  return are_above_zero(f.rail, 2) && f.kinetic > 0. && f.kinetic <= 1. && f.half > 0.;
}

bool creep_is_valid(const RollingCreep& c) noexcept {
  const RollingPatch& p = c.patch;
  const double coefficients[] = {p.kalker.c11, p.kalker.c22, p.kalker.c23, p.kalker.c33,
                                 p.exponent};
  return are_not_negative(coefficients, 5) && friction_is_valid(c.friction) && p.half_length > 0. &&
         p.half_width > 0. && p.shear > 0. && (c.law != CreepLaw::fastsim || c.strips > 0);
}

bool profile_is_valid(const ProfileTable& t) noexcept {
  return t.points >= 2 && t.per_step > 0. && t.coefficient &&
         are_moderate(t.coefficient, 4 * std::int64_t{t.points});
}

bool profiles_are_valid(const ProfileContact& c) noexcept {
  const ProfilePair& pair = c.pair;
  for (const double* places : {pair.search_place, pair.search_growth, pair.search_slope})
    if (!places || !are_moderate(places, kSearchStrips)) return false;
  for (int i = 1; i < kSearchStrips; ++i)
    if (!(pair.search_place[i] > pair.search_place[i - 1])) return false;
  return profile_is_valid(pair.wheel) && profile_is_valid(pair.rail) && pair.half_distance > 0. &&
         pair.radius > 0. && pair.modulus > 0. && pair.patches > 0 && c.poisson >= 0.;
}

bool contact_is_valid(const RollingContact& c) noexcept {
  const bool drawn = has_profiles(c);
  return c.hertz > 0. && (drawn ? c.crown_radius == 0. : c.crown_radius > 0.) &&
         c.half_distance > 0. && c.slope >= 0. && c.relaxation >= 0. && creep_is_valid(c.creep) &&
         (!drawn || profiles_are_valid(c.profiles));
}

/// How many wheelsets, rods and force elements runners have, with the coordinates and the memory of
/// the latter.
struct RunnerCounts {
  std::int32_t wheelsets = 0, rods = 0, elements = 0, coordinates = 0, memory = 0, traced = 0;
};

/// A curve that does not fall and has no leaps.
bool curve_is_valid(const RisingCurve& c) noexcept {
  if (c.points < 1 || !c.point || !is_not_negative(c.slope_before)) return false;
  for (std::int32_t i = 0; i < c.points; ++i) {
    const double *at = c.point + std::ptrdiff_t{3} * i, *next = at + 3;
    if (!is_moderate(at[0]) || !is_moderate(at[1]) || !is_not_negative(at[2])) return false;
    if (i + 1 == c.points) break;
    const double leap = at[1] + at[2] * (next[0] - at[0]) - next[1];
    if (!(next[0] >= at[0]) || !(std::fabs(leap) <= 1e-9 * (1. + std::fabs(next[1])))) return false;
  }
  return true;
}

bool element_is_valid(const Model& m, const ForceElement& e) noexcept {
  const bool friction = is_friction(e.law);
  if (!is_moderate(e.preload) || !is_moderate(e.load_at_rest)) return false;
  if (!is_not_negative(e.load_stiffness)) return false;
  if (e.loaded != 0 && !friction && e.law != ElementLaw::damper) return false;
  if (e.per_way != 0. && e.law != ElementLaw::slider) return false;
  if (has_curve(e.law)) return curve_is_valid(e.curve);
  if (!force_is_valid(m, e.value)) return false;
  if (!friction) return true;
  const bool constant = e.value.input < 0 && e.value.points == 1 && e.loaded == 0;
  return is_above_zero(e.stiffness) && is_not_negative(e.damping) && is_not_negative(e.per_way) &&
         (constant || e.law != ElementLaw::berg);
}

bool elements_are_valid(const Model& m, const RunnerModel& r, const RunnerCounts& before) noexcept {
  std::int32_t coordinates = 0, memory = before.memory;
  for (std::int32_t i = 0; i < r.force_elements; ++i) {
    const ForceElement& e = r.force_element[i];
    if (!element_is_valid(m, e) || e.coordinate != coordinates || e.memory != memory) return false;
    coordinates += 1 + e.loaded;
    memory += memory_of(e.law);
  }
  return r.first_force_element == before.elements && r.element_coordinates == coordinates &&
         r.first_element_coordinate == before.coordinates &&
         (coordinates == 0 || (r.element_row && r.element_moved && r.element_compliance &&
                               are_not_negative(r.element_compliance, coordinates)));
}

bool traced_are_valid(const RunnerModel& r, const RunnerCounts& before) noexcept {
  if (r.traced_elements > 0 && (!r.traced || !r.traced_row)) return false;
  for (std::int32_t i = 0; i < r.traced_elements; ++i) {
    const TracedElement& e = r.traced[i];
    for (const double x : {e.stiffness, e.damping, e.series, e.preload})
      if (!is_moderate(x)) return false;
    if (e.deflection < 0 || e.deflection >= r.size || e.axis < 0 || e.axis > kTracedLine)
      return false;
  }
  return r.first_traced == before.traced;
}

/// Wheelsets are among the bodies, and follow those of the runners before, as rods and force
/// elements do.
bool runner_is_valid(const Model& m, const RunnerModel& r, const RunnerCounts& before) noexcept {
  if (!suspended_is_valid(m, r) || !elements_are_valid(m, r, before) || r.bodies < 1) return false;
  if (!traced_are_valid(r, before)) return false;
  if (r.first_wheelset != before.wheelsets || r.wheelsets < 1) return false;
  if (r.rolls_freely != 0 && (!r.by_way || (m.lines > 0 && m.endless.bays != 0))) return false;
  if (r.first_rod != before.rods || !r.reaction || (r.rods > 0 && !r.rod_row)) return false;
  for (std::int32_t i = 0; i < r.wheelsets; ++i) {
    const RunnerWheelset& w = r.wheelset[i];
    if (w.first % kMotions != 0 || w.first / kMotions >= r.bodies || !(w.radius > 0.)) return false;
  }
  return contact_is_valid(r.contact) && r.compliance && frames_are_valid(m.design_line, r) &&
         are_above_zero(r.mass, std::int64_t{kMotions} * r.bodies) &&
         diagonal_is_not_negative(r.compliance, interface_size(r));
}

bool runners_are_valid(const Model& m) noexcept {
  RunnerCounts all;
  for (std::int32_t i = 0; i < m.runners; ++i) {
    if (!runner_is_valid(m, m.runner[i], all)) return false;
    const RunnerModel& r = m.runner[i];
    all.wheelsets += r.wheelsets;
    all.rods += r.rods;
    all.elements += r.force_elements;
    all.coordinates += r.element_coordinates;
    all.traced += r.traced_elements;
    for (std::int32_t j = 0; j < r.force_elements; ++j)
      all.memory += memory_of(r.force_element[j].law);
  }
  return all.wheelsets == m.runner_wheelsets && all.rods == m.runner_rods &&
         all.traced == m.runner_traced && all.elements == m.runner_force_elements &&
         all.coordinates == m.element_coordinates && all.memory == m.element_memory &&
         newton_size(m) <= kMostNewton && (m.lines == 0 || all.wheelsets <= kMaxSeatedWheelsets);
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
