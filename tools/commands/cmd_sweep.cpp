#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "commands/command.h"
#include "commands/options.h"
#include "sweep/sweep.h"
#include "text/remarks.h"

namespace railstep {
namespace {

struct SweepOptions {
  std::string scene, out, shard;
  std::vector<std::string> vary, overrides;
  double from = 0.;  // s
  int jobs = 0;      // 0: all cores
  bool merge = false, json = false;
};

int jobs_of(const SweepOptions& o) {
  if (o.jobs > 0) return o.jobs;
  const unsigned cores = std::thread::hardware_concurrency();  // 0: not known
  return cores == 0 ? 1 : static_cast<int>(cores);
}

void print(const SweepResult& result, const Remarks& remarks, bool json) {
  if (!json)
    return fmt::print("runs    {}, of which {} were made now\nfailed  {}\ntable   {}\n",
                      result.runs.size(), result.made, result.failed.size(), result.table.string());
  nlohmann::ordered_json told = {{"runs", result.runs.size()},
                                 {"failed", result.failed.size()},
                                 {"table", result.table.string()}};
  remarks.add_to(told);
  print_json(told);
}

Exit run(const SweepOptions& o) {
  const Shard shard = o.shard.empty() ? Shard{} : read_shard(o.shard);
  const Grid grid(o.overrides, o.vary);
  Sweep sweep({.scene = o.scene, .out = o.out, .grid = grid, .from = o.from, .jobs = jobs_of(o)});
  const SweepResult result = o.merge ? sweep.merge() : sweep.run(shard);
  Remarks remarks;
  if (!result.failed.empty())
    remarks.error(
        {"E-SWEEP-16", fmt::format("{} of {} runs failed, the first is run {} ({}): {}",
                                   result.failed.size(), result.runs.size(), result.failed.front(),
                                   grid.words(result.failed.front()), result.first_error)});
  print(result, remarks, o.json);
  remarks.print();
  return remarks.has_errors() ? Exit::not_reached : Exit::done;
}

}  // namespace

Command add_sweep(CLI::App& app) {
  auto o = std::make_shared<SweepOptions>();
  CLI::App* sub = app.add_subcommand("sweep", "Run a scene over a grid of its keys, on all cores");
  sub->add_option("SCENE", o->scene, "scene file (TOML)")->required()->check(reads_file());
  sub->add_option("--vary", o->vary,
                  "key.path=a,b,c: values of a key, as TOML; repeatable, all combinations are run")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  sub->add_option(
         "--out", o->out,
         "folder for a row per run and the table; runs whose rows it has are not made again")
      ->required()
      ->check(makes_folder());
  sub->add_option("--set", o->overrides, "key.path=value for all runs; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_option("--from", o->from, "sum traces up from this time on, s; leaves out the start")
      ->check(within(0., 1e7));
  CLI::Option* shard = sub->add_option(
      "--shard", o->shard,
      "I/N: every N-th run from the I-th on, I = 1 to N (0 is N); into a table of its own");
  sub->add_flag("--merge", o->merge, "run nothing: the table of all runs, whose rows must be there")
      ->excludes(shard);
  sub->add_option("--jobs", o->jobs, "runs at once; all cores by default")->check(within(1, 1024));
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Table and rows are the same whatever the jobs, shards and interruptions. Exit code 1 where\n"
      "runs failed; their rows say why. docs/sweep.md\n\n"
      "Example, stiffness by speed:\n"
      "  railstep sweep config/scenes/moving_load.toml --vary support.stiffness_z_n_per_m=2e7,5e7 "
      "\\\n"
      "    --vary 'step.scheme=\"generalised-alpha\",\"backward-euler\"' --out stiffness\n"
      "Example, Monte Carlo over 100 rough rails:\n"
      "  railstep sweep config/scenes/open_track.toml --vary irregularity.seed=$(seq -s, 100) \\\n"
      "    --from 0.1 --out rough");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
