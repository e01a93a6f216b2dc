#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands/command.h"
#include "commands/options.h"
#include "hard/hard_report.h"
#include "report/drawing.h"
#include "text/progress_bar.h"
#include "text/write.h"

namespace railstep {
namespace {

struct HardOptions {
  std::string folder = "config/hard", report;
  std::vector<std::string> cases;
  bool json = false;
};

std::vector<HardCase> chosen_cases(const std::vector<std::string>& ids) {
  std::vector<HardCase> all = hard_cases(), some;
  if (ids.empty()) return all;
  for (const std::string& id : ids) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const HardCase& own) { return id == own.id; });
    if (found == all.end())
      throw InputError("E-HARD-01",
                       fmt::format("--case {}: there is no such case; expected {} to {}", id,
                                   all.front().id, all.back().id));
    some.push_back(*found);
  }
  return some;
}

nlohmann::ordered_json to_json(const HardOutcome& own) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const HardCheck& check : own.result.checks)
    checks.push_back({{"what", check.what},
                      {"figure", check.figure},
                      {"bound", check.bound},
                      {"passed", check.passed()}});
  const HardCheck& nearest = tightest(own.result);
  return {{"id", own.of.id},
          {"title", own.of.title},
          {"scene", own.of.scene},
          {"figure", nearest.figure},
          {"bound", nearest.bound},
          {"passed", own.passed()},
          {"frame_us", own.result.frame_us},
          {"checks", checks}};
}

void print_table(const std::vector<HardOutcome>& outcomes) {
  for (const HardOutcome& own : outcomes) {
    fmt::print("{} {}: {}\n", own.passed() ? "passed" : "FAILED", own.of.id, own.of.title);
    for (const HardCheck& check : own.result.checks)
      fmt::print("  {:<7} {:>10.3g} of {:<8.3g} {}\n", check.passed() ? margin_text(check) : "OVER",
                 check.figure, check.bound, check.what);
  }
}

Exit run_hard(const HardOptions& o) {
  const std::vector<HardCase> cases = chosen_cases(o.cases);
  if (!o.report.empty()) need_gnuplot();
  std::vector<HardOutcome> outcomes;
  outcomes.reserve(cases.size());
  {
    Progress bar(static_cast<std::int64_t>(cases.size()));
    for (const HardCase& own : cases) {
      outcomes.push_back(
          {own, own.run(std::filesystem::path(o.folder) / (std::string(own.scene) + ".toml"))});
      bar(static_cast<std::int64_t>(outcomes.size()));
    }
  }
  if (!o.report.empty()) write_file(o.report, hard_report(outcomes));
  if (o.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const HardOutcome& own : outcomes) all.push_back(to_json(own));
    fmt::print("{}\n", nlohmann::ordered_json{{"cases", all}}.dump(2));
  } else {
    print_table(outcomes);
  }
  const bool passed = std::all_of(outcomes.begin(), outcomes.end(),
                                  [](const HardOutcome& own) { return own.passed(); });
  return passed ? Exit::done : Exit::not_reached;
}

}  // namespace

Command add_hard(CLI::App& app) {
  auto o = std::make_shared<HardOptions>();
  CLI::App* sub = app.add_subcommand("hard", "Run the hard cases: each figure against its bound");
  sub->add_option("--case", o->cases, "only this one, H1 say (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_option("--scenes", o->folder, "folder of their scenes")->capture_default_str();
  sub->add_option("--report", o->report, "write a page with pictures (HTML; needs gnuplot)")
      ->check(writes_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Exit code 1 where a figure is over its bound.\n\n"
      "Example: railstep hard --report hard.html");
  return {sub, [o] { return run_hard(*o); }};
}

}  // namespace railstep
