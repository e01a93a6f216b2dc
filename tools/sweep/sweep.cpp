#include "sweep/sweep.h"

#include <fmt/core.h>

#include <mutex>
#include <optional>
#include <utility>

#include "offline/math/refuse.h"
#include "run/in_parallel.h"
#include "run/simulation.h"
#include "sweep/sweep_run.h"
#include "sweep/sweep_table.h"
#include "text/files.h"
#include "text/progress_bar.h"
#include "text/read.h"
#include "text/write.h"

namespace railstep {
namespace {

std::vector<std::int64_t> all_of(const Grid& grid) { return Shard{}.runs(grid.runs()); }

/// A bar that several threads move.
class SharedProgress {
 public:
  explicit SharedProgress(std::size_t all) : bar_(static_cast<std::int64_t>(all)) {}
  void one_done() {
    const std::lock_guard<std::mutex> hold(lock_);
    bar_(++done_);
  }

 private:
  std::mutex lock_;
  std::int64_t done_ = 0;
  Progress bar_;
};

/// Names a varied key by --vary in the error of a scene, and says which run met the error.
[[noreturn]] void refuse_run(const InputError& error, const Grid& grid, std::int64_t run) {
  const std::vector<std::string> values = grid.values(run);
  std::vector<Message> messages = error.messages();
  for (Message& message : messages)
    for (std::size_t k = 0; k < values.size(); ++k)
      if (message.text.starts_with(fmt::format("--set {}={}:", grid.varied()[k].key, values[k])))
        message.text.replace(0, 5, "--vary");
  throw InputError(std::move(messages)).met(fmt::format("run {}: {}", run, grid.words(run)));
}

}  // namespace

Sweep::Sweep(SweepPlan plan)
    : plan_(std::move(plan)), keys_(program_identity(), plan_.from), rows_(plan_.out) {
  if (is_artefact(plan_.scene))
    throw InputError(
        "E-SWEEP-02",
        fmt::format("{}: this is a model, whose keys cannot be varied; expected a scene",
                    plan_.scene.string()));
  key_.resize(static_cast<std::size_t>(plan_.grid.runs()));
  SharedProgress bar(key_.size());
  in_parallel(plan_.grid.runs(), plan_.jobs, [&](std::int64_t run) {
    key_[static_cast<std::size_t>(run)] = key_of(run);
    bar.one_done();
  });
}

std::string Sweep::key_of(std::int64_t run) try {
  const AnyScene scene = read_any_scene(plan_.scene, plan_.grid.overrides(run));
  const StepScene& step = stepped(scene);
  const double duration = static_cast<double>(step.steps) * step.dt;
  if (plan_.from > duration + 1e-6 * step.dt)  // rounding
    throw InputError(
        "E-SWEEP-03",
        fmt::format("--from {:g} s is after the end of the run; expected at most {:g} s",
                    plan_.from, duration));
  return keys_.of(plan_.scene, plan_.grid.overrides(run));
} catch (const InputError& error) {
  refuse_run(error, plan_.grid, run);
}

void Sweep::make(std::int64_t run) {
  const std::string& key = key_[static_cast<std::size_t>(run)];
  const AnyScene scene = read_any_scene(plan_.scene, plan_.grid.overrides(run));
  if (keys_.of(plan_.scene, plan_.grid.overrides(run)) != key)
    throw InputError(
        "E-SWEEP-04",
        fmt::format(
            "{}: a file of the scene changed while its runs were made; begin the sweep again",
            plan_.scene.string()));
  rows_.write(key,
              fmt::format("{} with {}, by railstep {}", plan_.scene.filename().string(),
                          plan_.grid.words(run), keys_.program()),
              row_of_run(scene, plan_.from));
}

std::vector<std::int64_t> Sweep::without_row(const std::vector<std::int64_t>& runs) const {
  std::vector<std::int64_t> missing;
  for (const std::int64_t run : runs)
    if (!rows_.find(key_[static_cast<std::size_t>(run)])) missing.push_back(run);
  return missing;
}

SweepResult Sweep::finish(const std::vector<std::int64_t>& runs, const std::string& table) const {
  SweepResult result{.runs = runs, .failed = {}, .first_error = {}, .table = plan_.out / table};
  const auto row = [&](std::int64_t run) {
    std::optional<SweepRow> found = rows_.find(key_[static_cast<std::size_t>(run)]);
    if (!found)
      fail("E-SWEEP-05", fmt::format("{}: the row of run {} was removed while the sweep ran",
                                     plan_.out.string(), run));
    return std::move(*found);
  };
  for (const std::int64_t run : runs) {
    const SweepRow own = row(run);
    if (own.error.empty()) continue;
    if (result.failed.empty()) result.first_error = own.error;
    result.failed.push_back(run);
  }
  write_file(result.table, sweep_table(plan_.grid, runs, row));
  return result;
}

SweepResult Sweep::run(const Shard& shard) {
  const std::vector<std::int64_t> runs = shard.runs(plan_.grid.runs());
  const std::string table =
      shard.whole() ? "table.csv" : fmt::format("table_{}_of_{}.csv", shard.number, shard.of);
  refuse_read_file(plan_.out / table);
  rows_.create();
  const std::vector<std::int64_t> missing = without_row(runs);
  {
    SharedProgress bar(missing.size());
    in_parallel(static_cast<std::int64_t>(missing.size()), plan_.jobs, [&](std::int64_t n) {
      make(missing[static_cast<std::size_t>(n)]);
      bar.one_done();
    });
  }
  SweepResult result = finish(runs, table);
  result.made = static_cast<std::int64_t>(missing.size());
  return result;
}

SweepResult Sweep::merge() {
  const std::vector<std::int64_t> runs = all_of(plan_.grid);
  const std::vector<std::int64_t> missing = without_row(runs);
  if (!missing.empty())
    throw InputError(
        "E-SWEEP-06",
        fmt::format(
            "--merge: {} of {} runs have no row of this scene and program in {}, the first is run "
            "{} ({}); make them with --shard, or make all that are missing without --merge",
            missing.size(), runs.size(), plan_.out.string(), missing.front(),
            plan_.grid.words(missing.front())));
  return finish(runs, "table.csv");
}

}  // namespace railstep
