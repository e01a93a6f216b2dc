#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands/command.h"
#include "commands/options.h"
#include "report/drawing.h"
#include "report/receptance_report.h"
#include "text/write.h"

namespace railstep {
namespace {

struct ReceptanceOptions : ReceptanceRequest {
  std::string model = "full", report, csv;
  double step = 0.;
  bool json = false;
};

void run(ReceptanceOptions& o) {
  if (o.to_hz == 0.) o.to_hz = o.from_hz;
  if (!o.report.empty() && o.to_hz == o.from_hz)
    throw InputError("E-RECEPTANCE-21",
                     "--report draws curves over frequency; expected --to-hz above --from");
  o.condensed = o.model == "condensed";
  if (o.step > 0.) o.step_hz = o.step;
  if (!o.report.empty()) need_gnuplot();
  const ReceptanceAnswer answer = solve_receptance(o);
  if (!o.csv.empty()) write_file(o.csv, to_csv(answer));
  if (!o.report.empty())
    write_file(o.report,
               to_html(answer, fmt::format("Receptance of {}",
                                           std::filesystem::path(o.scene).stem().string())));
  fmt::print("{}", o.json ? to_json(answer).dump(2) + "\n" : to_table(answer));
}

void add_options(CLI::App& sub, ReceptanceOptions& o) {
  const CLI::Validator hz = within(1e-3, 1e5);
  const auto directions = CLI::IsMember({"z", "y"});
  sub.add_option("SCENE", o.scene, "scene file (TOML)")->required()->check(reads_file());
  sub.add_option("--at", o.at, "sensor where the force acts")->required();
  sub.add_option("--to", o.to, "sensor where the displacement is read (default: the same)");
  sub.add_option("--direction", o.direction, "of the force: z (default) or y")->check(directions);
  sub.add_option("--to-direction", o.to_direction, "of the displacement (default: the force's)")
      ->check(directions);
  sub.add_option("--from", o.from_hz, "first frequency, Hz")->required()->check(hz);
  sub.add_option("--to-hz", o.to_hz, "last frequency, Hz (default: the first, alone)")->check(hz);
  CLI::Option* points =
      sub.add_option("--points", o.points, "frequencies, logarithmic (default 200)")
          ->check(within(1, 100'000));
  sub.add_option("--step-hz", o.step, "equal steps instead, Hz")->check(hz)->excludes(points);
  sub.add_option("--model", o.model, "full (default) or condensed")
      ->check(CLI::IsMember({"full", "condensed"}));
  sub.add_option("--beside", o.beside,
                 "others beside it, with commas: full, condensed, euler, endless")
      ->delimiter(',')
      ->type_name("MODEL,MODEL")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"full", "condensed", "euler", "endless"}));
  sub.add_flag("--decay-rate", o.decay, "dB/m in one-third octaves along the rail (EN 15461)");
  sub.add_flag(
      "--reflection", o.reflection,
      "the part of waves that the far end reflects (ends = \"non-reflecting\" or \"free\")");
  sub.add_option("--csv", o.csv, "write the curves (CSV)")->check(writes_file());
  sub.add_option("--report", o.report, "write a page with plots (HTML)")->check(writes_file());
  add_overrides(sub, o.overrides);
  sub.add_flag("--json", o.json, "one JSON object on stdout");
  sub.footer(
      "Example: railstep receptance config/scenes/receptance_s1.toml --at mid_bay --from 30 "
      "--to-hz "
      "2000 --beside euler --decay-rate --report receptance.html");
}

}  // namespace

Command add_receptance(CLI::App& app) {
  auto o = std::make_shared<ReceptanceOptions>();
  o->direction = "z";
  o->to_hz = 0.;  // none was given
  o->points = 200;
  CLI::App* sub =
      app.add_subcommand("receptance", "Displacement per force of a track over frequency");
  add_options(*sub, *o);
  return {sub, [o] {
            run(*o);
            return Exit::done;
          }};
}

}  // namespace railstep
