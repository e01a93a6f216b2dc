#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "commands/command.h"
#include "commands/options.h"
#include "report/critical_report.h"
#include "report/drawing.h"
#include "text/write.h"

namespace railstep {
namespace {

struct CriticalOptions {
  std::string scene, report;
  std::vector<std::string> overrides;
  double from = 1., to = 200.;
  bool json = false;
};

nlohmann::ordered_json to_json(const std::optional<CriticalRunning>& found,
                               const SpeedRange& searched) {
  const nlohmann::ordered_json none = nullptr;
  return {{"critical_speed_m_per_s", found ? nlohmann::ordered_json(found->speed) : none},
          {"frequency_hz", found ? nlohmann::ordered_json(found->frequency) : none},
          {"from_m_per_s", searched.from},
          {"to_m_per_s", searched.to}};
}

void print_text(const CriticalOptions& o, const std::optional<CriticalRunning>& found,
                const SpeedRange& searched) {
  if (found)
    fmt::print("critical speed {:.6f} m/s ({:.3f} km/h), a mode of {:.5f} Hz\n", found->speed,
               3.6 * found->speed, found->frequency);
  else
    fmt::print("no mode loses its damping between {:g} and {:g} m/s, or one has none at {:g} m/s\n",
               searched.from, searched.to, searched.from);
  if (searched.from > o.from)
    fmt::print("below {:g} m/s the vehicle finds no steady motion\n", searched.from);
  if (!found && searched.to < o.to)
    fmt::print("above {:g} m/s the vehicle finds no steady motion\n", searched.to);
}

void write_page(const CriticalOptions& o, const Scene& scene,
                const std::optional<CriticalRunning>& found) {
  constexpr int kSpeeds = 100;
  std::vector<double> speeds;
  for (int k = 0; k <= kSpeeds; ++k) speeds.push_back(o.from + (o.to - o.from) * k / kSpeeds);
  write_file(o.report, critical_page(std::filesystem::path(o.scene).stem().string(),
                                     modes_at_speeds(scene, speeds), found));
}

Exit run_critical(const CriticalOptions& o) {
  if (!(o.from < o.to))
    throw InputError("E-CLI-15", fmt::format("--from {:g} is not below --to {:g}; expected a range "
                                             "of speeds",
                                             o.from, o.to));
  if (!o.report.empty()) need_gnuplot();
  const Scene scene = read_scene(o.scene, o.overrides);
  SpeedRange searched;
  const auto found = critical_speed_between(scene, o.from, o.to, &searched);
  if (!o.report.empty()) write_page(o, scene, found);
  if (o.json)
    fmt::print("{}\n", to_json(found, searched).dump(2));
  else
    print_text(o, found, searched);
  return Exit::done;
}

}  // namespace

Command add_critical(CLI::App& app) {
  auto o = std::make_shared<CriticalOptions>();
  CLI::App* sub = app.add_subcommand(
      "critical",
      "The least speed at which a rail vehicle hunts, on even rails, straight or curved");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--from", o->from, "lowest speed, m/s (default 1)")->check(within(0.1, 1000.0));
  sub->add_option("--to", o->to, "highest speed, m/s (default 200)")->check(within(0.1, 1000.0));
  sub->add_option("--report", o->report, "write a page with the root locus (HTML; needs gnuplot)")
      ->check(writes_file());
  add_overrides(*sub, o->overrides);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Example: railstep critical config/scenes/manchester_straight.toml --from 10 --to 150");
  return {sub, [o] { return run_critical(*o); }};
}

}  // namespace railstep
