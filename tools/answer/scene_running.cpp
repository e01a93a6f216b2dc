#include "answer/scene_running.h"

#include <fmt/core.h>

#include <algorithm>

#include "offline/energy/runner_energy.h"
#include "offline/start/standing_track.h"
#include "run/simulation.h"
#include "text/read.h"

namespace railstep {
namespace {

void check(const Scene& scene) {
  if (scene.rail_vehicles.empty())
    throw InputError("E-VEHICLE-27",
                     fmt::format("{}: the scene has no vehicle in space; expected a [[vehicle]] "
                                 "whose type is \"rail_vehicle\"",
                                 scene.file.string()));
}

/// The rails under each vehicle of a scene, even ones, and the design line where it starts.
/// @param shape  to which the lines point
std::vector<RunningOn> rails_of(Scene scene, const LineShape& shape) {
  std::vector<RunningOn> rails(scene.rail_vehicles.size());
  const auto set_lines = [&] {
    for (std::size_t i = 0; i < rails.size() && shape.is_there(); ++i) {
      const RailVehicleScene& v = scene.rail_vehicles[i];
      rails[i].line = design_line(shape, reach_of(v.runner));
      rails[i].gravity = v.gravity;
      rails[i].place = v.start + v.runner.bodies.front().centre[0];
    }
  };
  if (scene.track.rigid) {
    set_lines();
    return rails;
  }
  scene.irregularity.reset();
  const Built built(scene);
  for (std::size_t i = 0; i < rails.size(); ++i)
    rails[i] = rails_at_rest(*built.packed, built.track, static_cast<std::int32_t>(i));
  set_lines();
  return rails;
}

/// @param creep_power  of both wheels, W
void add_wheelset(const std::string& name, const double* left, const double* right,
                  const double* motion, double creep_power, double speed, RunningLoads& loads) {
  loads.wheels.push_back({name + "_left", left[2], -left[1], left[0]});
  loads.wheels.push_back({name + "_right", right[2], right[1], right[0]});
  loads.wheelsets.push_back({name, motion[index_of(BodyMotion::y)],
                             motion[index_of(BodyMotion::yaw)], -left[1] - right[1],
                             speed == 0. ? -(left[0] + right[0]) : -creep_power / speed});
}

void add_loads_on_rigid(const RailVehicleScene& v, const RunningOn& on, RunningLoads& loads) {
  const Running here = running_on(on, v.runner, loaded_matrices(v), v.contact, v.speed);
  const SteadyRunning steady =
      steady_running(v.runner, here.matrices, v.contact, v.speed, here.rails);
  const auto forces = wheel_forces(v.runner, v.contact, v.speed, steady, here.rails);
  std::size_t set = 0;
  for (std::size_t b = 0; b < v.runner.bodies.size(); ++b) {
    if (!v.runner.bodies[b].is_wheelset()) continue;
    const std::string& name = v.wheelsets[set];
    const auto& [left, right] = forces[set++];
    add_wheelset(name, left.generalised, right.generalised,
                 steady.displacement.data() + kMotions * static_cast<Eigen::Index>(b),
                 left.creep_power + right.creep_power, v.speed, loads);
  }
}

/// The loads at which a run starts.
void add_loads_on_track(const Scene& scene, RunningLoads& loads) {
  const Simulation run(scene);
  const Model& model = run.model();
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& own = model.runner[r];
    const StandingRunner standing = standing_runner(model, own, run.state);
    for (int i = 0; i < own.wheelsets; ++i) {
      const auto& [left, right] = standing.wheels[static_cast<std::size_t>(i)];
      const std::int32_t set = own.first_wheelset + i;
      add_wheelset(
          scene.rail_vehicles[static_cast<std::size_t>(r)].wheelsets[static_cast<std::size_t>(i)],
          wheel_force_of(run.state, set, 0), wheel_force_of(run.state, set, 1),
          run.state.u + own.first + own.wheelset[i].first,
          left.force.creep_power + right.force.creep_power, standing.speed, loads);
    }
  }
}

std::vector<RunningMode> modes_on(const Scene& scene, const std::vector<RunningOn>& rails,
                                  double speed) {
  std::vector<RunningMode> all;
  for (std::size_t i = 0; i < rails.size(); ++i) {
    const RailVehicleScene& v = scene.rail_vehicles[i];
    const RunnerMatrices m = loaded_matrices(v);
    const Running here = running_on(rails[i], v.runner, m, v.contact, speed);
    const SteadyRunning steady =
        steady_running(v.runner, here.matrices, v.contact, speed, here.rails);
    const std::vector<RunningMode> own = running_modes(linear_running(
        v.runner, here.matrices, v.contact, speed, steady, {here.rails, rails[i].track}));
    all.insert(all.end(), own.begin(), own.end());
  }
  std::sort(all.begin(), all.end(),
            [](const RunningMode& a, const RunningMode& b) { return a.frequency < b.frequency; });
  return all;
}

}  // namespace

std::vector<RunningMode> modes_at_speed(const Scene& scene, double speed) {
  check(scene);
  return modes_on(scene, rails_of(scene, scene.design_line), speed);
}

std::vector<ModesAtSpeed> modes_at_speeds(const Scene& scene, const std::vector<double>& speeds) {
  check(scene);
  const std::vector<RunningOn> rails = rails_of(scene, scene.design_line);
  std::vector<ModesAtSpeed> all;
  for (const double speed : speeds) {
    all.push_back({speed, {}});
    try {
      all.back().modes = modes_on(scene, rails, speed);
    } catch (const Failed&) {  // no steady motion at this speed
    }
  }
  return all;
}

std::optional<CriticalRunning> critical_speed_between(const Scene& scene, double from, double to,
                                                      SpeedRange* searched) {
  check(scene);
  const std::vector<RunningOn> rails = rails_of(scene, scene.design_line);
  std::optional<CriticalRunning> least;
  SpeedRange all{from, to};
  for (std::size_t i = 0; i < rails.size(); ++i) {
    const RailVehicleScene& v = scene.rail_vehicles[i];
    SpeedRange range{from, to};
    const auto own =
        critical_running_speed(v.runner, loaded_matrices(v), v.contact, range, rails[i]);
    all = {std::max(all.from, range.from), std::min(all.to, range.to)};
    if (own && (!least || own->speed < least->speed)) least = own;
  }
  if (searched != nullptr) *searched = all;
  return least;
}

RunningLoads running_loads(const Scene& scene) {
  check(scene);
  RunningLoads loads;
  if (!scene.track.rigid) {
    add_loads_on_track(scene, loads);
    return loads;
  }
  const std::vector<RunningOn> rails = rails_of(scene, scene.design_line);
  for (std::size_t i = 0; i < rails.size(); ++i)
    add_loads_on_rigid(scene.rail_vehicles[i], rails[i], loads);
  return loads;
}

}  // namespace railstep
