#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/options.h"
#include "report/drawing.h"
#include "report/pareto_report.h"
#include "study/advice.h"
#include "text/progress_bar.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

struct ParetoOptions {
  ParetoRequest request;
  std::string report, csv;
  bool json = false;
};

nlohmann::ordered_json to_json(const ParetoResult& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SettingRow& row : result.rows) rows.push_back(to_json(row));
  return {{"reference",
           {{"how", result.reference.how},
            {"error", result.reference.error},
            {"judged", judged_text(result)},
            {"from_s", result.judged.from}}},
          {"frame_s", result.frame},
          {"advice", advice(result)},
          {"rows", std::move(rows)}};
}

void print_front(const ParetoResult& result) {
  const double floor = floor_of(result.reference);
  fmt::print("reference  {}; own error {:.1e}\njudged     {}, from {:g} s on\n\n",
             result.reference.how, result.reference.error, judged_text(result), result.judged.from);
  fmt::print("{:>9} {:>14} {:>9} {:>9} {:>9} {:>9} {:>10}  front\n", "frame, us", "error", "step",
             "changes", "condens.", "mesh", "flops");
  for (const SettingRow& row : result.rows)
    if (row.on_front)
      fmt::print("{:>9.3g} {:>14} {:>9.1e} {:>9.1e} {:>9.1e} {:>9.1e} {:>10}  {}\n", row.cost.us,
                 error_text(row.errors.judged, floor), row.parts.step, row.parts.changes,
                 row.parts.condensation, row.parts.mesh, row.cost.flops, words_of(row.setting));
  std::size_t failed = 0;
  for (const SettingRow& row : result.rows) failed += row.failure.empty() ? 0 : 1;
  fmt::print("\n{} settings, {} made no result\n", result.rows.size(), failed);
  for (const std::string& sentence : advice(result)) fmt::print("{}\n", sentence);
}

Exit run(const ParetoOptions& o) {
  if (!o.report.empty()) need_gnuplot();
  ParetoResult result;
  {
    std::unique_ptr<Progress> bar;
    result = pareto(o.request, [&](std::int64_t done, std::int64_t all) {
      if (!bar) bar = std::make_unique<Progress>(all);
      (*bar)(done);
    });
  }
  if (!o.csv.empty()) write_file(o.csv, pareto_csv(result));
  if (!o.report.empty())
    write_file(o.report, pareto_report(fmt::format("Speed against error: {}",
                                                   o.request.scene.filename().string()),
                                       result));
  Remarks remarks;
  if (std::none_of(result.rows.begin(), result.rows.end(),
                   [](const SettingRow& row) { return row.failure.empty(); }))
    remarks.error({"E-STUDY-14", "no setting made a result; the first one failed: " +
                                     result.rows.front().failure});
  nlohmann::ordered_json told = to_json(result);
  remarks.add_to(told);
  if (o.json)
    print_json(told);
  else
    print_front(result);
  remarks.print();
  return remarks.has_errors() ? Exit::not_reached : Exit::done;
}

}  // namespace

Command add_pareto(CLI::App& app) {
  auto o = std::make_shared<ParetoOptions>();
  ParetoRequest& asked = o->request;
  CLI::App* sub = app.add_subcommand(
      "pareto", "Speed against error of a scene over models, meshes, schemes and steps");
  sub->add_option("SCENE", asked.scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--report", o->report, "HTML page to write")->check(writes_file());
  sub->add_option("--csv", o->csv, "table to write")->check(writes_file());
  sub->add_option("--resume", asked.resume,
                  "file that keeps the results; those that it has are not run again")
      ->check(writes_file());
  add_study(
      *sub,
      {"with commas; a model is KIND[:AMOUNT][:bare][:UNKNOWNS]",
       "with commas: generalised-alpha:RHO_INF, newmark, hht:ALPHA, backward-euler, tr-bdf2; of "
       "condensed models held:RHO_INF, discrete-gradient",
       "what counts as the error: deflection, contact_force, lateral_force, sum_of_lateral_forces, "
       "support_force, sensor, stress, or a column; repeatable; by default the first that there "
       "is"},
      asked.overrides, asked.choices, asked.judged);
  sub->add_option(
         "--vary", asked.choices.varied,
         "key.path=a,b,c: values of another key, repeatable; the reference has the scene's")
      ->type_name("KEY=A,B")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_option("--reference-error", asked.reference_error,
                  "refine the reference until its own error is below")
      ->check(within(1e-15, 1.));
  sub->add_option("--reference-levels", asked.reference_levels, "levels of refinement at most")
      ->check(within(2, 10));
  CLI::Option* trace = sub->add_option("--reference", asked.reference,
                                       "trace (CSV) to measure against, of the scene's frames")
                           ->check(reads_file());
  sub->add_option("--own-error", asked.reference_own_error,
                  "error of that trace, as its maker states it")
      ->needs(trace)
      ->check(within(0., 1.));
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Example: railstep pareto config/scenes/moving_load.toml --report pareto.html --csv "
      "pareto.csv --resume pareto.jsonl");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
