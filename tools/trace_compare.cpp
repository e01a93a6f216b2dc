#include "trace_compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "csv.h"
#include "read.h"

namespace railstep {
namespace {

constexpr std::size_t kLargestTrace = std::size_t{4} << 30;  // bytes

double trace_number(std::string_view field, const std::string& place) {
  double value = 0.;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size())
    throw InputError(fmt::format("{}: '{}' is not a number", place, field.substr(0, 40)));
  return value;
}

bool same_bits(double a, double b) {
  std::uint64_t bits_a = 0, bits_b = 0;
  std::memcpy(&bits_a, &a, sizeof bits_a);
  std::memcpy(&bits_b, &b, sizeof bits_b);
  return bits_a == bits_b || (std::isnan(a) && std::isnan(b));
}

/// Over the column's peak; infinite for what cannot be told.
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

}  // namespace

TraceTable TraceTable::read(const std::filesystem::path& file) {
  const std::string text = read_text(file, kLargestTrace);
  const std::vector<CsvLine> lines = csv_lines(text, file.string());
  if (lines.empty() || !is_column_name(lines.front().fields.front()))
    throw InputError(fmt::format(
        "{}: is not a trace; accepted is what `railstep run --trace` wrote", file.string()));
  TraceTable table;
  table.columns.assign(lines.front().fields.begin(), lines.front().fields.end());
  table.values.reserve((lines.size() - 1) * table.columns.size());
  for (auto line = lines.begin() + 1; line != lines.end(); ++line) {
    if (line->fields.size() != table.columns.size())
      throw InputError(fmt::format("{}: {} values where the first line names {} columns",
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
        fmt::format("{} has {} columns and {} has {}; accepted are traces with the same columns",
                    name_a, a.columns.size(), name_b, b.columns.size()));
  for (std::size_t c = 0; c < a.columns.size(); ++c)
    if (a.columns[c] != b.columns[c])
      throw InputError(fmt::format(
          "column {} is {} in {} and {} in {}; accepted are traces with the same columns", c,
          a.columns[c], name_a, b.columns[c], name_b));
  TraceComparison result{true, std::nullopt, 0.};
  const std::vector<double> peaks = peaks_of(a);
  const std::size_t both = std::min(a.values.size(), b.values.size()), width = a.columns.size();
  const auto differ = [&](std::size_t i, std::optional<double> of_a, std::optional<double> of_b) {
    result.identical = false;
    if (!result.first) result.first = TraceDifference{i / width, a.columns[i % width], of_a, of_b};
  };
  for (std::size_t i = 0; i < both; ++i) {
    if (same_bits(a.values[i], b.values[i])) continue;
    differ(i, a.values[i], b.values[i]);
    result.largest = std::max(result.largest, relative(a.values[i], b.values[i], peaks[i % width]));
  }
  if (a.values.size() == b.values.size()) return result;
  const auto next = [both](const TraceTable& t) {
    return both < t.values.size() ? std::optional<double>(t.values[both]) : std::nullopt;
  };
  differ(both, next(a), next(b));
  result.largest = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace railstep
