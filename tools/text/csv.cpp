#include "text/csv.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "text/read.h"

namespace railstep {
namespace {

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ';' || c == ','; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && is_separator(line[i])) ++i;
    const std::size_t start = i;
    while (i < line.size() && !is_separator(line[i])) ++i;
    if (i > start) fields.push_back(line.substr(start, i - start));
  }
  return fields;
}

}  // namespace

std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  std::vector<CsvLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    const bool crlf = end != text.npos && text.substr(end, 2) == "\r\n";
    text.remove_prefix(end == text.npos ? text.size() : end + (crlf ? 2 : 1));
    std::vector<std::string_view> fields = fields_of(line);
    if (fields.empty() || fields.front().front() == '#') continue;
    lines.push_back({number, fmt::format("{}:{}", file, number), line, std::move(fields)});
  }
  return lines;
}

bool is_column_name(std::string_view field) {
  const char c = field.front();
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '"';
  return letter && field.substr(0, 3) != "nan" && field.substr(0, 3) != "inf";
}

double csv_number(std::string_view field, const std::string& place) {
  std::string_view digits = field;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = 0.;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value)))
    throw InputError(
        "E-CSV-01",
        fmt::format("{}: '{}' is not a finite number; expected a number such as 0.25 or 1e-3",
                    place, field.substr(0, 40)));
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InputError("E-CSV-02",
                     fmt::format("{}: '{}' is not a number; expected one such as 0.25 or 1e-3",
                                 place, field.substr(0, 40)));
  return value + 0.;  // -0.0 is 0.0
}

void refuse_decimal_comma(const CsvLine& line, std::size_t wanted) {
  if (line.fields.size() <= wanted || line.fields.size() > 2 * wanted) return;
  const std::string_view text = line.text;
  for (std::size_t i = 1; i + 1 < text.size(); ++i)
    if (text[i] == ',' && is_digit(text[i - 1]) && is_digit(text[i + 1]))
      throw InputError(
          "E-CSV-03",
          fmt::format("{}: '{}' seems to hold a decimal comma; expected a decimal point",
                      line.place, text.substr(0, 40)));
}

}  // namespace railstep
