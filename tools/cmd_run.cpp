#include <fmt/core.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "run_report.h"
#include "simulate.h"
#include "write.h"

namespace railstep {
namespace {

struct RunOptions {
  std::string scene, trace, report;
  std::vector<std::string> overrides;
  std::optional<double> step, duration;  // s
  bool json = false;
};

/// A bar on stderr, when that is a terminal; moves once a percent.
class Progress {
 public:
  explicit Progress(std::int64_t frames) : frames_(frames), shown_(isatty(STDERR_FILENO) == 1) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (shown_ && percent_ >= 0) std::fputs("\r\033[K", stderr);
  }
  void operator()(std::int64_t done) {
    const int percent =
        static_cast<int>(100. * static_cast<double>(done) / static_cast<double>(frames_));
    if (!shown_ || percent == percent_) return;
    percent_ = percent;
    const auto full = static_cast<std::size_t>(percent / 4);
    fmt::print(stderr, "\r[{}{}] {:3d} %", std::string(full, '#'), std::string(25 - full, ' '),
               percent);
  }

 private:
  std::int64_t frames_;
  bool shown_;
  int percent_ = -1;
};

Scene scene_of(const RunOptions& o) {
  if (!o.trace.empty() && o.trace == o.report)
    throw InputError(fmt::format("--trace and --report both name {}", o.trace));
  std::vector<std::string> overrides = o.overrides;
  if (o.step) overrides.push_back(fmt::format("step.dt_s={}", *o.step));
  if (o.duration) overrides.push_back(fmt::format("step.duration_s={}", *o.duration));
  return read_scene(o.scene, overrides);
}

nlohmann::ordered_json to_json(const Simulation& run, const RunRecord& record) {
  const Model& model = run.model();
  return {{"steps", run.state.steps},
          {"final_time_s", static_cast<double>(run.state.steps) * model.scheme.dt},
          {"state_hash", fmt::format("{:016x}", state_hash(model, run.state))},
          {"status", status_names(record.status)},
          {"max_constraint_violation", record.constraint_violation},
          {"max_iterations", record.iterations},
          {"frame_us",
           {{"median", quantile(record.frame_us, .5)},
            {"p99", quantile(record.frame_us, .99)},
            {"max", quantile(record.frame_us, 1.)}}},
          {"steps_per_frame", model.steps_per_frame}};
}

void print_table(const nlohmann::ordered_json& result) {
  const auto& us = result["frame_us"];
  fmt::print("steps            {}\nfinal time       {:.9g} s\nstate hash       {}\n",
             result["steps"].get<std::int64_t>(), result["final_time_s"].get<double>(),
             result["state_hash"].get<std::string>());
  fmt::print("steps per frame  {}\nframe, us        median {:.3g}, p99 {:.3g}, max {:.3g}\n",
             result["steps_per_frame"].get<int>(), us["median"].get<double>(),
             us["p99"].get<double>(), us["max"].get<double>());
}

/// Says in words what the run met.
Exit verdict(const Simulation& run, const RunRecord& record) {
  for (const std::string& name : status_names(record.status)) {
    if (name != "nonfinite_state")
      fmt::print(stderr, "note: {}: {}\n", name, status_sentence(name));
    else
      fmt::print(stderr,
                 "error: nonfinite_state: at step {}, t = {:.9g} s, unknown {} of the state ({}) "
                 "is not finite\n",
                 run.state.steps, static_cast<double>(run.state.steps) * run.model().scheme.dt,
                 record.first_bad_unknown, unknown_place(run.model(), record.first_bad_unknown));
  }
  return has(record.status, Status::nonfinite_state) ? Exit::not_reached : Exit::done;
}

Exit run_scene(const RunOptions& o) {
  const Scene scene = scene_of(o);
  if (!o.report.empty()) need_gnuplot();
  Simulation run(scene);
  std::optional<Trace> trace;
  if (!o.trace.empty()) trace.emplace(o.trace, run.columns());
  const std::int64_t frames = run.model().steps / run.model().steps_per_frame;
  RunRecord record;
  {
    Progress bar(frames);
    record = simulate(run, frames, trace ? &*trace : nullptr, !o.report.empty(),
                      [&bar](std::int64_t done) { bar(done); });
  }
  if (trace) trace->finish();
  if (!o.report.empty()) write_file(o.report, run_report(scene, run.columns(), record));
  const nlohmann::ordered_json result = to_json(run, record);
  if (o.json)
    fmt::print("{}\n", result.dump(2));
  else
    print_table(result);
  return verdict(run, record);
}

}  // namespace

Command add_run(CLI::App& app) {
  auto o = std::make_shared<RunOptions>();
  CLI::App* sub = app.add_subcommand("run", "Simulate a scene in fixed steps");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required();
  sub->add_option("--step", o->step, "time step, s, instead of the scene's");
  sub->add_option("--duration", o->duration, "simulated time, s, instead of the scene's");
  sub->add_option("--trace", o->trace, "write a row a frame (CSV)");
  sub->add_option("--report", o->report, "write a page with plots (HTML; needs gnuplot)");
  sub->add_option("--set", o->overrides, "key.path=value, as if written in the scene; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep run config/scenes/moving_load.toml --trace moving_load.csv");
  return {sub, [o] { return run_scene(*o); }};
}

}  // namespace railstep
