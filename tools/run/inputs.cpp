#include "run/inputs.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "text/csv.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr std::size_t kTime = static_cast<std::size_t>(-1);
constexpr std::size_t kLargestTable = std::size_t{256} << 20;  // bytes

/// The input of each column; kTime for the times.
std::vector<std::size_t> columns_of(const CsvLine& header, const std::vector<std::string>& names) {
  std::vector<std::size_t> columns;
  for (const std::string_view field : header.fields) {
    const auto found = std::find(names.begin(), names.end(), field);
    if (field != "time_s" && found == names.end())
      throw InputError("E-INPUTS-01",
                       fmt::format("{}: column '{}' is not an input; expected time_s and {}",
                                   header.place, field.substr(0, 64), fmt::join(names, ", ")));
    const std::size_t column =
        field == "time_s" ? kTime : static_cast<std::size_t>(found - names.begin());
    if (std::find(columns.begin(), columns.end(), column) != columns.end())
      throw InputError("E-INPUTS-02", fmt::format("{}: column '{}' is given twice; expected once",
                                                  header.place, field.substr(0, 64)));
    columns.push_back(column);
  }
  if (columns.size() < 2 || columns.front() != kTime)
    throw InputError(
        "E-INPUTS-03",
        fmt::format(
            "{}: the first line is '{}'; expected time_s, then one or more of the inputs {}",
            header.place, header.text.substr(0, 64), fmt::join(names, ", ")));
  return columns;
}

/// The first frame that begins at a time or later.
std::int64_t frame_from(const CsvLine& line, double time, double frame_s) {
  constexpr double kMostFrames = 1e15;
  const double frames = std::ceil(time / frame_s - 1e-6);
  if (!(time >= 0.))
    throw InputError("E-INPUTS-04",
                     fmt::format("{}: time_s = {:g}; expected a time from 0 on", line.place, time));
  if (!(frames < kMostFrames))
    throw InputError(
        "E-INPUTS-05",
        fmt::format("{}: time_s = {:g}; expected a time below {:g} s, which is {:g} frames",
                    line.place, time, kMostFrames * frame_s, kMostFrames));
  return static_cast<std::int64_t>(std::max(frames, 0.));
}

}  // namespace

InputTable::InputTable(const std::filesystem::path& file, const std::vector<std::string>& names,
                       double frame_s)
    : width_(names.size()), first_{0}, value_(names.size(), 0.) {
  if (names.empty())
    throw InputError("E-INPUTS-06",
                     fmt::format("{}: the scene has no inputs; expected a force with the key input",
                                 file.string()));
  const std::string text = read_text(file, kLargestTable);
  const std::vector<CsvLine> lines = csv_lines(text, file.string());
  if (lines.size() < 2)
    throw InputError(
        "E-CSV-05",
        fmt::format(
            "{}: the file has no rows of values; expected a line of names and rows below it",
            file.string()));
  const std::vector<std::size_t> columns = columns_of(lines.front(), names);
  double last = -std::numeric_limits<double>::infinity();
  for (auto line = lines.begin() + 1; line != lines.end(); ++line) {
    refuse_decimal_comma(*line, columns.size());
    if (line->fields.size() != columns.size())
      throw InputError(
          "E-CSV-04",
          fmt::format("{}: the row has {} values; expected {}, as many as the first line has names",
                      line->place, line->fields.size(), columns.size()));
    const double time = csv_number(line->fields.front(), line->place);
    if (!(time > last))
      throw InputError("E-INPUTS-09",
                       fmt::format("{}: time_s = {:g} follows {:g}; expected rising times",
                                   line->place, time, last));
    last = time;
    first_.push_back(frame_from(*line, time, frame_s));
    value_.resize(value_.size() + width_, 0.);
    for (std::size_t c = 1; c < columns.size(); ++c)
      value_[value_.size() - width_ + columns[c]] = csv_number(line->fields[c], line->place);
  }
}

const double* InputTable::at(std::int64_t frame) const {
  const auto after = std::upper_bound(first_.begin(), first_.end(), frame);
  const auto row = static_cast<std::size_t>(after - first_.begin()) - 1;
  return value_.data() + row * width_;
}

}  // namespace railstep
