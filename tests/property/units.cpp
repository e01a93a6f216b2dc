// A scene in other units, and a scene moved to another place.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "generators.h"
#include "transform.h"

namespace railstep::property {
namespace {

/// Powers of length, time and mass in a unit.
struct Dimension {
  int length = 0, time = 0, mass = 0;
};

const Dimension* unit_of(const std::string& token) {
  static const std::map<std::string, Dimension> units = {
      {"m", {1, 0, 0}},    {"m2", {2, 0, 0}},  {"m3", {3, 0, 0}},  {"m4", {4, 0, 0}},
      {"s", {0, 1, 0}},    {"s2", {0, 2, 0}},  {"kg", {0, 0, 1}},  {"n", {1, -2, 1}},
      {"pa", {-1, -2, 1}}, {"hz", {0, -1, 0}}, {"rad", {0, 0, 0}}, {"deg", {0, 0, 0}}};
  const auto found = units.find(token);
  return found == units.end() ? nullptr : &found->second;
}

/// Dimension of the unit at the end of a key: force_z_n, damping_roll_n_m_s_per_rad.
Dimension dimension_of(const std::string& key) {
  std::vector<std::string> tokens;
  std::istringstream in(key);
  for (std::string token; std::getline(in, token, '_');) tokens.push_back(token);
  std::size_t first = tokens.size();
  while (first > 0 && (unit_of(tokens[first - 1]) != nullptr || tokens[first - 1] == "per"))
    --first;
  Dimension sum;
  int sign = 1;
  for (std::size_t i = first; i < tokens.size(); ++i) {
    if (tokens[i] == "per") {
      sign = -1;
      continue;
    }
    const Dimension& unit = *unit_of(tokens[i]);
    sum.length += sign * unit.length;
    sum.time += sign * unit.time;
    sum.mass += sign * unit.mass;
  }
  return sum;
}

double factor(const Dimension& d, const Units& units) {
  return std::pow(units.length, d.length) * std::pow(units.time, d.time) *
         std::pow(units.mass, d.mass);
}

void scale(Document& value, double by) {
  if (by != 1.) for_each_number(value, [by](Document& n) { n = n.get<double>() * by; });
}

/// Scales the rows [t, value] of a table; its name or its owner gives the unit of its values.
void scale_rows(Document& rows, double time, double by) {
  for (Document& row : rows) {
    scale(row[0], time);
    scale(row[1], by);
  }
}

void scale_entry(const std::string& key, Document& value, const Units& units) {
  if (value.is_object() || (value.is_array() && !value.empty() && value[0].is_object())) return;
  if (key == "table") return;  // its owner gives its unit
  if (key == "speed_table") return scale_rows(value, units.time, units.length / units.time);
  if (key.starts_with("table_"))
    return scale_rows(value, units.time, factor(dimension_of(key), units));
  const double by = factor(dimension_of(key), units);
  if (key.starts_with("polynomial_")) {  // c0 + c1 t + ...
    double power = by;
    for (Document& c : value) {
      scale(c, power);
      power /= units.time;
    }
    return;
  }
  scale(value, by);
}

}  // namespace

Transformed rescaled(const Document& scene, const Units& units) {
  Document other = scene;
  for_each_entry(other,
                 [&](const std::string& key, Document& value) { scale_entry(key, value, units); });
  const double force = factor({1, -2, 1}, units), moment = factor({2, -2, 1}, units);
  for (Document& load : other["load"])
    if (load.contains("table")) scale_rows(load["table"], units.time, 1.);
  for (const char* carriers : {"wheelset", "vehicle"})
    for (Document& carrier : other[carriers])
      for (Document& f : carrier["force"])
        scale_rows(f["table"], units.time, f["direction"] == "pitch" ? moment : force);
  return {other, [units](const std::string& column) {
            return Image{column, factor(dimension_of(column), units)};
          }};
}

Transformed moved_on(const Document& scene, int bays) {
  Document other = scene;
  const double way = bays * number(scene["track"], "bay_m");
  const auto move = [&](Document& table, const char* key) {
    if (table.contains(key)) table[key] = number(table, key) + way;
  };
  for (const char* carriers : {"load", "wheelset", "vehicle"})
    for (Document& carrier : other[carriers])
      for (const char* key : {"start_m", "stop_m"}) move(carrier, key);
  for (Document& s : other["sensor"]) {
    if (s["on"] == "rail") move(s, "position_m");
    if (s["on"] == "sleeper") s["sleeper"] = static_cast<int>(number(s, "sleeper")) + bays;
  }
  for (Document& defect : other["defect"])
    for (const char* key : {"at_m", "from_m", "to_m"}) move(defect, key);
  return {other, [way](const std::string& column) {
            return Image{column, 1., column.ends_with(".x_m") ? way : 0.};
          }};
}

Transformed moved_off(const Document& scene, const double by[3]) {
  Document other = scene;
  for_each_entry(other, [&](const std::string& key, Document& value) {
    const bool vector = value.is_array() && value.size() == 3 && value[0].is_number();
    if (vector &&
        (key == "position_m" || key == "point_m" || key == "other_point_m" || key == "start_m"))
      for (std::size_t d = 0; d < 3; ++d) value[d] = value[d].get<double>() + by[d];
  });
  const double x = by[0], y = by[1], z = by[2];
  return {other, [x, y, z](const std::string& column) {
            const std::string own = column.substr(column.rfind('.') + 1);
            return Image{column, 1., own == "x_m" ? x : own == "y_m" ? y : own == "z_m" ? z : 0.};
          }};
}

}  // namespace railstep::property
