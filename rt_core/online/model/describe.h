#pragma once
#include <initializer_list>

#include "online/model/describe_runner.h"
#include "online/model/describe_system.h"
#include "online/model/state.h"

namespace railstep {

// The order of a model's numbers in a block, for writing and for reading. An Archive has
//   count(int32&, most)          0 to most
//   integer(int32 or int64&)     any
//   real(double&)                any finite one
//   bound(double&)               any but NaN
//   reals(const double*&, n)     n of them, or none and a null pointer
//   integers(const int32*&, n)   n of them
//   structures(const T*&, n)     n of them, T flat (describe_system.h)
// and the results of describe() may be read only if the counts were valid.

template <typename Archive>
void describe(Archive& a, Scheme& s) {
  for (double* x : {&s.dt, &s.uv, &s.ua, &s.ug, &s.va, &s.vg, &s.kv, &s.kg, &s.ag, &s.a0, &s.aa,
                    &s.theta, &s.stage_fraction, &s.stage_weight})
    a.real(*x);
  a.count(s.mean, 1);
}

template <typename Archive>
void describe(Archive& a, Diagonals& d, int n) {
  d.n = n;
  a.count(d.count, 4 * n);
  a.integers(d.offset, d.count);
  a.reals(d.value, static_cast<std::int64_t>(d.count) * n);
}

template <typename Archive>
void describe(Archive& a, Band& band, int size) {
  band.panels = size / kLanes;
  a.count(band.left, size);
  const std::int64_t panel = std::int64_t{kLanes} * band.left;
  a.reals(band.forward, band.panels * panel);
  a.reals(band.inverse, std::int64_t{band.panels} * kLanes * kLanes);
  a.reals(band.backward, band.panels * panel);
}

template <typename Archive>
void describe(Archive& a, Modal& m, int size) {
  m.count = size;
  for (Complex* c : {&m.rate, &m.keep, &m.old_force, &m.new_force, &m.held_force}) {
    a.reals(c->re, size);
    a.reals(c->im, size);
  }
  a.count(m.rows, kMostRows);
  a.reals(m.shape, std::int64_t{2} * m.rows * size);
  a.reals(m.between, std::int64_t{m.rows} * m.rows);
}

template <typename Archive>
void describe(Archive& a, BayShift& s, int size) {
  a.integers(s.from, size);
  a.reals(s.own, size);
  a.reals(s.other, size);
  a.reals(s.fill, size);
}

template <typename Archive>
void describe(Archive& a, Endless& e) {
  a.count(e.bays, kMostElements);
  if (e.bays == 0) return;
  a.count(e.bay_elements, kMostElements);
  a.real(e.bay_length);
  a.real(e.origin);
  for (std::int64_t* i : {&e.progress.period, &e.progress.bays, &e.progress.advance}) a.integer(*i);
}

/// Line `at`; a line with a twin has the twin's matrices or modes.
template <typename Archive>
void describe(Archive& a, Model& m, std::int32_t at) {
  LineModel& line = m.line[at];
  a.count(line.first, kMostUnknowns);
  a.real(line.rail_factor[0]);
  a.real(line.rail_factor[1]);
  a.count(line.mirrored, 1);
  a.count(line.rigid_section, 1);
  a.count(line.twin, at);
  if (line.twin < at) {
    const LineModel& twin = m.line[line.twin];
    line.size = twin.size;
    line.step = twin.step;
    line.reach = twin.reach;
    line.mass = twin.mass;
    line.damping = twin.damping;
    line.modal = twin.modal;
    line.shift = twin.shift;
    for (int rail = 0; rail < 2; ++rail) line.unknown_of[rail] = twin.unknown_of[rail];
    line.components = twin.components;
    return;
  }
  a.count(line.size, kMostUnknowns);
  if (m.endless.bays > 0) describe(a, line.shift, line.size);
  const std::int64_t table = std::int64_t{27} * m.elements;
  a.count(line.components, (1 << 9) - 1);
  std::int32_t second = line.unknown_of[0] != line.unknown_of[1] ? 1 : 0;
  a.integers(line.unknown_of[0], table);
  a.count(second, 1);
  if (second == 0)
    line.unknown_of[1] = line.unknown_of[0];
  else
    a.integers(line.unknown_of[1], table);
  if (m.form == Form::condensed) return describe(a, line.modal, line.size);
  describe(a, line.step, line.size);
  a.count(line.reach, line.size / kLanes);
  describe(a, line.mass, line.size);
  describe(a, line.damping, line.size);
}

template <typename Archive>
void describe(Archive& a, LoadModel& l) {
  for (double& x : l.row) a.real(x);
  a.count(l.rail, 1);
  a.bound(l.stop);
  for (double* x : {&l.start, &l.force, &l.amplitude, &l.frequency, &l.phase}) a.real(*x);
  describe(a, l.travel);
  a.count(l.table_points, kMostRows);
  a.reals(l.table, std::int64_t{2} * l.table_points);
  a.count(l.load_point, kMaxLoadPoints - 1);
}

template <typename Archive>
void describe(Archive& a, SignalModel& s) {
  a.real(s.start);
  a.real(s.step);
  a.count(s.intervals, kMostSamples);
  a.count(s.periodic, 1);
  a.reals(s.coefficient, s.intervals == 0 ? 0 : std::int64_t{s.intervals} + 3);
}

template <typename Archive>
void describe(Archive& a, ContactLaw& c) {
  for (double* x : {&c.hertz, &c.stiffness, &c.damping}) a.real(*x);
}

template <typename Archive>
void describe(Archive& a, FlangeModel& f) {
  a.count(f.wheelset, kMaxWheelsets - 1);
  for (double* pair : {f.normal, f.point[0], f.point[1], f.gauge[0], f.gauge[1]}) {
    a.real(pair[0]);
    a.real(pair[1]);
  }
  a.real(f.tip);
}

template <typename Archive>
void describe(Archive& a, WheelsetModel& w) {
  describe(a, w, kMotions);
  for (double* x : {&w.radius, &w.tread_half_width, &w.rest_z, &w.tolerance, &w.alpha, &w.beta})
    a.real(*x);
  std::int32_t guide = static_cast<std::int32_t>(w.guide);
  a.count(guide, static_cast<std::int32_t>(Guide::elimination));
  w.guide = static_cast<Guide>(guide);
  a.count(w.cap, kMostGuideIterations);
}

/// The bodies of all contacts must be known.
template <typename Archive>
void describe(Archive& a, ContactModel& c, const Model& m) {
  std::int32_t kind = static_cast<std::int32_t>(c.kind);
  a.count(kind, static_cast<std::int32_t>(ContactKind::wheel));
  c.kind = static_cast<ContactKind>(kind);
  const bool upright = c.kind == ContactKind::wheel;
  a.count(c.bodies, (upright ? kMaxVehicles : kMaxWheelsets) - 1);
  a.count(c.rail, 1);
  describe(a, c.law);
  std::int32_t load_point = c.load_point + 1;
  a.count(load_point, kMaxLoadPoints);
  c.load_point = load_point - 1;
  describe(a, c.tread);
  a.real(c.place);
  const std::int64_t n = upright ? m.vehicle[c.bodies].size : 0;
  for (const double** of : {&c.row, &c.moved}) a.reals(*of, n);
}

template <typename Archive>
void describe(Archive& a, ResidualModel& r, std::int32_t elements, std::int32_t runners) {
  a.count(r.load_points, kMaxLoadPoints);
  a.count(r.points, kMostRows);
  a.count(r.elements, elements);
  const std::int64_t table = std::int64_t{r.load_points} * r.elements * (r.points + 1);
  a.reals(r.under, table);
  a.reals(r.axis, table);
  a.count(r.pair_points, kMostPairPoints);
  const std::int64_t block = std::int64_t{r.pair_points + 1} * (r.pair_points + 1);
  for (std::int32_t i = 0; i < r.load_points; ++i)
    for (std::int32_t j = 0; j < r.load_points; ++j) {
      PairModel& pair = r.pair[i][j];
      a.count(pair.range, elements);
      a.reals(pair.value, std::int64_t{r.elements} * (2 * pair.range + 1) * block);
    }
  a.reals(r.seat, 2 * std::int64_t{runners} * r.elements * (r.points + 1) * kSeatResiduals);
}

template <typename Archive>
void describe(Archive& a, PDeltaModel& t, std::int32_t elements) {
  a.count(t.elements_per_bay, kMostElements);
  a.count(t.points, kMostPairPoints);
  for (const double*& lever : t.lever)
    a.reals(lever, std::int64_t{elements} * kPDeltaSeats * (t.points + 1));
}

template <typename Archive>
void describe(Archive& a, TrackSensorModel& p, const Model& m) {
  a.count(p.count, kMostRows);
  a.integers(p.start, p.count + 1);
  a.count(p.entries, kMostEntries);
  a.integers(p.index, p.entries);
  a.reals(p.value, p.entries);
  a.reals(p.rest, p.count);
  a.integers(p.along, p.count);
  a.integers(p.table, p.count);
  a.count(p.tables, kMostRows);
  if (p.tables == 0) return;
  a.count(p.elements, kMostEntries);
  a.integers(p.first, p.tables);
  a.integers(p.ends, p.tables + 1);
  const std::int64_t of_element = std::int64_t{m.residual.load_points} * (m.residual.points + 1);
  a.reals(p.residual, p.elements * of_element);
}

template <typename Archive>
void describe(Archive& a, FixedPortModel& p, const Model& m) {
  a.count(p.count, kMaxFixedPorts);
  if (p.count == 0) return;
  a.reals(p.stiffness, p.count);
  a.reals(p.damping, p.count);
  a.reals(p.gap, p.count);
  if (m.form == Form::condensed) {
    a.reals(p.shape, std::int64_t{2} * p.count * m.line_unknowns);
  } else {
    a.count(p.entries, kMostEntries);
    a.integers(p.start, p.count + 1);
    a.integers(p.index, p.entries);
    a.reals(p.value, p.entries);
    a.integers(p.panels, std::int64_t{2} * p.count * m.lines);
  }
  a.reals(p.response, std::int64_t{2} * p.count * m.line_unknowns);
  a.reals(p.compliance, std::int64_t{p.count} * p.count);
}

/// A track and its traffic; its arrays include the unknowns of a system beside it.
template <typename Archive>
void describe_track(Archive& a, Model& m) {
  a.real(m.element_length);
  describe(a, m.endless);
  for (double* of_rails : {m.rail_y, m.rail_z, m.head_z, m.crown_radius, m.head_half_width}) {
    a.real(of_rails[0]);
    a.real(of_rails[1]);
  }
  for (Cant& cant : m.cant) {
    a.real(cant.cosine);
    a.real(cant.sine);
  }
  a.reals(m.constant_force, std::int64_t{parts(m.form)} * m.unknowns);
  for (std::int32_t i = 0; i < m.lines; ++i) describe(a, m, i);
  for (std::int32_t i = 0; i < m.loads; ++i) describe(a, m.load[i]);
  for (std::int32_t i = 0; i < m.wheelsets; ++i) describe(a, m.wheelset[i]);
  const std::int32_t room = (kMaxWheels - wheel_count(m)) / 2;
  a.count(m.flanges, m.wheelsets < room ? m.wheelsets : room);
  for (std::int32_t i = 0; i < m.flanges; ++i) describe(a, m.flange[i]);
  for (std::int32_t i = 0; i < m.vehicles; ++i) describe(a, m.vehicle[i], kMaxVehicleUnknowns);
  for (const ContactId i : contacts(m)) describe(a, m.contact[i], m);
  a.count(m.runners, kMaxRunners);
  a.count(m.runner_wheelsets, kMaxRunnerWheelsets);
  a.count(m.runner_force_elements, kMaxRunnerForceElements);
  a.count(m.element_coordinates, 2 * m.runner_force_elements);
  a.count(m.element_memory, kMostElementMemory * m.runner_force_elements);
  a.count(m.runner_traced, kMaxRunnerTraced);
  a.count(m.runner_rods, kMaxRunnerRods);
  describe(a, m.design_line);
  for (std::int32_t i = 0; i < m.runners; ++i) describe(a, m.runner[i], m.design_line);
  for (std::int32_t i = 0; i < m.signals; ++i) {
    a.count(m.signal[i].rail, 1);
    a.count(m.signal[i].direction, 2);
    describe(a, m.signal[i].signal);
  }
  a.count(m.external_wheels, kMaxExternalWheels);
  for (std::int32_t i = 0; i < m.external_wheels; ++i) {
    a.count(m.external_wheel[i].rail, 1);
    a.count(m.external_wheel[i].input, kMaxInputs);
    a.count(m.external_wheel[i].load_point, kMaxLoadPoints - 1);
  }
  describe(a, m.residual, m.elements, m.runners);
  describe(a, m.p_delta, m.elements);
  describe(a, m.track_sensor, m);
  describe(a, m.fixed, m);
}

/// All but the start. A system alone has no lines and no other parts of a track.
template <typename Archive>
void describe(Archive& a, Model& m) {
  describe(a, m.scheme);
  a.count(m.lines, kMaxLines);
  a.count(m.loads, kMaxLoads);
  a.count(m.wheelsets, kMaxWheelsets);
  a.count(m.vehicles, kMaxVehicles);
  a.count(m.vehicle_wheels, kMaxWheels - tread_count(m));
  a.count(m.signals, kMaxSignals);
  a.count(m.elements, kMostElements);
  a.count(m.unknowns, kMostUnknowns);
  std::int32_t form = static_cast<std::int32_t>(m.form);
  a.count(form, static_cast<std::int32_t>(Form::condensed));
  m.form = static_cast<Form>(form);
  a.count(m.line_unknowns, m.unknowns);
  a.count(m.steps_per_frame, kMostRows);
  a.count(m.inputs, kMaxInputs);
  for (std::int32_t i = 0; i < m.inputs; ++i) a.real(m.input_limit[i]);
  a.integer(m.steps);
  for (std::int64_t* most : {&m.cost.flops, &m.cost.bytes, &m.cost.instructions}) a.integer(*most);
  a.count(m.system.unknowns, m.unknowns);
  if (m.elements > 0) describe_track(a, m);
  if (m.system.unknowns > 0)
    describe(a, m.system, std::int64_t{parts(m.form)} * m.line_unknowns, m.unknowns);
}

/// The start, after a valid model, which determines its length.
template <typename Archive>
void describe_start(Archive& a, Model& m) {
  a.reals(m.start, start_doubles(m));
}

}  // namespace railstep
