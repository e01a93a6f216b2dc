#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "answer/rules_table.h"
#include "commands/command.h"
#include "commands/options.h"
#include "text/write.h"

namespace railstep {
namespace {

struct RulesOptions {
  std::vector<std::string> families;
  std::string csv;
  bool json = false;
};

/// Rules of the named families, the default always among them.
std::vector<NamedRule> chosen_rules(const std::vector<std::string>& families) {
  std::vector<NamedRule> rules = study_rules();
  if (families.empty()) return rules;
  const auto unwanted = [&](const NamedRule& rule) {
    return rule.family != "default" &&
           std::find(families.begin(), families.end(), rule.family) == families.end();
  };
  rules.erase(std::remove_if(rules.begin(), rules.end(), unwanted), rules.end());
  return rules;
}

Exit run_rules(const RulesOptions& o) {
  const std::vector<StudyRow> rows = study_rows(chosen_rules(o.families));
  if (!o.csv.empty()) write_file(o.csv, to_csv(rows));
  if (!o.json) {
    fmt::print("{}", to_table(rows));
    return Exit::done;
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const StudyRow& row : rows) all.push_back(to_json(row));
  fmt::print("{}\n", nlohmann::ordered_json{{"rows", all}}.dump(2));
  return Exit::done;
}

}  // namespace

Command add_rules(CLI::App& app) {
  auto o = std::make_shared<RulesOptions>();
  CLI::App* sub = app.add_subcommand(
      "rules", "Integration points: error, rank and cost of the element under different choices");
  sub->add_option("--family", o->families, "only these choices, beside the default (repeatable)")
      ->check(CLI::IsMember(
          {"axial", "coupling-points", "section", "reference-line", "coupling", "shear"}));
  sub->add_option("--csv", o->csv, "write every row as CSV")->check(writes_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep rules --family axial --csv rules.csv");
  return {sub, [o] { return run_rules(*o); }};
}

}  // namespace railstep
