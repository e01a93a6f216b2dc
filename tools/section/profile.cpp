#include "section/profile.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "text/csv.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

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

std::vector<OutlineRow> rows_of(const std::string& text, const std::string& file, double metres) {
  std::vector<OutlineRow> rows;
  bool first = true;
  for (const CsvLine& line : csv_lines(text, file)) {
    const bool header = first && is_column_name(line.fields.front());
    first = false;
    if (header) continue;
    refuse_decimal_comma(line, 2);
    if (line.fields.size() != 2)
      throw InputError("E-PROFILE-01",
                       fmt::format("{}: the row has {} values; expected two, y and z", line.place,
                                   line.fields.size()));
    rows.push_back({{metres * csv_number(line.fields[0], line.place),
                     metres * csv_number(line.fields[1], line.place)},
                    0.0,
                    line.number});
  }
  return rows;
}

/// Lines of numbers, where a TOML file has keys.
bool is_points(const std::string& text, const std::string& file) {
  const std::vector<CsvLine> lines = csv_lines(text, file);
  const auto is_number = [](const CsvLine& line) {
    return std::string_view("0123456789+-.").find(line.fields.front().front()) !=
           std::string_view::npos;
  };
  return text.find('=') == std::string::npos && std::any_of(lines.begin(), lines.end(), is_number);
}

}  // namespace

Table read_shape_file(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  if (is_points(text, file.string()))
    throw InputError("E-PROFILE-02",
                     fmt::format("{0}: this is a list of points; expected a profile (TOML), or a "
                                 "section that `railstep fit {0} --unit mm --out FILE` writes",
                                 file.string()));
  return read_toml_text(text, file);
}

Profile read_profile(const std::filesystem::path& file) {
  const Table root = read_shape_file(file);
  static_cast<void>(root.integer("schema", 1, 1));  // a newer one is refused
  if (!root.has("half_outline_mm") && root.has("section"))
    root.refuse("section", "E-PROFILE-03",
                "the file holds a section, as `railstep fit --out` writes it; expected it under "
                "the key section, and a profile under the key profile");
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
  } catch (const Refused& error) {
    root.refuse("half_outline_mm", error.id(), error.sentence());
  }
  return profile;
}

Profile read_points(const std::filesystem::path& file, double metres) {
  const std::vector<OutlineRow> rows = rows_of(read_text(file), file.string(), metres);
  try {
    return {file.stem().string(), file.filename().string(), point_outline(rows),
            nothing_published()};
  } catch (const Refused& error) {
    throw InputError(file.string(), error);
  }
}

}  // namespace railstep
