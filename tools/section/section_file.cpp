#include "section/section_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "offline/section/outline_mirror.h"
#include "offline/section/saint_venant.h"
#include "section/profile.h"
#include "text/read.h"

namespace railstep {
namespace {

/// Marks the keys that only inform as known, and checks that they are numbers.
void pass_over(const Table& root, const char* table, std::initializer_list<const char*> keys) {
  const std::optional<Table> found = root.table_if(table);
  if (!found) return;
  for (const char* key : keys) static_cast<void>(found->number(key, any_number(), 0.0));
}

constexpr std::initializer_list<const char*> kSectionKeys = {
    "area_m2",    "height_m",       "centroid_height_m", "inertia_y_m4",         "inertia_z_m4",
    "torsion_m4", "shear_factor_y", "shear_factor_z",    "shear_centre_height_m"};

constexpr double kMostAsymmetry = 0.05;  // of the area, of halves whose mean says something
constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Refuses constants that no shape has.
void check_shape(const Table& t, const Section& s) {
  const double most = most_inertia(s);
  if (!(s.area.inertia_y <= most))
    t.refuse("inertia_y_m4", "E-SECTION-28",
             fmt::format("inertia_y_m4 = {:g} is too large for this area, height and centroid; "
                         "expected at most A c (h - c) = {:.4g}",
                         s.area.inertia_y, most));
}

}  // namespace

OutlineShear outline_shear(const Outline& outline, double uneven) {
  const std::vector<Point> points = polygon(outline, 0.5 * kChordTolerance);
  const auto of_side = [&points](int side) {
    return saint_venant(mirrored_side(points, side, 0.5 * kChordTolerance), kFitPoisson);
  };
  std::string missing;
  double factor_y = kNotGiven, factor_z = kNotGiven;
  if (uneven > kMostAsymmetry) {
    missing = fmt::format(
        "Cowper's factors need a force along an axis of symmetry, and the outline and its mirror "
        "image differ by {:.2g} of the area",
        std::min(uneven, 2.0));
  } else {
    try {
      const SaintVenant right = of_side(1);
      if (uneven < 1e-6) return {right, 0.0, {}};
      const SaintVenant left = of_side(-1);
      factor_y = 0.5 * (right.shear_factor_y + left.shear_factor_y);
      factor_z = 0.5 * (right.shear_factor_z + left.shear_factor_z);
    } catch (const NoShearFactor& error) {
      missing = error.sentence();
    }
  }
  const Twist whole = twist(simplified(points, 0.5 * kChordTolerance));
  return {{whole.torsion, factor_y, factor_z, whole.shear_centre_height},
          uneven < 1e-6 ? 0.0 : whole.shear_centre_y,
          missing};
}

Section fitted_section(const SectionFit& fit, double height) try {
  return {properties(fit.section), saint_venant(polygon(fit.section), kFitPoisson), height};
} catch (const Refused& error) {
  throw NoSection(error.id(),
                  "three rectangles fit, but they are not a section: " + error.sentence());
}

double most_inertia(const Section& section) {
  const double centroid = section.area.centroid_height;
  return section.area.area * centroid * (section.height - centroid);
}

Section read_constants(const Table& t) {
  Section s{};
  const Range inertia = above_upto(0.0, 0.1), factor = above_upto(0.0, 1.2);
  s.area.area = t.number("area_m2", above_upto(0.0, 1.0));
  s.area.inertia_y = t.number("inertia_y_m4", inertia);
  s.area.inertia_z = t.number("inertia_z_m4", inertia);
  s.shear.torsion = t.number("torsion_m4", inertia);
  s.shear.shear_factor_y = t.number("shear_factor_y", factor);
  s.shear.shear_factor_z = t.number("shear_factor_z", factor);
  s.height = t.number("height_m", between(1e-4, 1.0));
  s.area.centroid_height = t.number("centroid_height_m", above_upto(0.0, s.height));
  s.shear.shear_centre_height =
      t.number("shear_centre_height_m", between(-s.height, 2. * s.height));
  return s;
}

Section read_section(const std::filesystem::path& file) {
  const Table root = read_shape_file(file);
  static_cast<void>(root.integer("schema", 1, 1));  // a newer one is refused
  if (!root.has("section") && root.has("half_outline_mm"))
    root.refuse("half_outline_mm", "E-SECTION-29",
                "the file holds a profile; expected it under the key profile, and a section under "
                "the key section");
  static_cast<void>(root.string("name", "-"));
  static_cast<void>(root.string("source", "-"));
  static_cast<void>(root.number("symmetric_difference_m2", at_least(0.0), 0.0));
  const Table constants = root.table("section");
  const Section section = read_constants(constants);
  check_shape(constants, section);
  pass_over(root, "outline", kSectionKeys);
  pass_over(root, "asymmetry",
            {"share_of_area", "product_of_inertia_m4", "principal_angle_rad", "centroid_offset_m",
             "shear_centre_offset_m"});
  pass_over(root, "target", kSectionKeys);
  pass_over(root, "dimensions",
            {"foot_width_m", "foot_height_m", "web_width_m", "web_height_m", "head_width_m",
             "head_height_m"});
  pass_over(root, "relative_errors", {"area", "inertia_y", "inertia_z", "centroid_height"});
  root.finish();
  return section;
}

std::optional<Rectangles<double>> read_dimensions(const std::filesystem::path& file) {
  const std::optional<Table> t = read_shape_file(file).table_if("dimensions");
  if (!t) return std::nullopt;
  const auto size = [&t](const char* key) { return t->number(key, above_upto(0.0, 1.0)); };
  return Rectangles<double>{{size("foot_width_m"), size("web_width_m"), size("head_width_m")},
                            {size("foot_height_m"), size("web_height_m"), size("head_height_m")}};
}

}  // namespace railstep
