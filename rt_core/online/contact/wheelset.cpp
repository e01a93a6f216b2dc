#include "online/contact/wheelset.h"

#include <cmath>

#include "online/contact/couple.h"
#include "online/contact/impact.h"
#include "online/runner/body_force.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// Target of a guided coordinate at a stage's end; x counts from the start, or from the last bay
/// border.
Travelled target(const Model& model, const WheelsetModel& w, int guided, const Stage& at) noexcept {
  if (guided != 0) return {0., 0., 0.};
  return way_at(model, w.travel, at.step, at.before);
}

/// Forces other than contact and guide: weight, tables, inputs and the gyroscopic terms of an
/// axisymmetric body, at the velocities v* (roll r, spin s, yaw y; cos(roll) = 1):
///   Ix r'' = Iy s' y' - Ix y'^2 r,   Iz y'' = -Iy s' r' + 2 Ix y' r' r
void applied_force(const WheelsetModel& w, double time, const double* input, const double* p,
                   const double* v, double* force) noexcept {
  for (int k = 0; k < 6; ++k) force[k] = w.rest[k];
  add_forces(w, time, input, force);
  const double spin = travelled(w.travel, time).speed / w.radius + v[4];
  force[3] += w.mass[4] * spin * v[5] - w.mass[3] * v[5] * v[5] * p[3];
  force[5] += -w.mass[4] * spin * v[3] + 2. * w.mass[3] * v[5] * v[3] * p[3];
}

/// Displacement along a coordinate by a unit force along it, m/N or rad/(N m).
double compliance_of(const WheelsetModel& set, int k) noexcept { return set.inverse[7 * k]; }

bool is_guided(int k) noexcept { return k == kGuided[0] || k == kGuided[1]; }

bool is_guided_by_force(const WheelsetModel& set, int k) noexcept {
  return set.guide == Guide::augmented_lagrangian && is_guided(k);
}

/// The guide's multiplier of a guided coordinate. @param multiplier  [kGuideRows] of its wheelset
double multiplier_of(const double* multiplier, int k) noexcept {
  return multiplier[k == kGuided[1] ? 1 : 0];
}

/// Force of a wheelset's contacts along one of its coordinates.
double contact_force_on(const Model& model, int b, const Coupling& c, int k) noexcept {
  const WheelsetContacts own = contacts_of(model, b);
  double force = 0.;
  for (int n = 0; n < own.count; ++n)
    force += c.contact[own.at[n]].body_row[k] * c.force[own.at[n]];
  return force;
}

/// Coordinates of a wheelset under its wheel forces and multipliers.
void move_body(const Model& model, int b, const Coupling& c, const double* multiplier,
               double* p) noexcept {
  const WheelsetModel& set = model.wheelset[b];
  for (int k = 0; k < 6; ++k) {
    double force = contact_force_on(model, b, c, k);
    if (is_guided_by_force(set, k)) force -= multiplier_of(multiplier, k);
    p[k] = c.wheelset[b].free[k] + compliance_of(set, k) * force;
  }
}

/// g = x'' - 2 alpha (v - x') - beta^2 (u - x) at the step's end, with v and u as g makes them.
double baumgarte_acceleration(const WheelsetModel& set, const Scheme& c, const Travelled& goal,
                              double p, double v) noexcept {
  const double beta2 = set.beta * set.beta;
  return (goal.acceleration - 2. * set.alpha * (v - goal.speed) - beta2 * (p - goal.distance)) /
         (1. + 2. * set.alpha * c.kv / c.kg + beta2 / c.kg);
}

}  // namespace

void free_wheelsets(const Model& model, const Stage& stage, const State& s, const Workspace& w,
                    Coupling& c) noexcept {
  const double kg = model.scheme.kg;
  const double time = time_of(model.scheme, stage);
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    const double* p = w.u_star + set.first;
    const double* v = w.v_star + set.first;
    double force[6];
    applied_force(set, time, s.input, p, v, force);
    // Added to u*, so that what rests keeps its place to the last bit.
    double* const free = c.wheelset[b].free;
    for (int k = 0; k < 6; ++k) free[k] = p[k] + compliance_of(set, k) * force[k];
    for (int i = 0; i < kGuideRows; ++i) {
      const int k = kGuided[i];
      const Travelled goal = target(model, set, k, stage);
      const double inertia = kg * set.mass[k];
      c.wheelset[b].held[i] = inertia * (p[k] - goal.distance) + force[k];
      switch (set.guide) {
        case Guide::augmented_lagrangian:
          // (kg m + penalty) u = kg m u* + F - multiplier + penalty * goal
          free[k] = compliance_of(set, k) *
                    (inertia * p[k] + force[k] + kGuidePenalty * inertia * goal.distance);
          break;
        case Guide::baumgarte:
          free[k] = p[k] + baumgarte_acceleration(set, model.scheme, goal, p[k], v[k]) / kg;
          break;
        case Guide::elimination:
          free[k] = goal.distance;
          break;
      }
    }
  }
}

double wheelset_compliance(const Model& model, const Coupling& c, ContactId i,
                           ContactId j) noexcept {
  double sum = 0.;
  const std::int32_t b = wheelset_of(model, i);
  if (b != wheelset_of(model, j)) return sum;
  for (int k = 0; k < 6; ++k)
    sum +=
        c.contact[i].body_row[k] * compliance_of(model.wheelset[b], k) * c.contact[j].body_row[k];
  return sum;
}

double wheelset_offset(const Model& model, const State& s, const Workspace& w, const Coupling& c,
                       ContactId i) noexcept {
  return c.contact[i].penetration +
         (lift_by(model, c, i, w.scaled) - (1. - model.scheme.theta) * lift_by(model, c, i, s.u));
}

double free_lift(const Model& model, const State& s, const Coupling& c, ContactId i) noexcept {
  const std::int32_t b = wheelset_of(model, i);
  const FreeWheelset& own = c.wheelset[b];
  double sum = 0.;
  for (int k = 0; k < 6; ++k) {
    double p = own.free[k];
    if (is_guided_by_force(model.wheelset[b], k))
      p -= compliance_of(model.wheelset[b], k) * multiplier_of(guide_of(s, b), k);
    sum += c.contact[i].body_row[k] * p;
  }
  return sum;
}

std::int32_t guide_iterations(const Model& model) noexcept {
  std::int32_t cap = 1;
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    if (model.wheelset[b].guide == Guide::augmented_lagrangian && model.wheelset[b].cap > cap)
      cap = model.wheelset[b].cap;
  return cap;
}

bool move_wheelsets(const Model& model, const Stage& stage, State& s, Workspace& w,
                    const Coupling& c, double& violation) noexcept {
  bool settled = true;
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    double* p = w.solved + set.first;
    double* const multiplier = guide_of(s, b);
    move_body(model, b, c, multiplier, p);
    for (int i = 0; i < kGuideRows; ++i) {
      const int k = kGuided[i];
      const double miss = p[k] - target(model, set, k, stage).distance;
      if (std::fabs(miss) > violation) violation = std::fabs(miss);
      if (set.guide == Guide::elimination)
        multiplier[i] = c.wheelset[b].held[i] + contact_force_on(model, b, c, k);
      if (set.guide != Guide::augmented_lagrangian) continue;
      multiplier[i] += kGuidePenalty * model.scheme.kg * set.mass[k] * miss;
      if (!(std::fabs(miss) <= set.tolerance)) settled = false;
    }
  }
  return settled;
}

bool tread_impact_is_unresolved(const Model& model, const Coupling& c, const State& s,
                                ContactId wheel) noexcept {
  const WheelsetModel& set = model.wheelset[wheelset_of(model, wheel)];
  const double *row = c.contact[wheel].body_row, *other = c.contact[other_tread(wheel)].body_row;
  double speed = 0., alone = 0., together = 0.;
  for (int k = 0; k < 6; ++k) {
    speed -= row[k] * s.v[set.first + k];
    if (is_guided(k)) continue;
    alone += row[k] * row[k] / set.mass[k];
    together += row[k] * (row[k] + other[k]) / set.mass[k];
  }
  speed += c.contact[wheel].slope * s.v[set.first];
  const double inverse_mass = alone > together ? alone : together;
  return impact_is_unresolved(set.hertz[rail_of(model, wheel)], inverse_mass, speed,
                              model.scheme.dt);
}

void project_guides(const Model& model, const Stage& stage, State& state) noexcept {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    if (!is_projected(set.guide)) continue;
    for (const int k : kGuided) {
      const Travelled goal = target(model, set, k, stage);
      state.v[set.first + k] = goal.speed;
      state.a[set.first + k] = goal.acceleration;
      state.g[set.first + k] = goal.acceleration;
    }
  }
}

}  // namespace railstep
