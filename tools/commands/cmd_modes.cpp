#include <fmt/core.h>

#include <Eigen/Core>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "build/build.h"
#include "commands/command.h"
#include "commands/options.h"
#include "offline/analysis/damped.h"
#include "offline/track/fixed_port.h"
#include "run/unit_note.h"

namespace railstep {
namespace {

struct ModesOptions {
  std::string scene;
  std::vector<std::string> overrides;
  int count = 10;
  bool json = false;
};

NaturalModes solve(const ModesOptions& o) try {
  // Eigen blocks its products by the sizes of the caches; with fixed sizes the bits are the same on
  // all processors.
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 2 << 20);
  const Scene scene = read_scene(o.scene, o.overrides);
  print_note(lopsided_note(scene));
  return natural_modes(linear_about_rest(track_of(scene)), o.count);
} catch (const Refused& error) {
  throw InputError(o.scene, error);
}

void print_table(const NaturalModes& modes) {
  fmt::print("mode  frequency, Hz  damping ratio\n");
  for (std::size_t i = 0; i < modes.frequency.size(); ++i)
    fmt::print("{:4}  {:13.6g}  {:13.6g}\n", i + 1, modes.frequency[i], modes.damping_ratio[i]);
}

}  // namespace

Command add_modes(CLI::App& app) {
  auto o = std::make_shared<ModesOptions>();
  CLI::App* sub = app.add_subcommand("modes", "Natural frequencies and damping of a track");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--count", o->count, "how many, the lowest first (default 10)")
      ->check(within(1, 1000));
  add_overrides(*sub, o->overrides);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep modes config/scenes/free_rail.toml --count 12");
  return {sub, [o] {
            const NaturalModes modes = solve(*o);
            if (o->json)
              fmt::print("{}\n", nlohmann::ordered_json{{"frequencies_hz", modes.frequency},
                                                        {"damping_ratios", modes.damping_ratio}}
                                     .dump(2));
            else
              print_table(modes);
            return Exit::done;
          }};
}

}  // namespace railstep
