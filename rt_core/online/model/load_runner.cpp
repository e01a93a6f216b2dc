#include "online/model/load_runner.h"

#include <cmath>

#include "online/math/newton.h"
#include "online/model/load_design_line.h"
#include "online/model/load_values.h"
#include "online/model/state.h"

namespace railstep {

namespace {

bool force_is_valid(const Model& m, const BodyForce& f) noexcept {
  return f.input >= 0 ? f.input < m.inputs : f.points > 0 && f.table != nullptr;
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
         pair.radius > 0. && pair.modulus > 0. && pair.patches > 0 && c.poisson > -1. &&
         c.poisson < .5;
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

}  // namespace

bool travel_is_valid(const TravelModel& t) noexcept { return t.rows == 0 || t.table != nullptr; }

bool suspended_is_valid(const Model& m, const SuspendedModel& b) noexcept {
  if (b.first < m.line_unknowns || b.first + b.size > m.unknowns || b.size < 1) return false;
  for (std::int32_t i = 0; i < b.forces; ++i)
    if (b.force[i].direction >= b.size || !force_is_valid(m, b.force[i])) return false;
  return travel_is_valid(b.travel) && b.mass && b.rest && b.damping && b.stiffness && b.inverse &&
         are_not_negative(b.mass, b.size) && diagonal_is_not_negative(b.inverse, b.size);
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

}  // namespace railstep
