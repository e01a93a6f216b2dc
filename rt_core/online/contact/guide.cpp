#include "online/contact/guide.h"

#include <cmath>

#include "online/contact/couple.h"
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
  for (int k = 0; k < kMotions; ++k) force[k] = w.rest[k];
  add_forces(w, time, input, force);
  const double spin = travelled(w.travel, time).speed / w.radius + v[4];
  force[3] += w.mass[4] * spin * v[5] - w.mass[3] * v[5] * v[5] * p[3];
  force[5] += -w.mass[4] * spin * v[3] + 2. * w.mass[3] * v[5] * v[3] * p[3];
}

/// g = x'' - 2 alpha (v - x') - beta^2 (u - x) at the step's end, with v and u as g makes them.
double baumgarte_acceleration(const WheelsetModel& set, const Scheme& c, const Travelled& goal,
                              double p, double v) noexcept {
  const double beta2 = set.beta * set.beta;
  return (goal.acceleration - 2. * set.alpha * (v - goal.speed) - beta2 * (p - goal.distance)) /
         (1. + 2. * set.alpha * c.kv / c.kg + beta2 / c.kg);
}

/// Force of a wheelset's contacts along one of its coordinates.
double contact_force_on(const Model& model, std::int32_t b, const Coupling& c, int k) noexcept {
  const WheelsetContacts own = contacts_of(model, b);
  double sum = 0.;
  for (int n = 0; n < own.count; ++n) sum += c.contact[own.at[n]].body_row[k] * c.force[own.at[n]];
  return sum;
}

}  // namespace

void free_wheelsets(const Model& model, const Stage& stage, double time, const State& s,
                    const Workspace& w, Coupling& c) noexcept {
  const double kg = model.scheme.kg;
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    const double* p = w.u_star + set.first;
    const double* v = w.v_star + set.first;
    double force[kMotions];
    applied_force(set, time, s.input, p, v, force);
    // Added to u*, so that what rests keeps its place to the last bit.
    double* const free = c.wheelset[b].free;
    for (int k = 0; k < kMotions; ++k) free[k] = p[k] + compliance_of(set, k) * force[k];
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

std::int32_t guide_iterations(const Model& model) noexcept {
  std::int32_t cap = 1;
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    if (model.wheelset[b].guide == Guide::augmented_lagrangian && model.wheelset[b].cap > cap)
      cap = model.wheelset[b].cap;
  return cap;
}

void take_multipliers(const Model& model, const State& s, const Coupling& c,
                      Workspace& w) noexcept {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    double* const p = w.solved + set.first;
    for (int k = 0; k < kMotions; ++k) p[k] = c.wheelset[b].free[k];
    for (int i = 0; i < kGuideRows && set.guide == Guide::augmented_lagrangian; ++i)
      p[kGuided[i]] -= compliance_of(set, kGuided[i]) * guide_of(s, b)[i];
  }
}

bool correct_multipliers(const Model& model, const Stage& stage, State& s, const Workspace& w,
                         const Coupling& c, double& violation) noexcept {
  bool settled = true;
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    double* const multiplier = guide_of(s, b);
    for (int i = 0; i < kGuideRows; ++i) {
      const int k = kGuided[i];
      const double pressed = contact_force_on(model, b, c, k);
      const double miss = (w.solved[set.first + k] + compliance_of(set, k) * pressed) -
                          target(model, set, k, stage).distance;
      if (std::fabs(miss) > violation) violation = std::fabs(miss);
      if (set.guide == Guide::elimination) multiplier[i] = c.wheelset[b].held[i] + pressed;
      if (set.guide != Guide::augmented_lagrangian) continue;
      multiplier[i] += kGuidePenalty * model.scheme.kg * set.mass[k] * miss;
      if (!(std::fabs(miss) <= set.tolerance)) settled = false;
    }
  }
  return settled;
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
