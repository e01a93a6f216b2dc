#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace railstep {

/// A trace, or another CSV file of a line of names and rows of numbers.
struct TraceTable {
  std::vector<std::string> columns;
  std::vector<double> values;  // row after row
  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  /// NaN, as a run that was lost writes it, and infinity are read too. Throws InputError, with the
  /// line, on anything else, and on a trace without rows.
  static TraceTable read(const std::filesystem::path& file);
};

struct TraceDifference {
  std::size_t row;  // from 0, without the line of names
  std::string column;
  double a, b;
};

struct TraceComparison {
  bool identical;  // every number has the same bits: -0 and 0 are apart, and NaN and -NaN
  std::optional<TraceDifference> first;
  double largest;  // of |a - b| over its column's largest |a|; infinite where one is NaN
};

/// Compares two traces with the same columns, time step and rows. Throws InputError, naming the
/// files, for others.
TraceComparison compare(const TraceTable& a, const TraceTable& b, const std::string& name_a,
                        const std::string& name_b);

}  // namespace railstep
