#include "run/trace_compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "text/csv.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr std::size_t kLargestTrace = std::size_t{4} << 30;  // bytes

double trace_number(std::string_view field, const std::string& place) {
  double value = 0.;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size())
    throw InputError("E-CSV-02",
                     fmt::format("{}: '{}' is not a number; expected one such as 0.25 or 1e-3",
                                 place, field.substr(0, 40)));
  return value;
}

bool same_bits(double a, double b) {
  std::uint64_t bits_a = 0, bits_b = 0;
  std::memcpy(&bits_a, &a, sizeof bits_a);
  std::memcpy(&bits_b, &b, sizeof bits_b);
  return bits_a == bits_b;
}

/// Over the column's peak; infinite where it is not known.
double relative(double a, double b, double peak) {
  const double difference = std::abs(a - b);
  if (difference == 0.) return 0.;
  const double over = difference / peak;
  return std::isnan(over) ? std::numeric_limits<double>::infinity() : over;
}

std::vector<double> peaks_of(const TraceTable& table) {
  std::vector<double> peaks(table.columns.size(), 0.);
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    double& peak = peaks[i % peaks.size()];
    peak = std::max(peak, std::abs(table.values[i]));
  }
  return peaks;
}

/// From one row to the next, s; 0 where a table has no two times.
double step_of(const TraceTable& table) {
  if (table.columns.front() != "time_s" || table.rows() < 2) return 0.;
  return table.values[table.columns.size()] - table.values.front();
}

/// Rows of other times do not belong to each other.
void refuse_other_rows(const TraceTable& a, const TraceTable& b, const std::string& name_a,
                       const std::string& name_b) {
  const double step_a = step_of(a), step_b = step_of(b);
  if (std::abs(step_a - step_b) > 1e-9 * std::abs(step_a) && step_a != 0. && step_b != 0.)
    throw InputError("E-TRACE-01", fmt::format("{} has a row each {:.9g} s, and {} each {:.9g} s; "
                                               "expected traces with the same time between rows",
                                               name_a, step_a, name_b, step_b));
  if (a.rows() != b.rows())
    throw InputError(
        "E-TRACE-02",
        fmt::format("{} has {} rows, and {} has {}; expected traces with the same number of rows",
                    name_a, a.rows(), name_b, b.rows()));
}

}  // namespace

TraceTable TraceTable::read(const std::filesystem::path& file) {
  const std::string text = read_text(file, kLargestTrace);
  const std::vector<CsvLine> lines = csv_lines(text, file.string());
  if (lines.empty() || !is_column_name(lines.front().fields.front()))
    throw InputError(
        "E-TRACE-03",
        fmt::format("{}: this is not a trace; expected a file that `railstep run --trace` wrote",
                    file.string()));
  if (lines.size() < 2)
    throw InputError(
        "E-CSV-05",
        fmt::format(
            "{}: the file has no rows of values; expected a line of names and rows below it",
            file.string()));
  TraceTable table;
  table.columns.assign(lines.front().fields.begin(), lines.front().fields.end());
  table.values.reserve((lines.size() - 1) * table.columns.size());
  for (auto line = lines.begin() + 1; line != lines.end(); ++line) {
    if (line->fields.size() != table.columns.size())
      throw InputError(
          "E-CSV-04",
          fmt::format("{}: the row has {} values; expected {}, as many as the first line has names",
                      line->place, line->fields.size(), table.columns.size()));
    for (const std::string_view field : line->fields)
      table.values.push_back(trace_number(field, line->place));
  }
  return table;
}

TraceComparison compare(const TraceTable& a, const TraceTable& b, const std::string& name_a,
                        const std::string& name_b) {
  if (a.columns.size() != b.columns.size())
    throw InputError(
        "E-TRACE-04",
        fmt::format("{} has {} columns, and {} has {}; expected traces with the same columns",
                    name_a, a.columns.size(), name_b, b.columns.size()));
  for (std::size_t c = 0; c < a.columns.size(); ++c)
    if (a.columns[c] != b.columns[c])
      throw InputError(
          "E-TRACE-05",
          fmt::format("column {} is {} in {}, and {} in {}; expected traces with the same columns",
                      c, a.columns[c], name_a, b.columns[c], name_b));
  refuse_other_rows(a, b, name_a, name_b);
  TraceComparison result{true, std::nullopt, 0.};
  const std::vector<double> peaks = peaks_of(a);
  const std::size_t width = a.columns.size();
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (same_bits(a.values[i], b.values[i])) continue;
    if (!result.first)
      result.first = TraceDifference{i / width, a.columns[i % width], a.values[i], b.values[i]};
    result.identical = false;
    result.largest = std::max(result.largest, relative(a.values[i], b.values[i], peaks[i % width]));
  }
  return result;
}

}  // namespace railstep
