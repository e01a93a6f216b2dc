#include "study/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "text/read.h"

namespace railstep {
namespace {

struct KindNames {
  OutputKind kind;
  const char* name;
  std::vector<std::string> ends;  // of its columns
};
const std::vector<KindNames> kNames = {
    {OutputKind::deflection, "deflection", {".deflection_z_m", ".rail_z_m"}},
    {OutputKind::contact_force, "contact_force", {".force_z_mean_n", ".q_n"}},
    {OutputKind::lateral_force, "lateral_force", {".y_n"}},
    {OutputKind::sum_of_lateral_forces, "sum_of_lateral_forces", {".sum_y_n"}},
    {OutputKind::support_force, "support_force", {".force_z_n"}},
    {OutputKind::sensor, "sensor", {".dz_m"}},
    {OutputKind::stress, "stress", {".stress_x_pa"}}};

std::optional<OutputKind> kind_of(const std::string& column) {
  for (const KindNames& own : kNames)
    for (const std::string& end : own.ends)
      if (column.ends_with(end) &&
          (own.kind != OutputKind::support_force || column.starts_with("support_")))
        return own.kind;
  return std::nullopt;
}

std::size_t column_of(const TraceTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end())
    throw InputError(
        "E-STUDY-01",
        fmt::format("the reference has no column {}; expected a reference of the same scene",
                    name));
  return static_cast<std::size_t>(found - table.columns.begin());
}

/// Whether a column is among the outputs that count.
bool counts(const std::string& column, OutputKind kind, OutputKind first, const Judged& judged) {
  if (judged.outputs.empty()) return kind == first;
  return std::any_of(judged.outputs.begin(), judged.outputs.end(),
                     [&](const std::string& own) { return own == column || own == name_of(kind); });
}

/// The first row from a time on.
std::size_t row_at(const TraceTable& table, double time) {
  const std::size_t width = table.columns.size();
  std::size_t row = 0;
  while (row < table.rows() && table.values[row * width] < time) ++row;
  return row;
}

struct Difference {
  double largest = 0., rms = 0., peak = 0.;
};

/// The error of one column, from a row of each trace on.
Difference difference(const TraceTable& got, std::size_t column, std::size_t row,
                      const TraceTable& reference, std::size_t in_reference,
                      std::size_t reference_row) {
  Difference all;
  const std::size_t rows = reference.rows() - reference_row;
  for (std::size_t r = 0; r < rows; ++r) {
    const double want =
        reference.values[(reference_row + r) * reference.columns.size() + in_reference];
    const double found = got.values[(row + r) * got.columns.size() + column] - want;
    // A value that is not finite is not a small error.
    const double off = std::isfinite(found) ? found : std::numeric_limits<double>::infinity();
    all.largest = std::max(all.largest, std::abs(off));
    all.rms += off * off;
    all.peak = std::max(all.peak, std::abs(want));
  }
  all.rms = std::sqrt(all.rms / static_cast<double>(std::max<std::size_t>(rows, 1)));
  return all;
}

/// Throws where a list names what no column is.
void check_outputs(const TraceTable& got, const Judged& judged) {
  for (const std::string& own : judged.outputs) {
    bool found = false;
    for (const std::string& column : got.columns)
      if (const auto kind = kind_of(column))
        found = found || own == column || own == name_of(*kind);
    if (!found)
      throw InputError("E-STUDY-02",
                       fmt::format("output \"{}\" is not in the trace; expected deflection, "
                                   "contact_force, lateral_force, sum_of_lateral_forces, "
                                   "support_force, sensor, stress, or one of their columns, as far "
                                   "as the trace has them",
                                   own));
  }
}

TraceErrors lost(const TraceTable& reference) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  TraceErrors errors{kInfinite, {}};
  for (const KindNames& own : kNames)
    if (std::any_of(reference.columns.begin(), reference.columns.end(),
                    [&](const std::string& c) { return kind_of(c) == own.kind; }))
      errors.kinds.push_back({own.kind, kInfinite, kInfinite});
  return errors;
}

}  // namespace

const char* name_of(OutputKind kind) {
  for (const KindNames& own : kNames)
    if (own.kind == kind) return own.name;
  return "";
}

TraceTable compared(const std::vector<std::string>& columns, const RunRecord& record) {
  std::vector<std::size_t> taken = {0};
  for (std::size_t c = 1; c < columns.size(); ++c)
    if (kind_of(columns[c])) taken.push_back(c);
  TraceTable table;
  for (const std::size_t c : taken) table.columns.push_back(columns[c]);
  const std::size_t rows = record.rows.size() / columns.size();
  table.values.reserve(rows * taken.size());
  for (std::size_t r = 0; r < rows; ++r)
    for (const std::size_t c : taken) table.values.push_back(record.rows[r * columns.size() + c]);
  return table;
}

TraceErrors errors_of(const TraceTable& got, const TraceTable& reference, const Judged& judged) {
  check_outputs(got, judged);
  const double from = judged.from * (1. - 1e-9) - 1e-12;  // rounding of the rows' times
  const std::size_t row = row_at(got, from), reference_row = row_at(reference, from);
  if (reference_row >= reference.rows())
    throw InputError(
        "E-STUDY-03",
        fmt::format("the reference has no rows from {:g} s on; expected an earlier --from",
                    judged.from));
  if (got.rows() - row < reference.rows() - reference_row) return lost(reference);
  TraceErrors errors;
  for (const KindNames& own : kNames) {
    KindError worst{own.kind};
    bool any = false;
    for (std::size_t c = 1; c < got.columns.size(); ++c) {
      if (kind_of(got.columns[c]) != own.kind) continue;
      const Difference off =
          difference(got, c, row, reference, column_of(reference, got.columns[c]), reference_row);
      if (off.peak == 0.) continue;  // nothing to measure by
      any = true;
      worst.largest = std::max(worst.largest, off.largest / off.peak);
      worst.rms = std::max(worst.rms, off.rms / off.peak);
      const OutputKind first = errors.kinds.empty() ? own.kind : errors.kinds.front().kind;
      if (counts(got.columns[c], own.kind, first, judged))
        errors.judged = std::max(errors.judged, off.largest / off.peak);
    }
    if (any) errors.kinds.push_back(worst);
  }
  if (errors.kinds.empty())
    throw InputError("E-STUDY-04",
                     "the trace has nothing to compare; expected a scene with a load, a wheel, a "
                     "sensor or output.supports = true");
  return errors;
}

}  // namespace railstep
