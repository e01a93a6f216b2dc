#include "profile.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "read.h"

namespace railstep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMillimetre = 1e-3;  // m

Published read_published(const Table& t) {
  const auto value = [&t](const char* key, double unit) {
    return unit * t.number(key, above(0.0), kNone);
  };
  const double mm = kMillimetre, mm2 = mm * mm, mm3 = mm2 * mm, mm4 = mm2 * mm2;
  return {.area = value("area_mm2", mm2),
          .centroid_height = value("centroid_height_mm", mm),
          .inertia_y = value("inertia_y_mm4", mm4),
          .inertia_z = value("inertia_z_mm4", mm4),
          .torsion = value("torsion_mm4", mm4),
          .shear_factor_y = value("shear_factor_y", 1.0),
          .shear_factor_z = value("shear_factor_z", 1.0),
          .section_modulus_head = value("section_modulus_head_mm3", mm3),
          .section_modulus_foot = value("section_modulus_foot_mm3", mm3),
          .height = value("height_mm", mm),
          .base_width = value("base_width_mm", mm),
          .head_width = value("head_width_mm", mm),
          .web_thickness = value("web_thickness_mm", mm),
          .head_depth = value("head_depth_mm", mm),
          .base_thickness = value("base_thickness_mm", mm)};
}

Published nothing_published() {
  return {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone,
          kNone, kNone, kNone, kNone, kNone, kNone, kNone};
}

/// What separates the values of a line, besides the comma.
bool is_blank(char c) { return c == ' ' || c == '\t' || c == ';'; }

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && (is_blank(line[i]) || line[i] == ',')) ++i;
    const std::size_t start = i;
    while (i < line.size() && !is_blank(line[i]) && line[i] != ',') ++i;
    if (i > start) fields.push_back(line.substr(start, i - start));
  }
  return fields;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "73,5;0", "73,5 0,0" or "73,5,0,0": a comma between digits, and more than two values.
bool has_decimal_comma(std::string_view line, std::size_t fields) {
  if (fields != 3 && fields != 4) return false;
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
    if (line[i] == ',' && is_digit(line[i - 1]) && is_digit(line[i + 1])) return true;
  return false;
}

bool is_column_name(std::string_view field) {
  const char c = field.front();
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '"';
  return letter && field.substr(0, 3) != "nan" && field.substr(0, 3) != "inf";
}

double number_in(std::string_view field, const std::string& place) {
  std::string_view digits = field;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = kNone;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value)))
    throw InputError(fmt::format("{}: '{}' is not a finite number", place, field));
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InputError(fmt::format("{}: '{}' is not a number; write two numbers a line", place,
                                 field.substr(0, 40)));
  return value;
}

std::vector<OutlineRow> rows_of(std::string_view text, const std::string& file, double metres) {
  std::vector<OutlineRow> rows;
  int number = 0;
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    std::string_view line = text.substr(0, end);
    const bool crlf = end != text.npos && text.substr(end, 2) == "\r\n";
    text.remove_prefix(end == text.npos ? text.size() : end + (crlf ? 2 : 1));
    ++number;
    const std::string place = fmt::format("{}:{}", file, number);
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.empty() || fields.front().front() == '#') continue;
    if (first && is_column_name(fields.front())) {
      first = false;
      continue;
    }
    first = false;
    if (has_decimal_comma(line, fields.size()))
      throw InputError(fmt::format("{}: '{}' seems to hold a decimal comma; write a decimal point",
                                   place, line.substr(0, 40)));
    if (fields.size() != 2)
      throw InputError(
          fmt::format("{}: {} values where two are wanted, y and z", place, fields.size()));
    rows.push_back({{metres * number_in(fields[0], place), metres * number_in(fields[1], place)},
                    0.0,
                    number});
  }
  return rows;
}

}  // namespace

Profile read_profile(const std::filesystem::path& file) {
  const Table root = read_toml(file);
  static_cast<void>(root.integer("schema", 1, 1));  // a newer one is refused
  Profile profile{root.string("name"), root.string("source"), {}, nothing_published()};
  const std::vector<double> values = root.rows("half_outline_mm", 3);
  if (const auto published = root.table_if("published"))
    profile.published = read_published(*published);
  root.finish();
  std::vector<OutlineRow> rows;
  for (std::size_t i = 0; i < values.size(); i += 3)
    rows.push_back({{kMillimetre * values[i], kMillimetre * values[i + 1]},
                    kMillimetre * values[i + 2],
                    static_cast<int>(i / 3 + 1)});
  try {
    profile.outline = mirrored_outline(rows);
  } catch (const std::invalid_argument& error) {
    root.refuse("half_outline_mm", error.what());
  }
  return profile;
}

Profile read_points(const std::filesystem::path& file, double metres) {
  const std::string content = read_text(file);
  std::string_view text = content;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const std::vector<OutlineRow> rows = rows_of(text, file.string(), metres);
  try {
    return {file.stem().string(), file.filename().string(), point_outline(rows),
            nothing_published()};
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace railstep
