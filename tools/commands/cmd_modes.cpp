#include <fmt/core.h>

#include <Eigen/Core>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "answer/scene_running.h"
#include "build/build.h"
#include "commands/command.h"
#include "commands/options.h"
#include "offline/analysis/damped.h"
#include "offline/track/fixed_port.h"
#include "run/unit_note.h"
#include "text/remarks.h"

namespace railstep {
namespace {

struct ModesOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<double> speed;
  int count = 10;
  bool json = false;
};

NaturalModes solve(const ModesOptions& o, Remarks& remarks) try {
  // Eigen blocks its products by the sizes of the caches; with fixed sizes the bits are the same on
  // all processors.
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
  const Scene scene = read_scene(o.scene, o.overrides);
  remarks.note(lopsided_note(scene));
  remarks.print();
  return natural_modes(linear_about_rest(track_of(scene)), o.count);
} catch (const Refused& error) {
  throw InputError(o.scene, error);
}

void print_table(const NaturalModes& modes) {
  fmt::print("mode  frequency, Hz  damping ratio\n");
  for (std::size_t i = 0; i < modes.frequency.size(); ++i)
    fmt::print("{:4}  {:13.6g}  {:13.6g}\n", i + 1, modes.frequency[i], modes.damping_ratio[i]);
}

nlohmann::ordered_json to_json(const NaturalModes& modes) {
  return {{"frequencies_hz", modes.frequency}, {"damping_ratios", modes.damping_ratio}};
}

nlohmann::ordered_json to_json(const std::vector<RunningMode>& modes) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const RunningMode& m : modes)
    all.push_back({{"frequency_hz", m.frequency}, {"damping_ratio", m.damping_ratio}});
  return {{"modes", all}};
}

void print_table(const std::vector<RunningMode>& modes) {
  fmt::print("mode  |s|/(2 pi), Hz  damping ratio\n");
  for (std::size_t i = 0; i < modes.size(); ++i)
    fmt::print("{:4}  {:14.7g}  {:13.6g}\n", i + 1, modes[i].frequency, modes[i].damping_ratio);
}

template <typename Modes>
void print(const Modes& modes, const Remarks& remarks, bool json) {
  if (!json) return print_table(modes);
  nlohmann::ordered_json result = to_json(modes);
  remarks.add_to(result);
  print_json(result);
}

/// The modes of the track, or of the vehicles where they have a speed.
Exit run_modes(const ModesOptions& o) {
  Remarks remarks;
  if (o.speed)
    print(modes_at_speed(read_scene(o.scene, o.overrides), *o.speed), remarks, o.json);
  else
    print(solve(o, remarks), remarks, o.json);
  return Exit::done;
}

}  // namespace

Command add_modes(CLI::App& app) {
  auto o = std::make_shared<ModesOptions>();
  CLI::App* sub = app.add_subcommand(
      "modes", "Natural frequencies and damping of a track, or of vehicles that run");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--count", o->count, "how many, the lowest first (default 10)")
      ->check(within(1, 1000));
  sub->add_option("--speed", o->speed,
                  "modes of the rail vehicles at this speed, m/s, on even rails")
      ->check(within(0.1, 1000.0));
  add_overrides(*sub, o->overrides);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep modes config/scenes/free_rail.toml --count 12");
  return {sub, [o] { return run_modes(*o); }};
}

}  // namespace railstep
