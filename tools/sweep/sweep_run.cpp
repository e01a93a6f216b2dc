#include "sweep/sweep_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "build/build_unstepped.h"
#include "offline/math/larger.h"
#include "run/run_energy.h"
#include "run/simulate.h"

namespace railstep {
namespace {

/// Sums up columns row by row, so that a long run takes no memory: mean and sum of squares about it
/// after Welford (1962).
class Summary {
 public:
  explicit Summary(const std::vector<std::string>& names) {
    columns_.reserve(names.size());
    constexpr double kNone = std::numeric_limits<double>::infinity();
    for (const std::string& name : names) columns_.push_back({name, kNone, -kNone, 0., 0., 0.});
  }

  void add(std::span<const double> row) {
    ++rows_;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      ColumnSummary& column = columns_[c];
      const double value = row[c], above = value - column.mean;
      column.least = -larger(-column.least, -value);
      column.most = larger(column.most, value);
      column.mean += above / static_cast<double>(rows_);
      column.deviation += above * (value - column.mean);
      column.last = value;
    }
  }

  /// For all columns but the first, the time.
  std::vector<ColumnSummary> columns() const {
    std::vector<ColumnSummary> all(columns_.begin() + 1, columns_.end());
    for (ColumnSummary& column : all)
      column.deviation = std::sqrt(column.deviation / static_cast<double>(rows_));
    return all;
  }

 private:
  std::int64_t rows_ = 0;
  std::vector<ColumnSummary> columns_;  // deviation: the sum of squares so far
};

SweepRow run_scene(const AnyScene& scene, double from) {
  const auto run = simulation_of(scene);
  const Model& model = run->model();
  const std::int64_t frames = model.steps / model.steps_per_frame;
  const double from_here = from - 1e-6 * model.scheme.dt * model.steps_per_frame;  // rounding
  Summary summary(run->columns());
  const RowSink sink = [&](std::span<const double> row) {
    if (row[0] >= from_here) summary.add(row);
  };
  const RunRecord record = simulate(*run, frames, sink, false);
  SweepRow made;
  made.status = status_names(record.status);
  made.steps = run->state.steps;
  if (record.first_bad_unknown >= 0) {
    made.error = nonfinite_sentence(*run, record.first_bad_unknown);
    return made;
  }
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::optional<EnergyBalance> energy = balance_of_run(*run, record, frames);
  made.state_hash = fmt::format("{:016x}", state_hash(model, run->state));
  made.iterations = record.iterations;
  made.constraint_violation = record.constraint_violation;
  made.energy_balance_error = energy ? energy->error : unknown;
  made.numerical_loss = energy ? energy->numerical_loss : unknown;
  made.columns = summary.columns();
  return made;
}

/// Without the scene's folder: a table has the same bytes wherever its scene stands.
std::string without_folder(std::string text, const std::filesystem::path& scene) {
  if (!scene.has_parent_path()) return text;
  const std::string folder = scene.parent_path().string() + "/";
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
    text.erase(at, folder.size());
  return text;
}

}  // namespace

const StepScene& stepped(const AnyScene& scene) {
  if (const auto* system = std::get_if<SystemScene>(&scene)) return system->step;
  const Scene& track = std::get<Scene>(scene);
  refuse_unstepped(track);
  return *track.step;
}

SweepRow row_of_run(const AnyScene& scene, double from) try {
  return run_scene(scene, from);
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  SweepRow failed;
  failed.error =
      without_folder(error.what(), std::visit([](const auto& kind) { return kind.file; }, scene));
  return failed;
}

}  // namespace railstep
