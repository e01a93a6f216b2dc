#pragma once
#include <cstdint>

#include "online/model/describe_system.h"
#include "online/model/external_input.h"
#include "online/model/state.h"

namespace railstep {

// Fields of what moves along a track, see describe.h.

static_assert(is_flat<FrameElement>(0, 25));
static_assert(is_flat<TracedElement>(2, 4));

template <typename Archive>
void describe(Archive& a, TravelModel& t) {
  a.real(t.speed);
  a.count(t.rows, kMostRows);
  a.reals(t.table, std::int64_t{3} * t.rows);
}

/// @param directions  the largest direction
template <typename Archive>
void describe(Archive& a, BodyForce& f, std::int32_t directions) {
  a.count(f.direction, directions);
  std::int32_t input = f.input + 1;  // 0: none
  a.count(input, kMaxInputs);
  f.input = input - 1;
  a.count(f.points, kMostRows);
  a.reals(f.table, std::int64_t{2} * f.points);
}

template <typename Archive>
void describe(Archive& a, SuspendedModel& b, std::int32_t most) {
  a.count(b.first, kMostUnknowns);
  a.count(b.size, most);
  a.real(b.start);
  describe(a, b.travel);
  const std::int64_t n = b.size;
  for (const double** of : {&b.mass, &b.rest}) a.reals(*of, n);
  for (const double** of : {&b.damping, &b.stiffness, &b.inverse}) a.reals(*of, n * n);
  a.count(b.forces, kMaxBodyForces);
  for (std::int32_t i = 0; i < b.forces; ++i) describe(a, b.force[i], most - 1);
}

template <typename Archive>
void describe(Archive& a, ProfileTable& t) {
  a.count(t.points, kMostProfilePoints);
  a.real(t.first);
  a.real(t.per_step);
  a.reals(t.coefficient, 4 * std::int64_t{t.points});
}

template <typename Archive>
void describe(Archive& a, ProfileContact& c) {
  ProfilePair& pair = c.pair;
  describe(a, pair.wheel);
  describe(a, pair.rail);
  const std::int64_t places = pair.wheel.points > 0 ? kSearchStrips : 0;
  for (const double** of : {&pair.search_place, &pair.search_growth, &pair.search_slope})
    a.reals(*of, places);
  for (double* x : {&pair.half_distance, &pair.radius, &pair.modulus, &c.height, &c.point_y,
                    &c.point_z, &c.poisson})
    a.real(*x);
  a.count(pair.patches, kMostLeast);
}

template <typename Archive>
void describe(Archive& a, RollingContact& c) {
  for (double* x : {&c.slope, &c.half_distance, &c.crown_radius, &c.hertz, &c.relaxation})
    a.real(*x);
  RollingCreep& creep = c.creep;
  auto law = static_cast<std::int32_t>(creep.law);
  a.count(law, static_cast<std::int32_t>(CreepLaw::polach));
  creep.law = static_cast<CreepLaw>(law);
  a.count(creep.strips, kMostStrips);
  RollingPatch& patch = creep.patch;
  RollingFriction& friction = creep.friction;
  for (double* x : {&friction.rail[0], &friction.rail[1], &friction.kinetic, &friction.half,
                    &patch.half_length, &patch.half_width, &patch.shear, &patch.exponent,
                    &patch.kalker.c11, &patch.kalker.c22, &patch.kalker.c23, &patch.kalker.c33})
    a.real(*x);
  a.count(friction.places, kMostFrictionPlaces);
  a.reals(friction.parts, 3 * std::int64_t{friction.places});
  describe(a, c.profiles);
}

template <typename Archive>
void describe(Archive& a, DesignLine& l) {
  auto transition = static_cast<std::int32_t>(l.transition);
  a.count(transition, static_cast<std::int32_t>(Transition::cosine));
  l.transition = static_cast<Transition>(transition);
  for (LineTable* table : {&l.curvature, &l.cant, &l.gradient}) {
    a.count(table->rows, kMostLineRows);
    a.reals(table->value, 2 * std::int64_t{table->rows});
  }
  if (!is_there(l)) return;
  a.count(l.pieces, kMostLinePieces);
}

template <typename Archive>
void describe(Archive& a, ForceElement& e) {
  auto law = static_cast<std::int32_t>(e.law);
  a.count(law, kElementLaws - 1);
  e.law = static_cast<ElementLaw>(law);
  a.count(e.coordinate, 2 * kMaxForceElements);
  a.count(e.memory, kMostElementMemory * kMaxRunnerForceElements);
  a.count(e.curve.points, kMostCurvePoints);
  a.real(e.curve.slope_before);
  a.reals(e.curve.point, std::int64_t{3} * e.curve.points);
  for (double* x : {&e.stiffness, &e.damping, &e.per_way}) a.real(*x);
  describe(a, e.value, 0);
  a.count(e.loaded, 1);
  for (double* x : {&e.load_at_rest, &e.load_stiffness, &e.preload}) a.real(*x);
}

/// The design line must be known.
template <typename Archive>
void describe(Archive& a, RunnerModel& r, const DesignLine& line) {
  describe(a, r, kMaxRunnerUnknowns);
  a.count(r.rolls_freely, 1);
  a.real(r.start_speed);
  a.reals(r.by_way, r.rolls_freely * std::int64_t{r.size});
  a.count(r.bodies, r.size / kMotions);
  a.count(r.first_wheelset, kMaxRunnerWheelsets);
  a.count(r.wheelsets, kMaxWheelsetsOfRunner);
  for (std::int32_t i = 0; i < r.wheelsets; ++i) {
    RunnerWheelset& w = r.wheelset[i];
    a.count(w.first, kMaxRunnerUnknowns);
    for (double* x : {&w.place, &w.radius, &w.spin_inertia}) a.real(*x);
  }
  describe(a, r.contact);
  for (std::int32_t& point : r.load_point) a.count(point, kMaxLoadPoints - 1);
  a.count(r.force_elements, kMaxForceElements);
  a.count(r.first_force_element, kMaxRunnerForceElements);
  for (std::int32_t i = 0; i < r.force_elements; ++i) describe(a, r.force_element[i]);
  a.count(r.element_coordinates, 2 * r.force_elements);
  a.count(r.first_element_coordinate, 2 * kMaxRunnerForceElements);
  const std::int64_t n = r.size, meets = interface_size(r);
  for (const double** of : {&r.element_row, &r.element_moved})
    a.reals(*of, n * r.element_coordinates);
  a.reals(r.element_compliance, r.element_coordinates);
  a.reals(r.compliance, meets * meets);
  a.count(r.first_traced, kMaxRunnerTraced);
  a.count(r.traced_elements, kMaxTracedElements);
  a.structures(r.traced, r.traced_elements);
  a.reals(r.traced_row, n * r.traced_elements);
  a.count(r.first_rod, kMaxRunnerRods);
  a.count(r.rods, kMaxRodsOfRunner);
  a.reals(r.rod_row, n * r.rods);
  a.reals(r.reaction, n * constraint_count(r));
  if (!is_there(line)) return;
  RunnerFrames& f = r.frames;
  a.reals(f.centre, std::int64_t{3} * r.bodies);
  a.real(f.gravity);
  a.count(f.pairs, kMaxFramePairs);
  const std::int64_t poses = std::int64_t{kMotions} * f.pairs;
  for (std::int32_t i = 0; i < f.pairs; ++i) {
    a.count(f.pair[i].elements, kMaxFrameElements);
    for (int k = 0; k < 2; ++k) {
      a.count(f.pair[i].body[k], r.bodies);
      a.count(f.pair[i].boxes[k], 1);
    }
  }
  a.count(f.elements, kMaxFrameElements);
  a.structures(f.element, f.elements);
  a.reals(f.stiffness, 24 * poses);
  a.reals(f.preload, 2 * poses);
  std::int32_t series = f.series != nullptr ? 1 : 0;
  a.count(series, 1);
  a.reals(f.series, series * n * poses);
  a.reals(f.elements_moved, poses * r.element_coordinates);
  a.reals(f.traced_moved, poses * r.traced_elements);
  a.reals(f.rods, poses * r.rods);
  a.reals(f.rod_moved, r.rods > 0 ? n * poses : 0);
  a.reals(f.rod_reaction, r.rods > 0 ? poses * constraint_count(r) : 0);
}
}  // namespace railstep
