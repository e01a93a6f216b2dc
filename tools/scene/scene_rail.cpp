#include <fmt/core.h>

#include "offline/math/constants.h"
#include "scene/scene_read.h"
#include "section/section_file.h"

namespace railstep {
namespace {

// A rail's section is under a metre in every direction; a larger one was given in millimetres.
const Range kSize = between(1e-4, 1.0);
const Range kShearFactor = above_upto(0.0, 1.2);
// A beam may be of rubber; a rail's modulus under 1 GPa was given in N/mm2.
const Range kRailYoung = between(1e9, 1e16), kBeamYoung = between(1e5, 1e13);  // Pa

RectangleSizes read_rectangles(const Table& t) {
  const RectangleSizes r{t.number("foot_width_m", kSize), t.number("foot_height_m", kSize),
                         t.number("web_width_m", kSize),  t.number("web_height_m", kSize),
                         t.number("head_width_m", kSize), t.number("head_height_m", kSize)};
  const double height = r.foot_height + r.web_height + r.head_height;
  if (!kSize.holds(height))
    t.refuse("foot_height_m", "E-RAIL-02",
             fmt::format("foot, web and head are {:.6g} m high together; expected {} m", height,
                         kSize.text()));
  return r;
}

constexpr const char* kWays[] = {"profile", "section", "constants", "rectangles", "rectangle"};

/// Exactly one of the five ways to give a section.
SectionSource read_shape(const Table& rail) {
  std::string found;
  for (const char* way : kWays) {
    if (!rail.has(way)) continue;
    if (!found.empty())
      rail.refuse(way, "E-RAIL-03",
                  fmt::format("{} is given beside {}; expected exactly one of profile, section, "
                              "constants, rectangles, rectangle",
                              way, found));
    found = way;
  }
  if (found != "profile" && rail.has("outline"))
    rail.refuse("outline", "E-RAIL-04",
                "outline says how a profile is taken, but there is no profile; expected "
                "profile beside it");
  if (found == "profile")
    return ProfileFile{rail.path("profile"), rail.choice("outline", {"fitted", "exact"}, 0) == 1};
  if (found == "section") return SectionFile{rail.path("section")};
  if (found == "constants") return read_constants(rail.table("constants"));
  if (found == "rectangles") return read_rectangles(rail.table("rectangles"));
  if (found == "rectangle") {
    const Table t = rail.table("rectangle");
    return RectangleSize{t.number("height_m", kSize), t.number("width_m", kSize)};
  }
  rail.refuse("", "E-RAIL-05",
              "no section is given; expected exactly one of profile, section, "
              "constants, rectangles, rectangle");
}

/// A shear factor that replaces the section's, from [rail] or [rail.rectangle].
std::optional<double> read_override(const Table& rail, std::string_view key) {
  const std::optional<Table> rectangle = rail.table_if("rectangle");
  const bool inside = rectangle && rectangle->has(key);
  if (inside && rail.has(key))
    rail.refuse(key, "E-RAIL-06",
                fmt::format("{} is given in [{}] and in [{}]; expected one of them", key,
                            rail.name(), rectangle->name()));
  if (inside) return rectangle->number(key, kShearFactor);
  if (rail.has(key)) return rail.number(key, kShearFactor);
  return std::nullopt;
}

/// How the element's energy is integrated.
ElementRule read_rule(const Table& t) {
  constexpr Coupling kCouplings[] = {Coupling::centroid, Coupling::axis, Coupling::section};
  constexpr Shear kShears[] = {Shear::twist, Shear::factors, Shear::offset, Shear::published};
  ElementRule rule;
  rule.axial_points = static_cast<int>(t.integer("axial_points", 1, 5, rule.axial_points));
  rule.coupling_points = static_cast<int>(t.integer("coupling_points", 1, 5, rule.axial_points));
  rule.coupling = kCouplings[t.choice("coupling", {"centroid", "axis", "section"}, 0)];
  rule.shear = kShears[t.choice("shear", {"twist", "factors", "offset", "published"}, 0)];
  return rule;
}

/// Points in each rectangle need a section of rectangles.
int read_section_points(const Table& t, const SectionSource& shape) {
  const int points = static_cast<int>(t.integer("section_points", 0, 3, 0));
  const auto* profile = std::get_if<ProfileFile>(&shape);
  if (points > 0 && (std::holds_alternative<Section>(shape) || (profile && profile->exact)))
    t.refuse("section_points", "E-RAIL-07",
             fmt::format("section_points = {}, but the section is not given by rectangles; "
                         "expected 0",
                         points));
  return points;
}

BarScene read_bar_of(const Table& bar, const Range& young) {
  BarScene r;
  r.shape = read_shape(bar);
  r.young = bar.number("young_pa", young, kSteelYoung);
  // Beyond these bounds a material would create energy; at 0.5 it cannot be compressed.
  r.poisson = bar.number("poisson", {-1.0, 0.5, false, false}, kSteelPoisson);
  r.density = bar.number("density_kg_per_m3", between(1.0, 1e5), kSteelDensity);
  r.section_points = 0;
  if (const std::optional<Table> rule = bar.table_if("rule")) {
    r.rule = read_rule(*rule);
    r.section_points = read_section_points(*rule, r.shape);
  }
  r.shear_factor_y = read_override(bar, "shear_factor_y");
  r.shear_factor_z = read_override(bar, "shear_factor_z");
  return r;
}

}  // namespace

BarScene read_bar(const Table& bar) { return read_bar_of(bar, kBeamYoung); }

RailScene read_rail(const Table& rail) {
  RailScene r;
  static_cast<BarScene&>(r) = read_bar_of(rail, kRailYoung);
  r.crown_radius = rail.number("crown_radius_m", between(0.01, 10.0), kCrownRadius);
  r.axial_force = rail.number("axial_force_n", between(-1e10, 1e10), 0.0);
  r.temperature_rise = rail.number("temperature_rise_k", between(-300.0, 300.0), 0.0);
  r.expansion = rail.number("expansion_per_k", between(0.0, 1e-3), 1.15e-5);
  r.cant = rail.slope("cant", between(0.0, 0.2), 0.0);
  return r;
}

RailScene read_right_rail(const Table& right, const RailScene& left) {
  RailScene r = left;
  for (const char* way : kWays)
    if (right.has(way)) {
      r.shape = read_shape(right);
      r.shear_factor_y = read_override(right, "shear_factor_y");
      r.shear_factor_z = read_override(right, "shear_factor_z");
      break;
    }
  r.young = right.number("young_pa", kRailYoung, left.young);
  r.poisson = right.number("poisson", {-1.0, 0.5, false, false}, left.poisson);
  r.density = right.number("density_kg_per_m3", between(1.0, 1e5), left.density);
  r.crown_radius = right.number("crown_radius_m", between(0.01, 10.0), left.crown_radius);
  r.axial_force = right.number("axial_force_n", between(-1e10, 1e10), left.axial_force);
  r.temperature_rise =
      right.number("temperature_rise_k", between(-300.0, 300.0), left.temperature_rise);
  return r;
}

}  // namespace railstep
