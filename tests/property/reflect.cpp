// The mirror image of a scene, across the track or along it.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "generators.h"
#include "transform.h"

namespace railstep::property {
namespace {

void negate(Document& value) {
  for_each_number(value, [](Document& n) {
    if (n.is_number_float())
      n = -n.get<double>();
    else
      n = -n.get<std::int64_t>();
  });
}
/// Negates the values of rows [t, value].
void negate_values(Document& rows) {
  for (Document& row : rows) negate(row[1]);
}

std::string other_side(const std::string& side) {
  return side == "left" ? "right" : side == "right" ? "left" : side;
}

void swap_sides(Document& scene) {
  for_each_entry(scene, [](const std::string& key, Document& value) {
    if ((key == "rail" || key == "wheel" || key == "side") && value.is_string())
      value = other_side(value);
    if (key == "between")
      for (Document& part : value)
        if (part == "rail left" || part == "rail right")
          part = part == "rail left" ? "rail right" : "rail left";
  });
}

/// [rail] describes both rails, [rail.right] the differences of the right one.
void swap_rails(Document& rail) {
  if (!rail.contains("right")) return;
  Document left = rail, right = rail["right"];
  left.erase("right");
  const bool own_shape =
      right.contains("rectangle") || right.contains("rectangles") || right.contains("constants");
  Document swapped = left, was_left = Document::object();
  for (const char* shape : {"rectangle", "rectangles", "constants"}) {
    if (own_shape) swapped.erase(shape);
    if (left.contains(shape)) was_left[shape] = left[shape];
  }
  for (const auto& [key, value] : right.items()) swapped[key] = value;
  for (const char* key :
       {"young_pa", "poisson", "density_kg_per_m3", "crown_radius_m", "axial_force_n"})
    if (left.contains(key)) was_left[key] = left[key];
  swapped["right"] = was_left;
  rail = swapped;
}

/// Stops beside a single rail change sides.
void swap_stops(Document& scene) {
  for (Document& stop : scene["stop"]) stop["side"] = other_side(stop["side"]);
}

void mirror_track(Document& scene) {
  if (number(scene["track"], "rails") == 1.) return swap_stops(scene);
  swap_sides(scene);
  if (scene.contains("rail")) swap_rails(scene["rail"]);
  for (Document& w : scene["wheelset"])
    for (Document& f : w["force"])
      if (f["direction"] == "y") negate_values(f["table"]);
}

void turn_round(Document& carrier, double length) {
  carrier["start_m"] = length - number(carrier, "start_m");
  if (carrier.contains("stop_m")) carrier["stop_m"] = length - number(carrier, "stop_m");
  if (carrier.contains("speed_m_per_s")) negate(carrier["speed_m_per_s"]);
  if (carrier.contains("speed_table")) negate_values(carrier["speed_table"]);
  for (Document& f : carrier["force"])
    if (f["direction"] == "x" || f["direction"] == "pitch") negate_values(f["table"]);
}

int wheels_of(const Document& vehicle) {
  const int axles = static_cast<int>(number(vehicle, "axles", 2.));
  const std::string type = vehicle["type"];
  return type == "bogie" ? axles : type == "vehicle" ? 2 * axles : 1;
}

void reverse_change(Document& change, int bays) {
  const auto from = static_cast<int>(number(change, "from", 0.));
  const auto to = static_cast<int>(number(change, "to", bays));
  change["from"] = bays - to;
  change["to"] = bays - from;
  for (const char* table : {"support", "ballast", "sleeper"})
    for (Document& value : change[table])
      if (value.is_array()) std::reverse(value.begin(), value.end());
}

void reverse_track(Document& scene) {
  const int bays = static_cast<int>(number(scene["track"], "bays"));
  const double length = length_of(scene);
  if (Document& ends = scene["track"]["ends"]; ends.is_array())
    std::reverse(ends.begin(), ends.end());
  for (const char* carriers : {"load", "wheelset", "vehicle"})
    for (Document& carrier : scene[carriers]) turn_round(carrier, length);
  for (Document& v : scene["vehicle"])
    for (Document& tread : v["tread"])
      tread["wheel"] = wheels_of(v) + 1 - static_cast<int>(number(tread, "wheel"));
  for (Document& s : scene["sensor"]) {
    if (s["on"] == "rail") s["position_m"] = length - number(s, "position_m");
    if (s["on"] == "sleeper") s["sleeper"] = bays - static_cast<int>(number(s, "sleeper"));
    if (s.contains("x_m")) negate(s["x_m"]);
  }
  for (Document& change : scene["support_change"]) reverse_change(change, bays);
  for (Document& stop : scene["stop"]) stop["position_m"] = length - number(stop, "position_m");
  for (Document& joint : scene["rail_joint"]) joint["x_m"] = length - number(joint, "x_m");
  for (Document& defect : scene["defect"]) defect["at_m"] = length - number(defect, "at_m");
}

/// Axes of rotations are mirrored as lines, and rotations about them change sign.
void reflect_system(Document& scene, int axis, double length) {
  const bool planar = scene.contains("system") && scene["system"]["planar"] == true;
  if (planar)  // a section's left stays on +y, so up becomes down
    for (Document& b : scene["beam"]) negate(b["up"]);
  const auto d = static_cast<std::size_t>(axis);
  for_each_entry(scene, [&](const std::string& key, Document& value) {
    const bool vector = value.is_array() && value.size() == 3 && value[0].is_number();
    if (vector &&
        (key == "position_m" || key == "point_m" || key == "other_point_m" || key == "start_m"))
      value[d] = length - value[d].get<double>();
    else if (vector && (key == "velocity_m_per_s" || key == "direction" || key == "up" ||
                        key == "axis" || key == "other_axis" || key == "gravity_m_per_s2"))
      value[d] = -value[d].get<double>();
    else if (vector && (key == "rotation_deg" || key == "angular_velocity_rad_per_s"))
      for (std::size_t k = 0; k < 3; ++k) value[k] = (k == d ? 1. : -1.) * value[k].get<double>();
    else if (key == "inertia_kg_m2" && value.is_array() && value.size() == 6)
      for (const std::size_t product :
           axis == 1 ? std::array<std::size_t, 2>{3, 5} : std::array<std::size_t, 2>{3, 4})
        value[product] = -value[product].get<double>();
    else if (key == "polynomial_rad" || key == "polynomial_n_m" || key == "moment_n_m")
      negate(value);
    else if (key == "table_rad" || key == "table_n_m")
      negate_values(value);
  });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Names of a wheel's columns contain its number or side, those of a support its seat or rail.
std::string image_name(const Document& scene, int axis, const std::string& column) {
  const std::string prefix = column.substr(0, column.rfind('.'));
  if (axis == 1) {
    for (const Document& w : tables(scene, "wheelset"))
      for (const char* side : {"left", "right"})
        if (prefix == fmt::format("{}_{}", word(w, "name"), side))
          return replaced(column, side, other_side(side));
    if (!column.starts_with("support_") || number(scene.at("track"), "rails") == 1.) return column;
    return column.starts_with("support_right_") ? replaced(column, "support_right_", "support_")
                                                : replaced(column, "support_", "support_right_");
  }
  if (column.starts_with("support_")) {
    const std::size_t at = prefix.rfind('_') + 1;
    const int seat = std::stoi(prefix.substr(at));
    return fmt::format("{}{}{}", prefix.substr(0, at),
                       static_cast<int>(number(scene["track"], "bays")) - seat,
                       column.substr(prefix.size()));
  }
  for (const Document& v : tables(scene, "vehicle")) {
    const std::string name = word(v, "name");
    for (int n = 1; n <= wheels_of(v); ++n)
      if (prefix == fmt::format("{}.wheel_{}", name, n))
        return replaced(column, prefix, fmt::format("{}.wheel_{}", name, wheels_of(v) + 1 - n));
    for (int n = 1; n <= 2; ++n)
      if (prefix == fmt::format("{}.frame_{}", name, n))
        return replaced(column, prefix, fmt::format("{}.frame_{}", name, 3 - n));
  }
  return column;
}

double sign_of(int axis, const std::string& column) {
  const std::string own = column.substr(column.rfind('.') + 1);
  const std::string along = axis == 0 ? "x" : "y";
  if (own == along + "_m" || own == "d" + along + "_m" || own == "v" + along + "_m_per_s" ||
      own == "force_" + along + "_n" || own == "pitch_rad")
    return own == "pitch_rad" && axis == 1 ? 1. : -1.;
  if (own.starts_with("moment_")) return own == "moment_" + along + "_n_m" ? 1. : -1.;
  return 1.;
}

}  // namespace

Document without_scatter(const Document& scene, int axis) {
  Document other = scene;
  other.erase("irregularity");
  if (axis == 1 && number(scene.value("track", Document::object()), "rails") == 1.)
    other["rail"].erase("cant");  // a single rail leans to one side
  if (Document& defects = other["defect"]; axis == 0 && !defects.is_null())
    defects.erase(std::remove_if(defects.begin(), defects.end(),
                                 [](const Document& d) { return d["kind"] == "corrugation"; }),
                  defects.end());
  Document& changes = other["support_change"];
  for (Document& change : changes)
    if (change.contains("seed")) {
      change.erase("seed");
      change["support"] = {{"stiffness_factor", 1.5}};
    }
  return other;
}

Transformed reflected(const Document& scene, int axis) {
  Document other = scene;
  const bool track = scene.contains("track");
  const double length = track && axis == 0 ? length_of(scene) : 0.;
  if (track && axis == 0) reverse_track(other);
  if (track && axis == 1) mirror_track(other);
  if (scene.contains("body") || scene.contains("beam")) reflect_system(other, axis, length);
  const auto image = [scene, axis, length](const std::string& column) {
    const double sign = sign_of(axis, column);
    const std::string own = column.substr(column.rfind('.') + 1);
    const bool unlike = scene.contains("rail") && scene["rail"].contains("right");
    if (unlike && axis == 1 && own == "z_m") return Image{};  // heights count from the left axis
    return Image{image_name(scene, axis, column), sign, own == "x_m" && axis == 0 ? length : 0.};
  };
  return {other, image};
}

}  // namespace railstep::property
