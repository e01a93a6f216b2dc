#include "offline/pack/start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "offline/pack/start_flange.h"
#include "offline/pack/start_vehicle.h"
#include "offline/pack/static_lines.h"
#include "offline/track/statics.h"
#include "online/model/course.h"
#include "online/step/closing.h"
#include "online/step/input.h"
#include "online/step/load.h"
#include "online/step/residual.h"
#include "online/step/step.h"
#include "online/step/travel.h"
#include "online/step/wheel.h"

namespace railstep {

namespace {

/// Displacements of the model's lines, of six coordinates of each wheelset, and of the vehicles.
struct Pose {
  std::vector<Eigen::VectorXd> lines;
  std::vector<std::array<double, 6>> wheelsets;
  SettledVehicles vehicles;
  std::vector<double> wheel_force;  // [contacts] of wheelsets, N
};

/// Puts static displacements and velocities of a line into a state.
void put(const PackedLine& own, const LineModel& line, const Eigen::VectorXd& u,
         const Eigen::VectorXd& v, State& state) {
  if (line.modal.count == 0) {
    std::copy(u.begin(), u.end(), state.u + line.first);
    std::copy(v.begin(), v.end(), state.v + line.first);
    return;
  }
  const Eigen::VectorXcd z = own.modes.from(own.basis.omega.cwiseAbs2().cwiseProduct(u), v);
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    state.u[line.first + k] = z[k].real();
    state.v[line.first + k] = z[k].imag();
  }
}

/// Residual displacement of each contact's rail; a flange knows none.
std::array<double, 3> missed_under(const Model& model, const Leaning& leaning, Acting acting) {
  const std::size_t loads = acting.ports.size();
  for (const std::size_t i : {0u, 1u}) {
    const WheelContact& c = leaning.contact[i];
    acting.ports.push_back(rail_force(model, model.wheelset[0].kind[i], c.x,
                                      -leaning.force[static_cast<int>(i)] * c.normal[2]));
  }
  const auto under = [&](std::size_t port) {
    return residual_displacement(model, acting.ports.data(), static_cast<int>(acting.ports.size()),
                                 static_cast<int>(port));
  };
  return {under(loads), under(loads + 1), 0.};
}

/// Equilibrium of a wheelset that leans on its flange, alone under loads: turn by turn the forces
/// that balance it where it is, the rails under these, and its way to the depths they want. The
/// forces hang on the rails by their small turns alone, so each turn leaves 1e-3 of the last or
/// less.
Pose leaning_equilibrium(const Statics& statics, const PackedModel& packed, double gravity,
                         double time, const Acting& loads) {
  const Model& model = packed.model();
  const FlangeModel& flange = model.flange[0];
  std::vector<double> memory = start_released(packed);
  State state = state_on(model, memory.data());
  const Configuration at{state.u, {state.u, state.v}, passed(model, 0)};
  double* const p = state.u + model.wheelset[0].first;
  const int side = side_force(model.wheelset[0]) > 0. ? 0 : 1;
  const std::int32_t contact = wheel_count(model) + side;
  p[0] = travelled(model.wheelset[0].travel, 0.).speed * time;
  p[1] = model.rail_y[side] + flange.gauge[side][0] - flange.point[side][0];
  Pose pose;
  constexpr int kMostTurns = 30;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    Acting acting = loads;
    for (const PointForce& f : forces_on_rails(lean(model, at))) acting.forces.push_back(f);
    pose.lines = static_lines(packed, statics, acting.forces, gravity);
    for (std::size_t l = 0; l < pose.lines.size(); ++l)
      put(packed.lines()[l], model.line[l], pose.lines[l],
          Eigen::VectorXd::Zero(pose.lines[l].size()), state);
    const Leaning now = lean(model, at);
    const Eigen::Vector3d way = way_to_depths(model, now, missed_under(model, now, loads));
    for (int k = 0; k < 3; ++k) p[1 + k] += way[k];
    pose.wheel_force.assign(static_cast<std::size_t>(contact_count(model)), 0.);
    for (const int i : {0, 1}) pose.wheel_force[static_cast<std::size_t>(i)] = now.force[i];
    pose.wheel_force[static_cast<std::size_t>(contact)] = now.force[2];
    if (!(way.cwiseAbs().maxCoeff() < 1e-15)) continue;
    pose.wheelsets = {{0., p[1], p[2], p[3], 0., 0.}};
    return pose;
  }
  throw std::invalid_argument("no equilibrium was found of a wheelset that leans on its flange");
}

/// Equilibrium with everything that moves shifted by `time`.
Pose equilibrium(const Statics& statics, const PackedModel& packed, double gravity, double time) {
  const Model& model = packed.model();
  Acting acting;
  std::vector<PointForce>& forces = acting.forces;
  std::vector<RailForce>& ports = acting.ports;
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const LoadModel& load = model.load[i];
    const PlacedLoad at = place(model, load, 0);
    const double x = at.place + travelled(load.travel, 0.).speed * time;
    if (!at.on_rail || x < 0. || x > statics.track().length()) continue;
    forces.push_back({point_of(packed, load.kind, x), at.force});
    ports.push_back(rail_force(model, load.kind, x, at.force));
  }
  if (model.wheelsets == 1 && side_force(model.wheelset[0]) != 0.)
    return leaning_equilibrium(statics, packed, gravity, time, acting);
  const std::size_t loads = forces.size();
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    for (const int rail : {0, 1}) {
      const WheelsetModel& w = model.wheelset[b];
      const double x = w.start + travelled(w.travel, 0.).speed * time;
      forces.push_back({point_of(packed, w.kind[rail], x), -wheel_load(w)});
      ports.push_back(rail_force(model, w.kind[rail], x, -wheel_load(w)));
    }
  SettledVehicles vehicles;
  if (model.vehicles > 0) vehicles = settle_on_track(statics, packed, gravity, time, acting);
  Pose pose{static_lines(packed, statics, forces, gravity), {}, std::move(vehicles), {}};
  pose.wheel_force.assign(static_cast<std::size_t>(contact_count(model)), 0.);
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    const double up[3] = {0., 0., 1.}, rolled = travelled(w.travel, 0.).speed * time;
    const double x = w.start + rolled;
    std::array<double, 2> height;
    for (const std::size_t rail : {0u, 1u}) {
      const std::size_t port = loads + 2 * static_cast<std::size_t>(b) + rail;
      height[rail] = height_of(statics.track(), packed, pose.lines, forces[port].at) +
                     residual_displacement(model, ports.data(), static_cast<int>(ports.size()),
                                           static_cast<int>(port)) +
                     irregularity(model, w.tread[rail], static_cast<int>(rail), up,
                                  x + passed(model, 0), rolled)
                         .depth;
    }
    pose.wheelsets.push_back(standing_wheelset(model, w, height));
    for (const std::int32_t i : {2 * b, 2 * b + 1})
      pose.wheel_force[static_cast<std::size_t>(i)] = wheel_load(w);
  }
  return pose;
}

/// Forces of the fixed ports where the lines stand and move.
void put_port_forces(const Model& model, State& state) {
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    const double depth = closing(model, j, state.u, state.v) - model.fixed.gap[j];
    const double force =
        model.fixed.stiffness[j] * depth + model.fixed.damping[j] * closing_speed(model, j, state);
    state.port_force[j] = depth > 0. ? std::max(force, 0.) : 0.;
  }
}

/// Times around 0, s, between which the static shape's velocity is taken: at an end of the rail
/// only on the side where all that stands on it still does.
struct Window {
  double from, to;
};
Window window(const Model& model, double length) {
  constexpr double dt = 1e-6;  // s; the shape's change over it is far above rounding, and linear
  Window w{-dt, dt};
  const auto narrow = [&](double x, double speed) {
    const auto is_on = [&](double t) { return x + speed * t >= 0. && x + speed * t <= length; };
    if (is_on(0.) && !is_on(w.from)) w.from = 0.;
    if (is_on(0.) && !is_on(w.to)) w.to = 0.;
  };
  for (std::int32_t i = 0; i < model.loads; ++i)
    narrow(place(model, model.load[i], 0).place, travelled(model.load[i].travel, 0.).speed);
  for (std::int32_t i = 0; i < model.vehicle_wheels; ++i) {
    const VehicleModel& own = model.vehicle[model.vehicle_wheel[i].vehicle];
    narrow(own.start + model.vehicle_wheel[i].place, travelled(own.travel, 0.).speed);
  }
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    narrow(model.wheelset[b].start, travelled(model.wheelset[b].travel, 0.).speed);
  return w;
}

}  // namespace

double wheel_load(const WheelsetModel& w) {
  double vertical = w.weight;
  for (std::int32_t i = 0; i < w.forces; ++i) {
    const double force = force_at(w.force[i], 0., nullptr);
    if (w.force[i].direction == 2) vertical -= force;
  }
  if (!(vertical > 0.))
    throw std::invalid_argument("no equilibrium in contact: nothing presses a wheelset down");
  return vertical / 2.;
}

namespace {

/// Where a level wheel meets a rail at rest, beside the track's middle, m.
double contact_y(const Model& model, int rail) {
  const Cant& cant = model.cant[rail];
  const CrownTop top = crown_top(cant, model.head_z[rail], model.crown_radius[rail]);
  return model.rail_y[rail] + (cant.cosine * top.y - cant.sine * top.z);
}

}  // namespace

std::array<double, 6> standing_wheelset(const Model& model, const WheelsetModel& w,
                                        const std::array<double, 2>& height) {
  const double into[2] = {std::pow(wheel_load(w) / w.hertz[0], 2. / 3.),
                          std::pow(wheel_load(w) / w.hertz[1], 2. / 3.)};
  const double roll =
      ((height[0] - height[1]) - (into[0] - into[1])) / (contact_y(model, 0) - contact_y(model, 1));
  // An axle that rolls stands (r + crown) / cos(roll) over the crowns' centres.
  const double crown = .5 * (model.crown_radius[0] + model.crown_radius[1]);
  const double lifted = .5 * roll * roll * (w.radius + crown);
  const double z = .5 * (height[0] + height[1]) - .5 * (into[0] + into[1]) + lifted;
  return {0., 0., z, roll, 0., 0.};
}

std::vector<double> start_released(const PackedModel& packed) {
  const Model& model = packed.model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)), 0.);
  State state = state_on(model, memory.data());
  for (std::int32_t b = 0; b < model.wheelsets; ++b)
    state.v[model.wheelset[b].first] = travelled(model.wheelset[b].travel, 0.).speed;
  if (model.condensed != 0) forces(model, 0, state.a, state.g);
  return memory;
}

void put_falling(const Model& model, const std::vector<RunningVehicle>& vehicles,
                 std::vector<double>& memory) {
  State state = state_on(model, memory.data());
  for (std::size_t b = 0; b < vehicles.size(); ++b) {
    if (!vehicles[b].falling) continue;
    const VehicleModel& own = model.vehicle[b];
    const std::vector<int> first = first_coordinates(vehicles[b].vehicle);
    for (std::size_t body = 0; body + 1 < first.size(); ++body) {
      const std::int32_t z = own.first + first[body];
      state.u[z] = vehicles[b].falling->height;
      state.v[z] = -vehicles[b].falling->speed;
      state.a[z] = state.g[z] = -vehicles[b].gravity;
    }
  }
}

std::vector<double> start_in_equilibrium(const Track& track, const PackedModel& packed,
                                         double gravity) {
  const Model& model = packed.model();
  check_sides(model);
  std::vector<double> memory = start_released(packed);
  State state = state_on(model, memory.data());
  const Statics statics(track);
  const Pose at = equilibrium(statics, packed, gravity, 0.);
  const Window w = window(model, track.length());
  const Pose later = equilibrium(statics, packed, gravity, w.to);
  const Pose before = equilibrium(statics, packed, gravity, w.from);
  const double span = w.to > w.from ? w.to - w.from : 1.;  // s; without one there is no difference
  for (std::size_t l = 0; l < packed.lines().size(); ++l) {
    put(packed.lines()[l], model.line[l], at.lines[l], (later.lines[l] - before.lines[l]) / span,
        state);
  }
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const std::size_t set = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < 6; ++k) {
      state.u[model.wheelset[b].first + static_cast<int>(k)] = at.wheelsets[set][k];
      state.v[model.wheelset[b].first + static_cast<int>(k)] +=
          (later.wheelsets[set][k] - before.wheelsets[set][k]) / span;
    }
  }
  std::copy(at.wheel_force.begin(), at.wheel_force.end(), state.wheel_force);
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const std::size_t own = static_cast<std::size_t>(b);
    const Eigen::VectorXd& u = at.vehicles.displacement[own];
    const Eigen::VectorXd v =
        (later.vehicles.displacement[own] - before.vehicles.displacement[own]) / span;
    std::copy(u.begin(), u.end(), state.u + model.vehicle[b].first);
    std::copy(v.begin(), v.end(), state.v + model.vehicle[b].first);
  }
  for (std::int32_t i = 0; i < model.vehicle_wheels; ++i)
    state.wheel_force[2 * model.wheelsets + i] = at.vehicles.force[i];
  put_port_forces(model, state);
  return memory;
}

}  // namespace railstep
