#include "scene/irregularity_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "text/csv.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr std::string_view kNames[] = {"vertical", "alignment", "cross_level", "gauge",
                                       "left_z",   "right_z",   "left_y",      "right_y"};
constexpr std::size_t kLargestRecord = std::size_t{64} << 20;           // bytes
constexpr std::size_t kOfRails = 4;                                     // the first of these
const Range kPlace = between(-1e9, 1e9), kHeight = between(-10., 10.);  // m
constexpr double kLeastStep = 1e-6;                                     // m
constexpr std::string_view kExpected =
    "distance_m with columns of the track (vertical, alignment, cross_level, gauge) or of the "
    "rails (left_z, right_z, left_y, right_y), each name ending in _m or _mm";

struct Column {
  std::size_t name;  // index into kNames; their number stands for the distance
  double metres;     // of its unit
};

Column column_of(std::string_view field, const CsvLine& line) {
  if (field.size() > 1 && field.front() == '"' && field.back() == '"')
    field = field.substr(1, field.size() - 2);
  if (field == "distance_m") return {std::size(kNames), 1.};
  for (const auto& [unit, metres] : {std::pair<std::string_view, double>{"_mm", 1e-3}, {"_m", 1.}})
    if (field.size() > unit.size() && field.substr(field.size() - unit.size()) == unit) {
      const auto* const name = std::find(std::begin(kNames), std::end(kNames),
                                         field.substr(0, field.size() - unit.size()));
      if (name != std::end(kNames))
        return {static_cast<std::size_t>(name - std::begin(kNames)), metres};
    }
  throw InputError("E-IRREGULARITY-12", fmt::format("{}: column '{}' is unknown; expected {}",
                                                    line.place, field.substr(0, 40), kExpected));
}

std::vector<Column> columns_of(const CsvLine& header) {
  std::vector<Column> columns;
  int distances = 0;
  std::size_t of_track = 0, of_rails = 0;
  for (const std::string_view field : header.fields) {
    const Column column = column_of(field, header);
    for (const Column& other : columns)
      if (other.name == column.name)
        throw InputError("E-IRREGULARITY-13",
                         fmt::format("{}: column '{}' is given twice; expected each column once",
                                     header.place, field));
    columns.push_back(column);
    if (column.name == std::size(kNames))
      ++distances;
    else
      ++(column.name < kOfRails ? of_track : of_rails);
  }
  if (distances == 0 || of_track + of_rails == 0)
    throw InputError(
        "E-IRREGULARITY-14",
        fmt::format("{}: '{}' lacks {}; expected {}", header.place, header.text.substr(0, 40),
                    distances == 0 ? "the column distance_m" : "a column of a geometry",
                    kExpected));
  if (of_track > 0 && of_rails > 0)
    throw InputError(
        "E-IRREGULARITY-15",
        fmt::format("{}: columns of the track and of its rails stand together; expected one "
                    "kind",
                    header.place));
  return columns;
}

/// A number in metres. Numbers beyond any rail are refused: they would overflow in a spline.
double metres_of(std::string_view field, const Column& column, const CsvLine& line) {
  const double value = column.metres * csv_number(field, line.place);
  const Range& accepted = column.name == std::size(kNames) ? kPlace : kHeight;
  if (accepted.holds(value)) return value;
  throw InputError("E-IRREGULARITY-16",
                   fmt::format("{}: {} = {:.9g} m is out of range; expected {} m", line.place,
                               column.name == std::size(kNames) ? "distance" : kNames[column.name],
                               value, accepted.text()));
}

/// Values of the columns, in their order; in metres.
std::vector<std::vector<double>> values_of(const std::vector<CsvLine>& lines,
                                           const std::vector<Column>& columns) {
  std::vector<std::vector<double>> values(columns.size());
  for (auto line = lines.begin() + 1; line != lines.end(); ++line) {
    refuse_decimal_comma(*line, columns.size());
    if (line->fields.size() != columns.size())
      throw InputError(
          "E-IRREGULARITY-17",
          fmt::format("{}: {} values, but the first line names {} columns; expected one value "
                      "for each column",
                      line->place, line->fields.size(), columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      values[c].push_back(metres_of(line->fields[c], columns[c], *line));
  }
  return values;
}

/// The first row whose step from the row before is not above 0, or differs from the median step by
/// more than `much` of it; 0 if there is none. So a missing row is found at its own place.
std::size_t first_off(const std::vector<double>& distance, double much) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < distance.size(); ++k) steps.push_back(distance[k] - distance[k - 1]);
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const auto off = std::find_if(steps.begin(), steps.end(), [&](double step) {
    return !(step > 0.) || !(std::fabs(step - *middle) <= much * *middle);
  });
  return off == steps.end() ? 0 : static_cast<std::size_t>(off - steps.begin()) + 1;
}

/// Checks that rows stand at equal distances. @returns the step
double step_of(const std::vector<double>& distance, const std::vector<CsvLine>& lines) {
  if (distance.size() < 4)
    throw InputError("E-IRREGULARITY-18",
                     fmt::format("{}: the file has {} rows of numbers; expected at least 4",
                                 lines.front().place, distance.size()));
  const double step =
      (distance.back() - distance.front()) / static_cast<double>(distance.size() - 1);
  constexpr double kMuch = 1e-3;
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const double wanted = distance.front() + step * static_cast<double>(k);
    if (step > 0. && std::fabs(distance[k] - wanted) <= kMuch * step) continue;
    const std::size_t one = first_off(distance, kMuch), off = one > 0 ? one : k;
    throw InputError(
        "E-IRREGULARITY-19",
        fmt::format("{}: distance {:.9g} m follows {:.9g} m, but the average step of all "
                    "rows is {:.6g} m; expected distances that rise by equal steps",
                    lines[off + 1].place, distance[off], distance[off - 1], step));
  }
  if (step < kLeastStep)
    throw InputError("E-IRREGULARITY-20",
                     fmt::format("{}: rows are {:.6g} m apart; expected at least {:g} m",
                                 lines[1].place, step, kLeastStep));
  return step;
}

}  // namespace

RailSignals read_irregularities(const std::filesystem::path& file) {
  const std::string text = read_text(file, kLargestRecord);
  const std::vector<CsvLine> lines = csv_lines(text, file.string());
  if (lines.empty())
    throw InputError("E-IRREGULARITY-21",
                     fmt::format("{}: the file is empty; expected {}", file.string(), kExpected));
  const std::vector<Column> columns = columns_of(lines.front());
  const std::vector<std::vector<double>> values = values_of(lines, columns);
  const auto distance = std::find_if(columns.begin(), columns.end(),
                                     [](const Column& c) { return c.name == std::size(kNames); });
  const std::vector<double>& places = values[static_cast<std::size_t>(distance - columns.begin())];
  const double step = step_of(places, lines);
  std::array<Signal, std::size(kNames)> of;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].name < std::size(kNames))
      of[columns[c].name] = fit_signal(values[c], places.front(), step, false);
  if (columns.end() != std::find_if(columns.begin(), columns.end(),
                                    [](const Column& c) { return c.name < kOfRails; }))
    return rails_of({of[0], of[1], of[2], of[3]});
  return {{of[6], of[7]}, {of[4], of[5]}};
}

}  // namespace railstep
