#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands/command.h"
#include "commands/options.h"
#include "run/recording.h"

namespace railstep {
namespace {

struct ReplayOptions {
  std::string recording;
  bool json = false;
};

Exit rerun(const ReplayOptions& o) {
  const Recording recording = Recording::read(o.recording);
  const Replay made = replay(recording, o.recording);
  nlohmann::ordered_json result = {{"identical", made.identical},
                                   {"first_difference", nullptr},
                                   {"frames", recording.frames},
                                   {"hashes", recording.hashes.size()}};
  if (!made.identical)
    result["first_difference"] = {{"frame", made.first.frame},
                                  {"recorded", fmt::format("{:016x}", made.first.recorded)},
                                  {"found", fmt::format("{:016x}", made.first.found)}};
  if (o.json)
    fmt::print("{}\n", result.dump(2));
  else if (made.identical)
    fmt::print("identical: {} frames, {} hashes\n", recording.frames, recording.hashes.size());
  else
    fmt::print("not identical: after frame {} the state's hash is {:016x}, recorded {:016x}\n",
               made.first.frame, made.first.found, made.first.recorded);
  return made.identical ? Exit::done : Exit::not_reached;
}

}  // namespace

Command add_replay(CLI::App& app) {
  auto o = std::make_shared<ReplayOptions>();
  CLI::App* sub = app.add_subcommand("replay", "Make a recorded run again and compare its hashes");
  sub->add_option("RECORDING", o->recording, "recording that `railstep run --record` wrote")
      ->required()
      ->check(reads_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Exit code 1 where a hash differs.\n\nExample: railstep run config/scenes/wheel_flat.toml "
      "--record flat.recording && railstep replay flat.recording");
  return {sub, [o] { return rerun(*o); }};
}

}  // namespace railstep
