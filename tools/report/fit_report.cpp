#include "report/fit_report.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "text/message_json.h"

namespace railstep {
namespace {

/// One property of outline and section, as printed: scaled to the unit engineers use.
struct Row {
  const char* label;
  const char* key;  // of the JSON and TOML
  double outline, section, scale;
};

std::array<Row, 9> rows_of(const FitResult& r) {
  const Section &o = r.outline, &s = r.section;
  return {{
      {"area, mm2", "area_m2", o.area.area, s.area.area, 1e6},
      {"height, mm", "height_m", o.height, s.height, 1e3},
      {"centroid height, mm", "centroid_height_m", o.area.centroid_height, s.area.centroid_height,
       1e3},
      {"Iy, 1e6 mm4", "inertia_y_m4", o.area.inertia_y, s.area.inertia_y, 1e6},
      {"Iz, 1e6 mm4", "inertia_z_m4", o.area.inertia_z, s.area.inertia_z, 1e6},
      {"J, 1e6 mm4", "torsion_m4", o.shear.torsion, s.shear.torsion, 1e6},
      {"shear factor y", "shear_factor_y", o.shear.shear_factor_y, s.shear.shear_factor_y, 1.0},
      {"shear factor z", "shear_factor_z", o.shear.shear_factor_z, s.shear.shear_factor_z, 1.0},
      {"shear centre height, mm", "shear_centre_height_m", o.shear.shear_centre_height,
       s.shear.shear_centre_height, 1e3},
  }};
}

struct Dimension {
  const char* label;
  const char* key;
  double metres;
};

std::array<Dimension, 6> dimensions_of(const Rectangles<double>& r) {
  return {{{"foot width", "foot_width_m", r.width[0]},
           {"foot height", "foot_height_m", r.height[0]},
           {"web width", "web_width_m", r.width[1]},
           {"web height", "web_height_m", r.height[1]},
           {"head width", "head_width_m", r.width[2]},
           {"head height", "head_height_m", r.height[2]}}};
}

struct Error {
  const char* key;
  double value;
};

std::array<Error, 4> errors_of(const RelativeErrors& e) {
  return {{{"area", e.area},
           {"inertia_y", e.inertia_y},
           {"inertia_z", e.inertia_z},
           {"centroid_height", e.centroid_height}}};
}

/// Properties that only a lopsided outline has; empty for others.
std::vector<Row> lopsided_rows(const FitResult& r) {
  const Lopsided& l = r.lopsided;
  if (!(l.share >= 1e-6)) return {};
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {
      {"outline and mirror image", "share_of_area", l.share, none, 1.0},
      {"Iyz, 1e6 mm4", "product_of_inertia_m4", l.product_of_inertia, none, 1e6},
      {"principal axis, degrees", "principal_angle_rad",
       principal_angle(r.outline.area, l.product_of_inertia), none, 180.0 / std::numbers::pi},
      {"centroid beside foot, mm", "centroid_offset_m", l.centroid_offset, none, 1e3},
      {"shear centre beside, mm", "shear_centre_offset_m", l.shear_centre_offset, none, 1e3},
  };
}

/// All that is compared, and what the outline has alone.
std::vector<Row> all_rows(const FitResult& r) {
  const auto rows = rows_of(r);
  std::vector<Row> all(rows.begin(), rows.end());
  for (const Row& row : lopsided_rows(r)) all.push_back(row);
  return all;
}

std::string number(const Row& row, double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", row.scale * value) : "-";
}

std::string difference(const Row& row) {
  const double relative = row.section / row.outline - 1.0;
  return std::isfinite(relative) ? fmt::format("{:+.2e}", relative) : "-";
}

std::string area_of(double difference) {
  return std::isfinite(difference) ? fmt::format("{:.2f} mm2", 1e6 * difference) : "not defined";
}

/// A basic TOML string; control characters are dropped.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) out += c;
  }
  return out + '"';
}

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// z points down in SVG: heights are counted from the top.
std::string svg_path(const std::vector<Point>& points, double height) {
  std::string path = "M";
  for (const Point& p : points)
    path += fmt::format("{:.3f},{:.3f} ", 1e3 * p[0], 1e3 * (height - p[1]));
  return path + "Z";
}

std::string drawing(const FitResult& r) {
  const double height = 1e3 * r.section.height;
  const std::vector<Point> rectangles = polygon(r.fit.section);
  double half = 0.0;
  for (const Point& p : rectangles) half = std::max(half, 1e3 * std::abs(p[0]));
  std::string outline;
  if (r.profile) {
    const std::vector<Point> points = polygon(r.profile->outline, 1e-5);
    for (const Point& p : points) half = std::max(half, 1e3 * std::abs(p[0]));
    outline =
        fmt::format("<path class=\"outline\" d=\"{}\"/>\n", svg_path(points, r.section.height));
  }
  return fmt::format(
      "<svg viewBox=\"{:.1f} -5 {:.1f} {:.1f}\" width=\"480\" role=\"img\" aria-label=\"outline "
      "and "
      "rectangles\">\n{}<path class=\"rectangles\" d=\"{}\"/>\n</svg>\n",
      -half - 5.0, 2.0 * half + 10.0, height + 10.0, outline,
      svg_path(rectangles, r.section.height));
}

constexpr const char* kStyle =
    "body{font:16px/1.4 sans-serif;margin:2em;max-width:60em}table{border-collapse:collapse}"
    "td,th{padding:.2em .8em;text-align:right;border-bottom:1px solid #ccc}"
    "td:first-child,th:first-child{text-align:left}"
    ".outline{fill:#cdd5dd;stroke:#345;stroke-width:.5}"
    ".rectangles{fill:none;stroke:#c30;stroke-width:.7}";

}  // namespace

nlohmann::ordered_json to_json(const FitResult& r) {
  nlohmann::ordered_json json;
  for (const Row& row : rows_of(r)) json["outline"][row.key] = row.outline;
  for (const Row& row : lopsided_rows(r)) json["asymmetry"][row.key] = row.outline;
  json["warnings"] = to_json(r.warnings);
  if (r.refusal) {
    json["section"] = nullptr;
    json["refusal"] = to_json(*r.refusal);
    return json;
  }
  for (const Row& row : rows_of(r)) json["section"][row.key] = row.section;
  for (const Dimension& d : dimensions_of(r.fit.section)) json["dimensions"][d.key] = d.metres;
  for (const Error& e : errors_of(r.fit.errors)) json["relative_errors"][e.key] = e.value;
  json["symmetric_difference_m2"] = r.fit.symmetric_difference;
  const std::array<double, 4>& s = r.fit.sensitivity;
  json["solver"] = {
      {"name", "Ceres"},
      {"iterations", r.fit.iterations},
      {"exact_sections_compared", r.fit.family_points},
      {"stationarity_m", r.fit.stationarity},
      {"outline_asymmetry", r.lopsided.share},
      {"sensitivity_m",
       {{"foot_width", s[0]}, {"foot_height", s[1]}, {"web_width", s[2]}, {"head_height", s[3]}}}};
  return json;
}

std::string to_table(const FitResult& r) {
  if (r.refusal) {
    std::string text = fmt::format("{}\n{:<26}{:>14}\n", r.name, "", "outline");
    for (const Row& row : all_rows(r))
      text += fmt::format("{:<26}{:>14}\n", row.label, number(row, row.outline));
    return text;
  }
  std::string text = fmt::format("{}\n{:<26}{:>14}{:>14}{:>12}\n", r.name, "",
                                 r.profile ? "outline" : "target", "section", "difference");
  for (const Row& row : all_rows(r))
    text += fmt::format("{:<26}{:>14}{:>14}{:>12}\n", row.label, number(row, row.outline),
                        number(row, row.section), difference(row));
  for (const Dimension& d : dimensions_of(r.fit.section))
    text += fmt::format("{:<26}{:>28.4f}\n", fmt::format("{}, mm", d.label), 1e3 * d.metres);
  return text + fmt::format("symmetric difference: {}\n", area_of(r.fit.symmetric_difference));
}

std::string to_toml(const FitResult& r) {
  std::string text = fmt::format(
      "# Three rectangles, written by railstep fit.\nschema = 1\nname = {}\nsource = {}\n",
      quoted(r.name), quoted(r.source));
  if (std::isfinite(r.fit.symmetric_difference))
    text += fmt::format("symmetric_difference_m2 = {:.17g}\n", r.fit.symmetric_difference);
  // An exponent or a point in every number, so that TOML does not read it as an integer.
  const auto put = [&text](const char* key, double value) {
    if (std::isfinite(value)) text += fmt::format("{} = {:.16e}\n", key, value);
  };
  text += "\n[section]\n";
  for (const Row& row : rows_of(r)) put(row.key, row.section);
  text += r.profile ? "\n[outline]\n" : "\n[target]\n";
  for (const Row& row : rows_of(r)) put(row.key, row.outline);
  const std::vector<Row> lopsided = lopsided_rows(r);
  if (!lopsided.empty()) text += "\n[asymmetry]\n";
  for (const Row& row : lopsided) put(row.key, row.outline);
  text += "\n[dimensions]\n";
  for (const Dimension& d : dimensions_of(r.fit.section)) put(d.key, d.metres);
  text += "\n[relative_errors]\n";
  for (const Error& e : errors_of(r.fit.errors)) put(e.key, e.value);
  return text;
}

std::string to_html(const FitResult& r) {
  std::string table = fmt::format(
      "<table>\n<tr><th></th><th>{}</th><th>section</th><th>relative difference</th></tr>\n",
      r.profile ? "outline" : "target");
  for (const Row& row : all_rows(r))
    table += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", row.label,
                         number(row, row.outline), number(row, row.section), difference(row));
  table += "</table>\n<table>\n<tr><th>dimension</th><th>mm</th></tr>\n";
  for (const Dimension& d : dimensions_of(r.fit.section))
    table += fmt::format("<tr><td>{}</td><td>{:.4f}</td></tr>\n", d.label, 1e3 * d.metres);
  std::string warnings;
  for (const Message& warning : r.warnings)
    warnings += fmt::format("<p>Warning: {}.</p>\n", html_text(warning.line()));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}: three "
      "rectangles</title>\n<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n<p>{2}</p>\n{3}<p>Area "
      "of the symmetric difference: {4}. Grey: outline; red: rectangles.</p>\n{6}{5}</table>\n"
      "</body>\n</html>\n",
      html_text(r.name), kStyle, html_text(r.source), drawing(r),
      area_of(r.fit.symmetric_difference), table, warnings);
}

}  // namespace railstep
