#include "online/step/couple.h"

#include <cmath>

#include "online/contact/ports.h"
#include "online/model/course.h"
#include "online/step/load.h"
#include "online/step/residual.h"
#include "online/step/table.h"
#include "online/step/wheel.h"

namespace railstep {

namespace {

constexpr int kGuided[2] = {0, 5};  // x and yaw

/// The augmented Lagrangian's penalty over the coordinate's inertia term kg m: each iteration
/// leaves 1/(1 + this) of the violation.
constexpr double kPenalty = 1e3;

/// The step's coupled problem: contacts, compliance between them, and the bodies' own motion.
struct Coupling {
  int wheels;
  WheelContact contact[kMaxWheels];
  RailForce place[kMaxWheels];        // of the contacts
  double loaded[kMaxWheels];          // residual displacement there by the loads, m
  double W[kMaxWheels * kMaxWheels];  // m/N
  PortLaw law[kMaxWheels];
  double track_free[kMaxWheels];        // penetration from the track and the frozen geometry
  double compliance[kMaxWheelsets][6];  // of the coordinates, m/N or rad/(N m)
  double free[kMaxWheelsets][6];        // coordinates without wheel forces and multipliers
  double force[kMaxWheels];             // N
  double penetration[kMaxWheels];
};

/// Of a guided coordinate at a step's end; x counts from the start, or from the last bay border.
double target(const Model& model, const WheelsetModel& w, int guided, std::int64_t step) noexcept {
  if (guided != 0) return 0.;
  return model.endless.bays == 0 ? w.speed * (static_cast<double>(step) * model.scheme.dt)
                                 : within_bay(model, step);
}

/// Forces other than contact and guide: weight, tables and the gyroscopic terms of an axisymmetric
/// body, at the velocities v* (roll r, spin s, yaw y; cos(roll) = 1):
///   Ix r'' = Iy s' y' - Ix y'^2 r,   Iz y'' = -Iy s' r' + 2 Ix y' r' r
void applied_force(const WheelsetModel& w, double time, const double* p, const double* v,
                   double* force) noexcept {
  for (int k = 0; k < 6; ++k) force[k] = 0.;
  force[2] = -w.weight;
  for (std::int32_t i = 0; i < w.forces; ++i)
    force[w.force[i].direction] += table_value(w.force[i].table, w.force[i].points, time);
  const double spin = w.speed / w.radius + v[4];
  force[3] = w.mass[4] * spin * v[5] - w.mass[3] * v[5] * v[5] * p[3];
  force[5] = -w.mass[4] * spin * v[3] + 2. * w.mass[3] * v[5] * v[3] * p[3];
}

/// Where each wheelset goes without contact, and how it gives way. A coordinate on Baumgarte's
/// guide does not give way at all: g = [x'' - 2 alpha (v - x') - beta^2 (u - x)] at the step's end.
void free_bodies(const Model& model, std::int64_t step, const Workspace& w, Coupling& c) noexcept {
  const double kg = model.scheme.kg, kv = model.scheme.kv;
  const double time = static_cast<double>(step) * model.scheme.dt;
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    const double* p = w.u_star + set.first;
    const double* v = w.v_star + set.first;
    double force[6];
    applied_force(set, time, p, v, force);
    for (int k = 0; k < 6; ++k) {
      c.compliance[b][k] = 1. / (kg * set.mass[k]);
      c.free[b][k] = p[k] + c.compliance[b][k] * force[k];
    }
    for (const int k : kGuided) {
      const double goal = target(model, set, k, step), rate = k == 0 ? set.speed : 0.;
      if (set.guide == Guide::augmented_lagrangian) {
        // (kg m + penalty) u = kg m u* + F - multiplier + penalty * goal
        const double penalty = kPenalty * kg * set.mass[k];
        c.compliance[b][k] = 1. / (kg * set.mass[k] + penalty);
        c.free[b][k] = c.compliance[b][k] * (kg * set.mass[k] * p[k] + force[k] + penalty * goal);
      } else {
        const double beta2 = set.beta * set.beta;
        const double g = (-2. * set.alpha * (v[k] - rate) - beta2 * (p[k] - goal)) /
                         (1. + 2. * set.alpha * kv / kg + beta2 / kg);
        c.compliance[b][k] = 0.;
        c.free[b][k] = p[k] + g / kg;
      }
    }
  }
}

Configuration located_on(const Model& model, std::int64_t step, const State& s,
                         const Workspace& w) noexcept {
  return {w.scaled, {s.u, s.v}, passed(model, step)};
}

/// Contacts where the forces of the step act: on u + dt v of bodies and banded lines at its end; in
/// the middle of it where forces are held, with condensed lines as they stand (their fastest rates
/// are far above 1/dt).
void locate_contacts(const Model& model, std::int64_t step, const State& s, Workspace& w,
                     Coupling& c) noexcept {
  const double ahead = (model.condensed != 0 ? .5 : 1.) * model.scheme.dt;
#pragma omp simd
  for (std::int32_t i = model.condensed * model.bodies; i < model.unknowns; ++i)
    w.scaled[i] = s.u[i] + ahead * s.v[i];
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    find_contacts(model, model.wheelset[b], located_on(model, step, s, w), c.contact + 2 * b);
  for (int i = 0; i < c.wheels; ++i) {
    c.law[i] = {model.wheelset[i / 2].hertz[i % 2], 0., 0.};
    c.place[i] = {model.wheelset[i / 2].kind[i % 2], c.contact[i].row.element, c.contact[i].xi, 0.};
  }
}

/// What the loads add to the rail under each wheel through the residual flexibility.
void find_loaded(const Model& model, std::int64_t step, Coupling& c) noexcept {
  for (int i = 0; i < c.wheels; ++i) c.loaded[i] = 0.;
  for (std::int32_t l = 0; l < model.loads; ++l) {
    const PlacedLoad load = place(model, model.load[l], step);
    if (!load.on_rail) continue;
    const RailForce at{model.load[l].kind, load.row.element, load.xi, load.force};
    for (int i = 0; i < c.wheels; ++i)
      c.loaded[i] += load.force * residual_between(model, at, c.place[i]);
  }
}

/// Solves each banded line for itself and for the wheels that touch it, together where they can be.
void solve_bands(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.wheels; ++i) {
    double* rhs = w.solved + (i + 1) * stride;
    for (std::int32_t k = 0; k < model.bodies; ++k) rhs[k] = 0.;
    if (!c.contact[i].on_rail) continue;
    for (std::int32_t l = 0; l < model.lines; ++l) spread(model.line[l], c.contact[i].row, 1., rhs);
  }
  for (std::int32_t l = 0; l < model.lines; ++l) {
    double* x = w.solved + model.line[l].first;
    const bool both = model.line[l].rail_factor[0] != 0. && model.line[l].rail_factor[1] != 0.;
    if (c.wheels == 2 && both) {
      solve_band<3>(model.line[l].step, x, stride);
      continue;
    }
    solve_band<1>(model.line[l].step, x, stride);
    for (int i = 0; i < c.wheels; ++i)
      if (model.line[l].rail_factor[i % 2] != 0.)
        solve_band<1>(model.line[l].step, x + (i + 1) * stride, stride);
  }
}

Complex row_of(const Model& model, const Workspace& w, int wheel) noexcept {
  const double* re = w.row + 2 * static_cast<std::ptrdiff_t>(wheel) * model.unknowns;
  return {re, re + model.unknowns};
}

/// What a unit force under each wheel, held over the step, makes of every condensed line.
void respond_modes(const Model& model, Workspace& w, const Coupling& c) noexcept {
  const std::ptrdiff_t stride = model.unknowns;
  for (int i = 0; i < c.wheels; ++i) {
    double* re = w.row + 2 * i * stride;
    double* im = re + stride;
    for (std::int32_t k = 0; k < model.bodies; ++k) re[k] = im[k] = 0.;
    for (std::int32_t l = 0; l < model.lines && c.contact[i].on_rail; ++l)
      spread_modes(model.line[l], c.contact[i].row, 1., re, im);
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      modes_multiply(line.modal.held_force, {re + line.first, im + line.first},
                     w.solved + (i + 1) * stride + line.first,
                     w.imaginary + (i + 1) * stride + line.first, line.size);
    }
  }
}

/// Displacement under wheel `i` of the track moved by unit forces at wheel `j`, at the step's end.
double track_compliance(const Model& model, const Workspace& w, const Coupling& c, int i,
                        int j) noexcept {
  const double* unit = w.solved + static_cast<std::ptrdiff_t>(j + 1) * model.unknowns;
  const double* imaginary = w.imaginary + static_cast<std::ptrdiff_t>(j + 1) * model.unknowns;
  if (model.condensed != 0) return modes_dot(row_of(model, w, i), {unit, imaginary}, model.bodies);
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    sum += motion(model.line[l], c.contact[i].row, {unit, {}});
  return sum;
}

/// W between all wheels: through the lines, the wheelsets and the residual flexibility.
void compliance(const Model& model, const Workspace& w, Coupling& c) noexcept {
  for (int i = 0; i < c.wheels; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0.;
      if (c.contact[i].on_rail && c.contact[j].on_rail) {
        sum = track_compliance(model, w, c, i, j);
        for (int k = 0; k < 6 && i / 2 == j / 2; ++k)
          sum += c.contact[i].body_row[k] * c.compliance[i / 2][k] * c.contact[j].body_row[k];
        sum = model.scheme.theta * sum + (i == j ? residual_under(model, c.place[i])
                                                 : residual_between(model, c.place[j], c.place[i]));
      }
      c.W[i * c.wheels + j] = c.W[j * c.wheels + i] = sum;
    }
}

/// Penetration that the track alone would leave: the located one, moved from where it was located.
void track_penetration(const Model& model, const State& s, const Workspace& w,
                       Coupling& c) noexcept {
  const Configuration seen = located_on(model, s.steps + 1, s, w);
  for (int i = 0; i < c.wheels; ++i) {
    const WheelContact& at = c.contact[i];
    c.track_free[i] = -1.;  // off the rail: far away
    if (!at.on_rail) continue;
    double moved = 0.;
    if (model.condensed != 0) {
      moved = modes_dot(row_of(model, w, i), {w.solved, w.imaginary}, model.bodies) -
              modes_dot(row_of(model, w, i), seen.modes, model.bodies);
    } else {
      for (std::int32_t l = 0; l < model.lines; ++l)
        moved +=
            motion(model.line[l], at.row, {w.solved, {}}) - motion(model.line[l], at.row, seen);
    }
    double d = at.penetration + model.scheme.theta * moved + c.loaded[i];
    const std::int32_t first = model.wheelset[i / 2].first;
    for (int k = 0; k < 6; ++k)
      d += at.body_row[k] * (w.scaled[first + k] - (1. - model.scheme.theta) * s.u[first + k]);
    c.track_free[i] = d;
  }
}

/// Coordinates of a wheelset under its wheel forces and multipliers.
void move_body(const WheelsetModel& set, int b, const Coupling& c, const double* multiplier,
               double* p) noexcept {
  for (int k = 0; k < 6; ++k) {
    double force = 0.;
    for (int side = 0; side < 2; ++side)
      force += c.contact[2 * b + side].body_row[k] * c.force[2 * b + side];
    if (set.guide == Guide::augmented_lagrangian && k == kGuided[0]) force -= multiplier[0];
    if (set.guide == Guide::augmented_lagrangian && k == kGuided[1]) force -= multiplier[1];
    p[k] = c.free[b][k] + c.compliance[b][k] * force;
  }
}

/// Contacts for given multipliers.
PortResult contacts(const Model& model, const State& s, Coupling& c) noexcept {
  double d_free[kMaxWheels];
  for (int i = 0; i < c.wheels; ++i) {
    const WheelsetModel& set = model.wheelset[i / 2];
    d_free[i] = c.track_free[i];
    if (!c.contact[i].on_rail) continue;
    for (int k = 0; k < 6; ++k) {
      double p = c.free[i / 2][k];
      if (set.guide == Guide::augmented_lagrangian && (k == kGuided[0] || k == kGuided[1]))
        p -= c.compliance[i / 2][k] * s.multiplier[2 * (i / 2) + (k == kGuided[1] ? 1 : 0)];
      d_free[i] -= model.scheme.theta * c.contact[i].body_row[k] * p;
    }
  }
  return solve_ports(c.wheels, c.W, c.law, d_free, c.force, c.penetration);
}

/// The guides' augmented Lagrangian around the contacts, at most the largest cap of the wheelsets.
void solve_coupled(const Model& model, std::int64_t step, State& s, Workspace& w, Coupling& c,
                   CoupleResult& result) noexcept {
  std::int32_t cap = 1;
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    if (model.wheelset[b].guide == Guide::augmented_lagrangian && model.wheelset[b].cap > cap)
      cap = model.wheelset[b].cap;
  bool settled = false, solved = false;
  for (std::int32_t turn = 0; turn < cap && !settled; ++turn) {
    const PortResult ports = contacts(model, s, c);
    solved = ports.status == PortStatus::converged;
    if (ports.iterations > result.iterations) result.iterations = ports.iterations;
    settled = true;
    result.violation = 0.;
    for (std::int32_t b = 0; b < model.wheelsets; ++b) {
      const WheelsetModel& set = model.wheelset[b];
      double* p = w.solved + set.first;
      move_body(set, b, c, s.multiplier + 2 * b, p);
      for (int i = 0; i < 2; ++i) {
        const int k = kGuided[i];
        const double miss = p[k] - target(model, set, k, step);
        if (std::fabs(miss) > result.violation) result.violation = std::fabs(miss);
        if (set.guide != Guide::augmented_lagrangian) continue;
        s.multiplier[2 * b + i] += kPenalty * model.scheme.kg * set.mass[k] * miss;
        if (!(std::fabs(miss) <= set.tolerance)) settled = false;
      }
    }
    if (turn + 1 > result.iterations) result.iterations = turn + 1;
  }
  if (!settled || !solved) result.status = result.status | Status::cap_reached;
}

/// Displacements of the track under the wheel forces: free, and what each force adds.
void move_track(const Model& model, Workspace& w, const Coupling& c) noexcept {
  for (int i = 0; i < c.wheels; ++i) {
    const std::ptrdiff_t unit = static_cast<std::ptrdiff_t>(i + 1) * model.unknowns;
    for (std::int32_t l = 0; l < model.lines; ++l) {
      const LineModel& line = model.line[l];
      if (line.rail_factor[i % 2] == 0.) continue;
#pragma omp simd
      for (std::int32_t k = line.first; k < line.first + line.size; ++k)
        w.solved[k] -= c.force[i] * w.solved[unit + k];
      if (model.condensed == 0) continue;
#pragma omp simd
      for (std::int32_t k = line.first; k < line.first + line.size; ++k)
        w.imaginary[k] -= c.force[i] * w.imaginary[unit + k];
    }
  }
}

/// Whether a wheel that closes now on its rail will have left it within 10 steps. A mass m that
/// meets a Hertz contact C at speed v stays for T = 2.9433 (5 m / 4 C)^0.4 v^-0.2 (Goldsmith,
/// Impact, 1960), here with the rail taken as rigid (one that gives way holds the wheel for longer)
/// and the smaller of the masses that the wheel has alone and together with the set's other one.
bool strikes_too_fast(const Model& model, const Coupling& c, const State& s, int wheel) noexcept {
  const WheelsetModel& set = model.wheelset[wheel / 2];
  const double *row = c.contact[wheel].body_row, *other = c.contact[wheel ^ 1].body_row;
  double speed = 0., alone = 0., together = 0.;
  for (int k = 0; k < 6; ++k) {
    speed -= row[k] * s.v[set.first + k];
    if (k == kGuided[0] || k == kGuided[1]) continue;
    alone += row[k] * row[k] / set.mass[k];
    together += row[k] * (row[k] + other[k]) / set.mass[k];
  }
  speed += c.contact[wheel].rise * s.v[set.first];
  const double inverse_mass = alone > together ? alone : together;
  const double depth = 1.25 / (inverse_mass * set.hertz[wheel % 2]),
               steps = 10. * model.scheme.dt / 2.9433;
  return speed > 0. && depth * depth < steps * steps * steps * steps * steps * speed;
}

void publish_wheels(const Model& model, const Coupling& c, State& state,
                    CoupleResult& result) noexcept {
  for (int i = 0; i < c.wheels; ++i) {
    const WheelContact& at = c.contact[i];
    if (state.wheel_force[i] <= 0. && c.force[i] > 0. && strikes_too_fast(model, c, state, i))
      result.status = result.status | Status::contact_unresolved;
    state.wheel_force[i] = c.force[i];
    result.gap[i] = -c.penetration[i];
    result.x[i] = (at.row.element + .5 * (at.xi + 1.)) * model.element_length;
    result.on_rail[i] = at.on_rail;
    if (!at.on_rail) result.status = result.status | Status::off_rail;
    if (at.cap_reached) result.status = result.status | Status::cap_reached;
    if (c.force[i] <= 0.) result.status = result.status | Status::contact_lost;
  }
}

}  // namespace

CoupleResult couple(const Model& model, std::int64_t step, State& state, Workspace& w) noexcept {
  CoupleResult result{};
  Coupling c;
  c.wheels = 2 * model.wheelsets;
  locate_contacts(model, step, state, w, c);
  find_loaded(model, step, c);
  free_bodies(model, step, w, c);
  if (model.condensed != 0)
    respond_modes(model, w, c);
  else
    solve_bands(model, w, c);
  compliance(model, w, c);
  track_penetration(model, state, w, c);
  for (int i = 0; i < c.wheels; ++i) c.force[i] = state.wheel_force[i];
  solve_coupled(model, step, state, w, c, result);
  move_track(model, w, c);
  publish_wheels(model, c, state, result);
  return result;
}

void project_guides(const Model& model, State& state) noexcept {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& set = model.wheelset[b];
    if (set.guide != Guide::augmented_lagrangian) continue;
    for (const int k : kGuided) {
      state.v[set.first + k] = k == 0 ? set.speed : 0.;
      state.a[set.first + k] = 0.;
      state.g[set.first + k] = 0.;
    }
  }
}

}  // namespace railstep
