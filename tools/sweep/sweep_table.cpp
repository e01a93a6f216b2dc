#include "sweep/sweep_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <map>
#include <string_view>

namespace railstep {
namespace {

constexpr const char* kMet[] = {"error",
                                "status",
                                "steps",
                                "state_hash",
                                "max_iterations",
                                "max_constraint_violation",
                                "energy_balance_error",
                                "numerical_loss"};
constexpr const char* kOfColumn[] = {"min", "max", "mean", "std", "last"};

void end_cell(std::string& text) { text += ','; }
void end_line(std::string& text) { text.back() = '\n'; }

/// In quotes where a comma, a quote or a line's end would part it (RFC 4180).
void add_text(std::string_view cell, std::string& text) {
  if (cell.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += cell;
  } else {
    text += '"';
    for (const char c : cell) text.append(c == '"' ? 2 : 1, c);
    text += '"';
  }
  end_cell(text);
}

void add_number(double value, std::string& text) {
  if (std::isnan(value))
    text += "nan";  // without a sign, which says nothing
  else
    fmt::format_to(std::back_inserter(text), "{:.17g}", value);
  end_cell(text);
}

void add_met(const SweepRow& row, std::string& text) {
  add_text(row.error, text);
  add_text(fmt::format("{}", fmt::join(row.status, " ")), text);
  fmt::format_to(std::back_inserter(text), "{},", row.steps);
  if (!row.error.empty()) return static_cast<void>(text.append(std::size(kMet) - 3, ','));
  fmt::format_to(std::back_inserter(text), "{},{},", row.state_hash, row.iterations);
  for (const double value :
       {row.constraint_violation, row.energy_balance_error, row.numerical_loss})
    add_number(value, text);
}

using Places = std::map<std::string, std::size_t, std::less<>>;

void add_columns(const SweepRow& row, const Places& places, std::string& text) {
  std::vector<const ColumnSummary*> own(places.size(), nullptr);
  for (const ColumnSummary& column : row.columns) own[places.find(column.name)->second] = &column;
  for (const ColumnSummary* column : own) {
    if (column == nullptr) {
      text.append(std::size(kOfColumn), ',');
      continue;
    }
    for (const double value :
         {column->least, column->most, column->mean, column->deviation, column->last})
      add_number(value, text);
  }
}

}  // namespace

std::string sweep_table(const Grid& grid, const std::vector<std::int64_t>& runs,
                        const std::function<SweepRow(std::int64_t)>& row) {
  Places places;
  std::vector<std::string> names;
  for (const std::int64_t run : runs)
    for (const ColumnSummary& column : row(run).columns)
      if (places.emplace(column.name, names.size()).second) names.push_back(column.name);

  std::string text = "index,";
  for (const VariedKey& varied : grid.varied()) add_text(varied.key, text);
  for (const char* name : kMet) add_text(name, text);
  for (const std::string& name : names)
    for (const char* of : kOfColumn) add_text(fmt::format("{}.{}", name, of), text);
  end_line(text);
  for (const std::int64_t run : runs) {
    fmt::format_to(std::back_inserter(text), "{},", run);
    for (const std::string& value : grid.values(run)) add_text(value, text);
    const SweepRow own = row(run);
    add_met(own, text);
    add_columns(own, places, text);
    end_line(text);
  }
  return text;
}

}  // namespace railstep
