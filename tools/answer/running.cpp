#include "answer/running.h"

#include <fmt/core.h>

#include <algorithm>

#include "text/read.h"

namespace railstep {
namespace {

/// The steady running of one vehicle of a scene, and what it needs.
struct Run {
  RunnerMatrices matrices;
  SteadyRunning steady;
};

[[noreturn]] void refuse_scene(const Scene& scene, MessageId id, const char* sentence) {
  throw InputError(id, fmt::format("{}: {}", scene.file.string(), sentence));
}

void check(const Scene& scene) {
  if (scene.rail_vehicles.empty())
    refuse_scene(scene, "E-VEHICLE-27",
                 "the scene has no vehicle in space; expected a [[vehicle]] whose type is "
                 "\"rail_vehicle\"");
  if (!scene.track.rigid)
    refuse_scene(scene, "E-VEHICLE-28",
                 "the motions of a vehicle that runs are found on rigid rails, but these give way; "
                 "expected track.form = \"rigid\"");
}

Run run_of(const RailVehicleScene& v, double speed) {
  RunnerMatrices matrices = runner_matrices(v.runner, kGravity);
  SteadyRunning steady = steady_running(v.runner, matrices, v.contact, speed);
  return {std::move(matrices), std::move(steady)};
}

void add_loads(const RailVehicleScene& v, RunningLoads& loads) {
  const Run run = run_of(v, v.speed);
  const auto forces = wheel_forces(v.runner, v.contact, v.speed, run.steady);
  std::size_t set = 0;
  for (std::size_t b = 0; b < v.runner.bodies.size(); ++b) {
    if (!v.runner.bodies[b].is_wheelset()) continue;
    const std::string& name = v.wheelsets[set];
    const auto& [left, right] = forces[set++];
    loads.wheels.push_back(
        {name + "_left", left.generalised[2], -left.generalised[1], left.generalised[0]});
    loads.wheels.push_back(
        {name + "_right", right.generalised[2], right.generalised[1], right.generalised[0]});
    const auto first = kMotions * static_cast<Eigen::Index>(b);
    loads.wheelsets.push_back({name, run.steady.displacement[first + index_of(BodyMotion::y)],
                               run.steady.displacement[first + index_of(BodyMotion::yaw)],
                               -left.generalised[1] - right.generalised[1],
                               -(left.generalised[0] + right.generalised[0])});
  }
}

}  // namespace

std::vector<RunningMode> modes_at_speed(const Scene& scene, double speed) {
  check(scene);
  std::vector<RunningMode> all;
  for (const RailVehicleScene& v : scene.rail_vehicles) {
    const Run run = run_of(v, speed);
    const std::vector<RunningMode> own =
        running_modes(linear_running(v.runner, run.matrices, v.contact, speed, run.steady));
    all.insert(all.end(), own.begin(), own.end());
  }
  std::sort(all.begin(), all.end(),
            [](const RunningMode& a, const RunningMode& b) { return a.frequency < b.frequency; });
  return all;
}

std::optional<CriticalRunning> critical_speed_between(const Scene& scene, double from, double to) {
  check(scene);
  std::optional<CriticalRunning> least;
  for (const RailVehicleScene& v : scene.rail_vehicles) {
    const auto own =
        critical_running_speed(v.runner, runner_matrices(v.runner, kGravity), v.contact, from, to);
    if (own && (!least || own->speed < least->speed)) least = own;
  }
  return least;
}

RunningLoads running_loads(const Scene& scene) {
  check(scene);
  RunningLoads loads;
  for (const RailVehicleScene& v : scene.rail_vehicles) add_loads(v, loads);
  return loads;
}

}  // namespace railstep
