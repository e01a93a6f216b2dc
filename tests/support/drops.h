#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "online/step/step.h"
#include "online/track/line.h"
#include "online/track/residual.h"
#include "support/sections.h"

namespace railstep {

inline constexpr double kDropGravity = 9.81;   // on the wheels only
inline constexpr double kWheel = 600.;         // kg, on each rail
inline constexpr double kFall = .1;            // m/s, down
inline constexpr double kHertz = 9.412508e10;  // hard-cases.md: r .46 m on a crown of .3 m

/// Conditions of the wheels' fall.
struct Fall {
  double gravity = kDropGravity;  // m/s2
  double above = 0.;              // of the rails at the start, m
  double mass = kWheel;           // kg on each rail
};

/// Two wheels, one over each rail, that fall on the rails with kFall.
struct Drop {
  Track track;
  std::vector<Line> lines;
  std::unique_ptr<PackedModel> packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};
  double dissipated = 0.;  // J, by the dampers, trapezoidal in the step

  Drop(const Track& on, double x, double dt, const Fall& fall = {})
      : Drop(on, x, generalised_alpha(dt, .6), fall) {}
  Drop(const Track& on, double x, const Scheme& scheme, const Fall& fall)
      : track(on), lines(assemble(on)) {
    Wheelset w;
    w.mass = 2. * fall.mass;
    w.inertia_roll = w.inertia_yaw = 700.;
    w.inertia_spin = 100.;
    w.weight = w.mass * fall.gravity;
    w.start = x;
    const bool residual = on.bays > 1;
    packed = std::make_unique<PackedModel>(
        track, Traffic{.wheelsets = {w}},
        PackOptions{.scheme = scheme, .residual_flexibility = residual});
    memory.assign(static_cast<std::size_t>(state_doubles(model())), 0.);
    scratch.assign(static_cast<std::size_t>(workspace_doubles(model())), 0.);
    state = state_on(model(), memory.data());
    workspace = workspace_on(model(), scratch.data());
    const auto z = model().wheelset[0].first + 2;
    state.u[z] = fall.above;
    state.v[z] = -kFall;
    state.a[z] = state.g[z] = -fall.gravity;  // it falls freely at the start
  }

  const Model& model() const { return packed->model(); }
  double time() const { return static_cast<double>(state.steps) * model().scheme.dt; }
  double force() const { return outputs.contact_force[0]; }
  double wheel(const double* of) const { return of[model().wheelset[0].first + 2]; }
  /// Vertical value of the left rail's node under the wheel.
  double rail(const double* of, int node) const {
    return of[model().line[0].first + model().line[0].unknown_of[0][table_place(node, 2)]];
  }

  void step() {
    REQUIRE(state.steps < 100000);  // a contact that never ends
    const double before = damping_power();
    scratch.assign(scratch.size(), std::numeric_limits<double>::quiet_NaN());
    const Status met = advance_frame(model(), state, workspace, outputs);
    CHECK_FALSE(has(met, Status::cap_reached));
    CHECK_FALSE(has(met, Status::off_rail));
    dissipated += .5 * model().scheme.dt * (before + damping_power());
  }

  double damping_power() const {
    double sum = 0.;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const Eigen::Map<const Eigen::VectorXd> v(state.v + model().line[l].first,
                                                lines[l].unknowns());
      sum += v.dot(lines[l].damping * v);
    }
    return sum;
  }

  /// Energy of the track, the wheels, the contacts and their residual flexibility, J.
  double energy() const {
    const WheelsetModel& w = model().wheelset[0];
    double sum = .5 * w.mass[2] * wheel(state.v) * wheel(state.v) - w.rest[2] * wheel(state.u);
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const auto n = lines[l].unknowns();
      const Eigen::Map<const Eigen::VectorXd> u(state.u + model().line[l].first, n);
      const Eigen::Map<const Eigen::VectorXd> v(state.v + model().line[l].first, n);
      sum += .5 * (u.dot(lines[l].stiffness * u) + v.dot(lines[l].mass * v));
    }
    for (int i = 0; i < 2; ++i) {
      const double d = std::max(0., -outputs.contact_gap[i]), f = outputs.contact_force[i];
      sum += .4 * model().contact[0].law.hertz * d * d * std::sqrt(d);
      sum +=
          .5 * f * f *
          residual_under(model(), rail_force(model(), model().contact[i].load_point, w.start, f));
    }
    return sum;
  }
};

/// Two rails that move as one mass each: one element on a seat at each end, hit in the middle. With
/// A = 1e6 m2 and Iy = 1e6 m4 its middle yields by L/(4 k G A) + L^3/(48 E Iy) = 2e-18 m/N more
/// than its ends. The stiffest contact yields by 7e-10 m/N: the part is 3e-9, below all printed
/// digits. The density makes it 150 kg. Unknowns are vertical, so there is no roll and no squeeze.
inline Track one_mass(double stiffness, double damping, double mass = 150.) {
  Track t;
  t.section = {.area = 1e6, .inertia_y = 1e6, .inertia_z = 1e6, .torsion = 1e6};
  t.unknowns = Unknowns::vertical;
  t.elements_per_bay = 1;
  t.material.density = mass / (t.section.area * t.bay_length);
  t.support.stiffness = {0., 0., stiffness / 2.};
  t.support.damping = {0., 0., damping / 2.};
  return t;
}

inline constexpr double kMiddle = .3;  // m, middle of the one mass

struct Impact {
  double peak = 0., peak_time = 0.;    // N, s; of the steps
  double leaves = 0., wheel = 0.;      // s, and speed of the wheel then, m/s, up
  double most_energy = 0., last = 0.;  // J, with what the dampers took; at a step's end
};

/// Steps until the wheel is free again, then `more` steps.
inline Impact impact(Drop& drop, int more = 0) {
  Impact found;
  bool met = false;
  while (!met || drop.force() > 0. || more-- > 0) {
    drop.step();
    met = met || drop.force() > 0.;
    found.last = drop.energy() + drop.dissipated;
    found.most_energy = std::max(found.most_energy, found.last);
    if (drop.force() > found.peak) {
      found.peak = drop.force();
      found.peak_time = drop.time();
    }
    if (met && drop.force() <= 0. && found.leaves == 0.) {
      found.leaves = drop.time();
      found.wheel = drop.wheel(drop.state.v);
    }
  }
  return found;
}

/// R3: 24 bays on springs, without the rail's weight.
inline Track sprung_track(double damping) {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::vertical;
  t.bays = 24;
  t.elements_per_bay = 4;
  t.support.stiffness = {0., 0., 3e7};
  t.support.damping = {0., 0., damping};
  return t;
}

inline constexpr double kSeat = 7.2;  // m, the middle one of R3

}  // namespace railstep
