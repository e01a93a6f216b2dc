#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/options.h"
#include "study/tune.h"
#include "text/files.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

struct TuneOptions {
  TuneRequest request;
  std::string out;
  bool json = false;
};

/// A line on stderr, when that is a terminal, that says what the program is doing.
class Doing {
 public:
  void operator()(const std::string& what) const {
    if (shown_) fmt::print(stderr, "\r\033[K{}", what);
  }
  ~Doing() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Doing() = default;
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

 private:
  bool shown_ = isatty(STDERR_FILENO) == 1;
};

/// The name of the scene that is written: in the current folder, unless a name is given.
std::filesystem::path place_of(const TuneOptions& o) {
  return o.out.empty() ? std::filesystem::path(o.request.scene.stem().string() + ".tuned.toml")
                       : std::filesystem::path(o.out);
}

std::string scene_text(const TuneOptions& o, const TuneResult& result) {
  const Candidate& choice = *result.choice;
  const std::vector<std::string> overrides = overrides_of(
      Studied{o.request.scene, o.request.overrides, result.frame, {}}, choice.row.setting);
  std::string text = fmt::format(
      "# {}, tuned to an error of {:g}: {}.\n# {:.3g} us a frame where it was timed; error {:.2e}: "
      "step {:.1e}, condensation {:.1e}, mesh {:.1e}.\n",
      o.request.scene.filename().string(), o.request.max_error, words_of(choice.row.setting),
      choice.row.cost.us, choice.row.errors.judged, choice.row.parts.step,
      choice.row.parts.condensation, choice.row.parts.mesh);
  for (const Verification& own : choice.verified)
    text += fmt::format("# {}: {:.2e}\n", own.what, own.error);
  return text + rewritten(o.request.scene, overrides, place_of(o));
}

nlohmann::ordered_json to_json(const TuneResult& result, const std::filesystem::path& scene) {
  nlohmann::ordered_json verified = nlohmann::ordered_json::array();
  if (result.choice)
    for (const Verification& own : result.choice->verified)
      verified.push_back({{"run", own.what}, {"error", own.error}});
  using Json = nlohmann::ordered_json;
  return {{"choice", result.choice ? to_json(result.choice->row) : Json()},
          {"verified_error", result.choice ? Json(result.choice->verified_error()) : Json()},
          {"verified", std::move(verified)},
          {"scene", result.choice ? Json(scene.string()) : Json()},
          {"best", result.best && !result.choice ? to_json(*result.best) : Json()},
          {"binds", result.choice ? Json() : Json(result.binds)},
          {"settings", result.looked_at},
          {"reference", {{"how", result.reference.how}, {"error", result.reference.error}}}};
}

void print_row(const SettingRow& row) {
  fmt::print(
      "{}\n  {:.3g} us a frame ({:.3g} to {:.3g}), at most {} flops\n  error {:.2e}: step {:.1e}, "
      "condensation {:.1e}, mesh {:.1e}\n",
      words_of(row.setting), row.cost.us, row.cost.least, row.cost.most, row.cost.flops,
      row.errors.judged, row.parts.step, row.parts.condensation, row.parts.mesh);
}

/// The choice and where it is written, or the best that was found.
void print_choice(const TuneResult& result, const std::filesystem::path& scene) {
  if (result.choice) {
    print_row(result.choice->row);
    for (const Verification& own : result.choice->verified)
      fmt::print("  {}: {:.2e}\n", own.what, own.error);
    fmt::print("  written to {}\n", scene.string());
  } else if (result.best) {
    fmt::print("the best found:\n");
    print_row(*result.best);
  }
}

Exit run(const TuneOptions& o) {
  announce_output("--out", place_of(o));
  TuneResult result;
  {
    const Doing doing;
    result = tune(o.request, [&doing](const std::string& what) { doing(what); });
  }
  if (result.choice) write_file(place_of(o), scene_text(o, result));
  Remarks remarks;
  if (!result.choice)
    remarks.error({"E-STUDY-15", "no setting reaches what is asked; the limit is " + result.binds});
  nlohmann::ordered_json told = to_json(result, place_of(o));
  remarks.add_to(told);
  if (o.json)
    print_json(told);
  else
    print_choice(result, place_of(o));
  remarks.print();
  return remarks.has_errors() ? Exit::not_reached : Exit::done;
}

}  // namespace

Command add_tune(CLI::App& app) {
  auto o = std::make_shared<TuneOptions>();
  TuneRequest& asked = o->request;
  CLI::App* sub =
      app.add_subcommand("tune", "The cheapest setting of a scene that meets an error, verified");
  sub->add_option("SCENE", asked.scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--max-error", asked.max_error, "largest error over peak")
      ->required()
      ->check(within(1e-12, 1.));
  sub->add_option("--deadline-us", asked.deadline_us,
                  "largest median time of a frame on this machine, us")
      ->check(within(1e-3, 1e9));
  sub->add_option("--out", o->out, "scene to write; by default SCENE.tuned.toml here")
      ->check(writes_file());
  add_study(*sub,
            {"with commas, as of pareto", "with commas, as of pareto",
             "what counts as the error, as of pareto; repeatable"},
            asked.overrides, asked.choices, asked.judged);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Each part of the error, of step, condensation and mesh, is held to a third of it. Exit code "
      "1\n"
      "where nothing meets it, with the best found and the limit that binds.\n\n"
      "Example: railstep tune config/scenes/moving_load.toml --max-error 1e-3 --deadline-us 50");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
