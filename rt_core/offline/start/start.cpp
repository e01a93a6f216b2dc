#include "offline/start/start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/contact/hertz.h"
#include "offline/math/refuse.h"
#include "offline/start/start_runner.h"
#include "offline/start/start_vehicle.h"
#include "offline/start/start_wheelset.h"
#include "offline/start/static_lines.h"
#include "online/contact/wheel.h"
#include "online/model/progress.h"
#include "online/runner/body_force.h"
#include "online/runner/runner_contact.h"
#include "online/step/step.h"
#include "online/track/closing.h"
#include "online/track/moving_load.h"
#include "online/track/residual.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

/// Displacements of the model's lines, of six coordinates of each wheelset, and of the vehicles.
struct Pose {
  std::vector<Eigen::VectorXd> lines;
  std::vector<std::array<double, 6>> wheelsets;
  SettledVehicles vehicles;
  SettledRunners runners;
  std::vector<double> contact_force;  // [contacts] of wheelsets, N
  Acting acting;                      // on the lines
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

/// The forces of the loads, with everything that moves shifted by `time`, and those beside them.
Acting loads_at(const Statics& statics, const PackedModel& packed, double time,
                const Acting& beside) {
  const Model& model = packed.model();
  Acting acting = beside;
  for (std::int32_t i = 0; i < model.loads; ++i) {
    const LoadModel& load = model.load[i];
    const PlacedLoad at = place(model, load, 0);
    const double x = at.place + travelled(load.travel, 0.).speed * time;
    if (!at.on_rail || x < 0. || x > statics.track().length()) continue;
    acting.forces.push_back({point_of(packed, load.load_point, x), at.force});
    acting.ports.push_back(rail_force(model, load.load_point, x, at.force));
  }
  return acting;
}

/// Puts wheelsets where they touch rails at rest; a lateral force makes the flange touch.
void put_wheelsets(const Model& model, double time, State& state) {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    double* const p = state.u + w.first;
    p[0] = travelled(w.travel, 0.).speed * time;
    const double aside = side_force(w);
    if (aside == 0.) continue;
    const FlangeModel& flange = model.flange[contacts_of(model, b).pair];
    const int side = aside > 0. ? 0 : 1;
    p[1] = model.rail_y[side] + flange.gauge[side][0] - flange.point[side][0];
  }
}

/// Whether a lateral force presses a wheelset on a flange at t = 0.
bool leans(const Model& model) {
  return std::any_of(model.wheelset, model.wheelset + model.wheelsets,
                     [](const WheelsetModel& w) { return side_force(w) != 0.; });
}

/// Puts displacements of lines alone into a state.
void put_lines(const PackedModel& packed, const std::vector<Eigen::VectorXd>& lines, State& state) {
  for (std::size_t l = 0; l < lines.size(); ++l)
    put(packed.lines()[l], packed.model().line[l], lines[l], Eigen::VectorXd::Zero(lines[l].size()),
        state);
}

/// The largest change of a coordinate of rail vehicles, m and rad.
double change_of(const SettledRunners& before, const SettledRunners& now) {
  double most = 0.;
  for (std::size_t r = 0; r < now.steady.size(); ++r)
    most = std::max(
        most, (now.steady[r].displacement - before.steady[r].displacement).cwiseAbs().maxCoeff());
  return most;
}

/// Static equilibrium, by iteration: the forces that balance the wheelsets where they are, the
/// rails and vehicles under these forces, and the shift of each wheelset to the depths that belong
/// to its forces. Contacts are those that the step finds, so that it keeps the start. The forces
/// depend on the rails only by their small rolls, so that each iteration leaves at most 1e-3 of the
/// last error, down to rounding. Everything that moves is shifted by `time`.
Pose equilibrium(const Statics& statics, const PackedModel& packed, double gravity, double time,
                 const Acting& beside) {
  constexpr int kMostIterations = 30;
  constexpr double kNothing = 1e-15, kRounding = 1e-12;  // m, rad
  const Model& model = packed.model();
  const Acting loads = loads_at(statics, packed, time, beside);
  std::vector<double> memory = start_released(packed);
  State state = state_on(model, memory.data());
  const Configuration at{state.u, {state.u, state.v}, track_offset(model, 0)};
  put_wheelsets(model, time, state);
  for (std::int32_t b = 0; b < model.wheelsets; ++b) (void)wheel_load(model.wheelset[b]);
  Pose pose;
  pose.runners = runners_on_even_rails(packed);
  double before = HUGE_VAL;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    Acting acting = loads;
    std::vector<std::size_t> port;
    for (std::int32_t b = 0; b < model.wheelsets; ++b) {
      port.push_back(acting.ports.size());
      add_forces(model, stance_of(model, b, at), acting);
    }
    const std::size_t first_of_runners = acting.ports.size();
    add_forces(packed, pose.runners, at, time, acting);
    if (model.vehicles > 0) pose.vehicles = settle_on_track(statics, packed, gravity, time, acting);
    pose.acting = acting;
    pose.lines = static_lines(packed, statics, acting, gravity);
    put_lines(packed, pose.lines, state);
    pose.wheelsets.clear();
    pose.contact_force.assign(static_cast<std::size_t>(contact_count(model)), 0.);
    SettledRunners settled =
        settle_runners(packed, pose.runners, at, time, acting, first_of_runners);
    double most = change_of(pose.runners, settled);
    pose.runners = std::move(settled);
    for (std::int32_t b = 0; b < model.wheelsets; ++b) {
      const Stance now = stance_of(model, b, at);
      const Eigen::VectorXd way = way_to_depths(
          model, now, missed_under(model, now, acting, port[static_cast<std::size_t>(b)]));
      double* const p = state.u + model.wheelset[b].first;
      for (int i = 0; i < now.count; ++i) {
        p[now.first_coordinate() + i] += way[i];
        pose.contact_force[static_cast<std::size_t>(now.number[static_cast<std::size_t>(i)])] =
            now.force[i];
      }
      const double aside = way_off_flanges(model, b, at);
      p[1] += aside;
      most = std::max({most, way.cwiseAbs().maxCoeff(), std::abs(aside)});
      pose.wheelsets.push_back({0., p[1], p[2], p[3], 0., 0.});
    }
    if (most <= kNothing || (most < kRounding && !(most < before))) return pose;
    before = most;
  }
  refuse("E-START-01",
         "no equilibrium of a wheelset on its rails was found; expected a place where both wheels "
         "stand on the rails, or step.start = \"released\"");
}

/// The equilibrium `time` later, for rates only: each wheel presses right over its place with its
/// static force. Under a force a mesh has a kink at the border of two elements, and a contact's own
/// place passes it only after the wheel.
/// @param now  the equilibrium at present
Pose passing(const Statics& statics, const PackedModel& packed, double gravity, double time,
             const Pose& now, const Acting& beside) {
  const Model& model = packed.model();
  if (leans(model)) return equilibrium(statics, packed, gravity, time, beside);
  Acting acting = loads_at(statics, packed, time, beside);
  const std::size_t loads = acting.forces.size();
  for (const ContactId i : treads(model)) {
    const WheelsetModel& w = model.wheelset[model.contact[i].bodies];
    const std::int32_t load_point = model.contact[i].load_point;
    const double x = w.start + travelled(w.travel, 0.).speed * time;
    acting.forces.push_back({point_of(packed, load_point, x), -wheel_load(w)});
    acting.ports.push_back(rail_force(model, load_point, x, -wheel_load(w)));
  }
  std::vector<double> memory = start_released(packed);
  State state = state_on(model, memory.data());
  const Configuration at{state.u, {state.u, state.v}, track_offset(model, 0)};
  put_lines(packed, now.lines, state);
  const std::size_t first_of_runners = acting.ports.size();
  add_forces(packed, now.runners, at, time, acting);
  Pose pose;
  if (model.vehicles > 0) pose.vehicles = settle_on_track(statics, packed, gravity, time, acting);
  pose.acting = acting;
  pose.lines = static_lines(packed, statics, acting, gravity);
  put_lines(packed, pose.lines, state);
  pose.runners = settle_runners(packed, now.runners, at, time, acting, first_of_runners);
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    const WheelsetModel& w = model.wheelset[b];
    const double up[3] = {0., 0., 1.}, rolled = travelled(w.travel, 0.).speed * time;
    std::array<double, 2> height;
    for (const int rail : {0, 1}) {
      const std::size_t port = loads + static_cast<std::size_t>(tread_of(b, rail));
      height[static_cast<std::size_t>(rail)] =
          height_of(statics.track(), packed, pose.lines, acting.forces[port].at) +
          residual_displacement(model, acting.ports.data(), static_cast<int>(acting.ports.size()),
                                static_cast<int>(port)) +
          irregularity(model, model.contact[tread_of(b, rail)].tread, rail, up,
                       w.start + rolled + track_offset(model, 0), rolled)
              .depth;
    }
    pose.wheelsets.push_back(standing_wheelset(model, b, height));
  }
  return pose;
}

/// Forces of the fixed ports from positions and velocities of the lines.
void put_port_forces(const Model& model, State& state) {
  for (std::int32_t j = 0; j < model.fixed.count; ++j) {
    const double depth = closing(model, j, state.u, state.v) - model.fixed.gap[j];
    const double force =
        model.fixed.stiffness[j] * depth + model.fixed.damping[j] * closing_speed(model, j, state);
    state.port_force[j] = depth > 0. ? std::max(force, 0.) : 0.;
  }
}

/// Times around 0 between which the velocity of the static shape is taken, s. At an end of the rail
/// only the side is used on which all traffic is on the rail.
struct Window {
  double from, to;
};
Window window(const Model& model, double length) {
  constexpr double dt = 1e-6;  // s; in it the shape changes linearly and far above rounding
  Window w{-dt, dt};
  const auto narrow = [&](double x, double speed) {
    const auto is_on = [&](double t) { return x + speed * t >= 0. && x + speed * t <= length; };
    if (is_on(0.) && !is_on(w.from)) w.from = 0.;
    if (is_on(0.) && !is_on(w.to)) w.to = 0.;
  };
  for (const StartingPlace& at : starting_places(model)) narrow(at.place, at.speed);
  return w;
}

}  // namespace

std::vector<StartingPlace> starting_places(const Model& model) {
  std::vector<StartingPlace> all;
  const auto add = [&all](double at, const auto& travel) {
    all.push_back({at, travelled(travel, 0.).speed});
  };
  for (std::int32_t i = 0; i < model.loads; ++i)
    add(place(model, model.load[i], 0).place, model.load[i].travel);
  for (const ContactId i : wheels(model)) add(place_of(model, i), bodies_of(model, i).travel);
  for (std::int32_t r = 0; r < model.runners; ++r)
    for (std::int32_t i = 0; i < model.runner[r].wheelsets; ++i)
      all.push_back({model.runner[r].start + model.runner[r].wheelset[i].place,
                     travelled(model.runner[r].travel, 0.).speed + model.runner[r].start_speed});
  return all;
}

std::vector<Eigen::VectorXd> standing_line_forces(const Track& track, const PackedModel& packed,
                                                  double gravity, const Acting& beside,
                                                  double time) {
  const Statics statics(track);
  Pose at = equilibrium(statics, packed, gravity, 0., beside);
  if (time != 0.) at = passing(statics, packed, gravity, time, at, beside);
  if (packed.model().form == Form::banded) {
    std::vector<Eigen::VectorXd> forces = line_forces(packed, track, at.acting);
    const std::vector<Eigen::VectorXd> others =
        line_forces(packed, track, loads_at(statics, packed, time, beside));
    for (std::size_t l = 0; l < forces.size(); ++l) forces[l] -= others[l];
    return forces;
  }
  auto& contacts = at.acting.contacts;  // those beside are the first
  contacts.erase(contacts.begin(),
                 contacts.begin() + static_cast<std::ptrdiff_t>(beside.contacts.size()));
  std::vector<Eigen::VectorXd> forces = open_lines(packed, track, at.acting, gravity);
  for (std::size_t l = 0; l < forces.size(); ++l) {
    const PackedLine& own = packed.lines()[l];
    forces[l] = own.line.stiffness * own.basis.shapes.displacement(forces[l]);
    forces[l] -= preload(track, own.line);  // the model that takes them has its own
  }
  return forces;
}

namespace {

/// Lets a vehicle go that a drive has held at its speed: it rolls, and what held it speeds it up or
/// slows it down as one body on wheels.
/// @param held  force of the drive, N
void release(const RunnerModel& runner, double held, State& state) {
  constexpr auto x = index_of(BodyMotion::x), spin = index_of(BodyMotion::pitch);
  double mass = 0.;
  for (std::int32_t b = 0; b < runner.bodies; ++b) mass += runner.mass[kMotions * b + x];
  for (std::int32_t i = 0; i < runner.wheelsets; ++i) {
    const RunnerWheelset& set = runner.wheelset[i];
    mass += set.spin_inertia / (set.radius * set.radius);
  }
  const auto set_acceleration = [&](std::int32_t k, double per_speed) {
    state.a[runner.first + k] = state.g[runner.first + k] = -per_speed * held / mass;
  };
  for (std::int32_t b = 0; b < runner.bodies; ++b) set_acceleration(kMotions * b + x, 1.);
  for (std::int32_t i = 0; i < runner.wheelsets; ++i)
    set_acceleration(runner.wheelset[i].first + spin, 1. / runner.wheelset[i].radius);
}

/// Puts rail vehicles into a state. The rates are those of steady running, and those by which rails
/// lead them on.
void put_runners(const PackedModel& packed, const SettledRunners& now, const SettledRunners& before,
                 const SettledRunners& later, double span, State& state) {
  const Model& model = packed.model();
  for (std::size_t r = 0; r < now.steady.size(); ++r) {
    const std::int32_t first = model.runner[r].first;
    const Eigen::VectorXd& u = now.steady[r].displacement;
    const Eigen::VectorXd v =
        now.steady[r].rate + (later.steady[r].displacement - before.steady[r].displacement) / span;
    std::copy(u.begin(), u.end(), state.u + first);
    std::copy(v.begin(), v.end(), state.v + first);
    double* const reaction = reactions_of(model, state, model.runner[r]);
    const Eigen::VectorXd accelerated =
        constraint_forces_of_acceleration(model.runner[r], .5 * model.scheme.dt);
    reaction[0] = now.steady[r].resistance + accelerated[0];
    start_elements(model, model.runner[r], state);
    if (model.runner[r].rolls_freely != 0) {
      start_rolling(model.runner[r], state);
      release(model.runner[r], now.steady[r].resistance, state);
      reaction[0] = 0.;
    }
    for (Eigen::Index i = 1; i < accelerated.size(); ++i)
      reaction[i] = now.steady[r].tension[i - 1] + accelerated[i];
    // A damper in series with a spring has no force.
    for (std::size_t i = 0; i < now.series[r].size(); ++i) {
      const std::int32_t own = first + static_cast<std::int32_t>(u.size() + static_cast<int>(i));
      state.u[own] = now.series[r][i];
      state.v[own] = (later.series[r][i] - before.series[r][i]) / span;
    }
  }
  for (std::size_t set = 0; set < now.wheels.size(); ++set)
    for (const std::size_t side : {0u, 1u}) {
      const auto of_set = static_cast<std::int32_t>(set), of_side = static_cast<std::int32_t>(side);
      const WheelForce& wheel = now.wheels[set][side];
      keep_wheel_force(wheel, wheel_force_of(state, of_set, of_side));
      if (keeps_creepage(model))
        std::copy_n(wheel.creepage, 3, creepage_of(state, of_set, of_side));
    }
}

}  // namespace

std::vector<double> start_in_equilibrium(const Track& track, const PackedModel& packed,
                                         double gravity, const Acting& beside,
                                         const std::vector<double>& rate) {
  const Model& model = packed.model();
  check_sides(model);
  std::vector<double> memory = start_released(packed);
  State state = state_on(model, memory.data());
  const Statics statics(track);
  const Pose at = equilibrium(statics, packed, gravity, 0., beside);
  const Window w = window(model, track.length());
  const auto beside_at = [&](double time) {
    Acting moved = beside;
    for (std::size_t i = 0; i < rate.size(); ++i) moved.contacts[i].force += rate[i] * time;
    return moved;
  };
  const Pose later = passing(statics, packed, gravity, w.to, at, beside_at(w.to));
  const Pose before = passing(statics, packed, gravity, w.from, at, beside_at(w.from));
  const double span = w.to > w.from ? w.to - w.from : 1.;  // s; 1 if there is no window
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
  std::copy(at.contact_force.begin(), at.contact_force.end(), state.contact_force);
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const std::size_t own = static_cast<std::size_t>(b);
    const Eigen::VectorXd& u = at.vehicles.displacement[own];
    const Eigen::VectorXd v =
        (later.vehicles.displacement[own] - before.vehicles.displacement[own]) / span;
    std::copy(u.begin(), u.end(), state.u + model.vehicle[b].first);
    std::copy(v.begin(), v.end(), state.v + model.vehicle[b].first);
  }
  for (std::int32_t i = 0; i < model.vehicle_wheels; ++i)
    state.contact_force[vehicle_contact(model, i)] = at.vehicles.force[i];
  put_runners(packed, at.runners, before.runners, later.runners, span, state);
  put_port_forces(model, state);
  put_seats(model, state);
  return memory;
}

}  // namespace railstep
