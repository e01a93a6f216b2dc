#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "answer/static_solution.h"
#include "commands/command.h"
#include "commands/options.h"
#include "run/unit_note.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

struct StaticOptions {
  std::string scene, model, shape;
  std::vector<std::string> overrides;
  bool json = false;
};

nlohmann::ordered_json to_json(const StaticSolution& solution) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const StaticPoint& point : solution.points)
    points.push_back({{"name", point.name}, {"displacement_m", point.displacement}});
  return {{"points", points},
          {"iterations", solution.iterations},
          {"residual", solution.residual},
          {"load_steps", solution.load_steps},
          {"stable", solution.stable},
          {"converged", solution.converged}};
}

void print_table(const StaticSolution& solution) {
  fmt::print("{:<20} {:>17} {:>17} {:>17}\n", "point", "dx_m", "dy_m", "dz_m");
  for (const StaticPoint& p : solution.points)
    fmt::print("{:<20} {:>17.9e} {:>17.9e} {:>17.9e}\n", p.name, p.displacement[0],
               p.displacement[1], p.displacement[2]);
  fmt::print("iterations {}, load steps {}, residual {:.2e} of the load\n", solution.iterations,
             solution.load_steps, solution.residual);
  if (!solution.stable) fmt::print("unstable: the rails buckle out of this shape\n");
}

void print_history(const StaticSolution& solution) {
  fmt::print(stderr, "{:>12} {:>9} {:>12}\n", "load factor", "iteration", "residual");
  for (const NewtonStep& step : solution.history)
    fmt::print(stderr, "{:>12.6g} {:>9} {:>12.3e}\n", step.load_factor, step.iteration,
               step.residual);
}

/// Points of the rails' neutral axis, at rest and displaced.
std::string to_csv(const StaticSolution& solution) {
  std::string text = "rail,x_m,y_m,z_m,dx_m,dy_m,dz_m\n";
  for (const StaticPoint& p : solution.axis)
    text +=
        fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", p.name, p.rest[0],
                    p.rest[1], p.rest[2], p.displacement[0], p.displacement[1], p.displacement[2]);
  return text;
}

nlohmann::ordered_json to_json(const RunningLoads& loads) {
  nlohmann::ordered_json wheels = nlohmann::ordered_json::array(), sets = wheels;
  for (const WheelLoad& w : loads.wheels)
    wheels.push_back({{"name", w.name}, {"q_n", w.q}, {"y_n", w.y}, {"t_x_n", w.t_x}});
  for (const WheelsetLoad& w : loads.wheelsets)
    sets.push_back({{"name", w.name},
                    {"y_m", w.y},
                    {"yaw_rad", w.yaw},
                    {"sum_y_n", w.sum_y},
                    {"resistance_n", w.resistance}});
  return {{"wheels", wheels}, {"wheelsets", sets}};
}

void print_table(const RunningLoads& loads) {
  fmt::print("{:<28} {:>12} {:>12} {:>12}\n", "wheel", "q_n", "y_n", "t_x_n");
  for (const WheelLoad& w : loads.wheels)
    fmt::print("{:<28} {:>12.2f} {:>12.2f} {:>12.2f}\n", w.name, w.q, w.y, w.t_x);
  fmt::print("{:<28} {:>12} {:>12} {:>12} {:>12}\n", "wheelset", "y_m", "yaw_rad", "sum_y_n",
             "resistance_n");
  for (const WheelsetLoad& w : loads.wheelsets)
    fmt::print("{:<28} {:>12.4e} {:>12.4e} {:>12.4e} {:>12.2f}\n", w.name, w.y, w.yaw, w.sum_y,
               w.resistance);
}

/// Rail vehicles: the steady forces of their wheels.
Exit run_rail_vehicles(const Scene& scene, bool json) {
  const RunningLoads loads = running_loads(scene);
  if (!json) {
    print_table(loads);
    return Exit::done;
  }
  nlohmann::ordered_json result = to_json(loads);
  Remarks().add_to(result);
  print_json(result);
  return Exit::done;
}

Exit run_static(const StaticOptions& o) {
  std::vector<std::string> overrides = o.overrides;
  if (!o.model.empty()) overrides.push_back(fmt::format("track.model=\"{}\"", o.model));
  const Scene scene = read_scene(o.scene, overrides);
  if (!scene.rail_vehicles.empty()) return run_rail_vehicles(scene, o.json);
  Remarks remarks;
  remarks.note(lopsided_note(scene));
  remarks.print();
  const StaticSolution solution = solve_static(scene);
  if (!solution.converged)
    remarks.error({"E-STATIC-02", o.scene +
                                      ": no equilibrium was found within static.most_iterations "
                                      "and static.most_load_halvings"});
  if (solution.converged && !o.shape.empty()) write_file(o.shape, to_csv(solution));
  nlohmann::ordered_json result = to_json(solution);
  remarks.add_to(result);
  if (o.json)
    print_json(result);
  else if (solution.converged)
    print_table(solution);
  remarks.print();
  if (solution.converged) return Exit::done;
  print_history(solution);
  return Exit::not_reached;
}

}  // namespace

Command add_static(CLI::App& app) {
  auto o = std::make_shared<StaticOptions>();
  CLI::App* sub = app.add_subcommand("static", "Static equilibrium of a scene at t = 0");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--model", o->model, "how the rail bends, in place of the scene's track.model")
      ->check(CLI::IsMember({"nonlinear", "linearised", "timoshenko"}));
  sub->add_option("--shape", o->shape, "write the displaced neutral axis (CSV)")
      ->check(writes_file());
  add_overrides(*sub, o->overrides);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep static config/scenes/cantilever_rail.toml");
  return {sub, [o] { return run_static(*o); }};
}

}  // namespace railstep
