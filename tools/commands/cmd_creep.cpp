#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "answer/creep_curves.h"
#include "commands/command.h"
#include "commands/options.h"
#include "report/creep_report.h"
#include "report/drawing.h"
#include "text/write.h"

namespace railstep {
namespace {

struct CreepOptions : CreepRequest {
  std::string law = "she", report;
  bool json = false;
};

Exit run_creep(const CreepOptions& o) {
  const NamedLaw law = creep_law_of(o.law);
  const CreepForce force = solve_creep(o, law);
  if (!o.report.empty()) {
    need_gnuplot();
    write_file(o.report, creep_page(o));
  }
  if (o.json)
    fmt::print("{}\n",
               nlohmann::ordered_json{{"fx", force.x}, {"fy", force.y}, {"law", law.name}}.dump(2));
  else
    fmt::print("{}: Fx {:.6f}, Fy {:.6f} of friction times normal force, on the wheel\n", law.name,
               force.x, force.y);
  return Exit::done;
}

}  // namespace

Command add_creep(CLI::App& app) {
  auto o = std::make_shared<CreepOptions>();
  CLI::App* sub = app.add_subcommand("creep", "Creep force of a patch under normalised creepages");
  sub->add_option("--ratio", o->ratio, "a/b, along the rail over across")
      ->required()
      ->check(within(0.05, 20.0));
  sub->add_option("--x", o->x, "4 G ab xi/(mu N), longitudinal (default 0)")
      ->check(within(-1e3, 1e3));
  sub->add_option("--e", o->e, "4 G ab eta/(mu N), lateral (default 0)")->check(within(-1e3, 1e3));
  sub->add_option("--p", o->p, "2 G (ab)^1.5 phi/(mu N), spin (default 0)")
      ->check(within(-1e3, 1e3));
  sub->add_option("--poisson", o->poisson, "Poisson's ratio (default 0.3)")
      ->check(within(0.25, 0.3));
  sub->add_option("--law", o->law, "she (default), fastsim:N, polach or linear");
  sub->add_option("--report", o->report, "write a page with the curves of all laws (HTML)")
      ->check(writes_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep creep --ratio 0.5 --x 1.5 --e 0 --p 0.3 --law fastsim:10");
  return {sub, [o] { return run_creep(*o); }};
}

}  // namespace railstep
