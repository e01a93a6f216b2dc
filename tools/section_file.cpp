#include "section_file.h"

#include <limits>

#include "offline/section/outline_mirror.h"
#include "offline/section/saint_venant.h"
#include "profile.h"
#include "read.h"

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

constexpr double kMostAsymmetry = 0.05;  // of the area; beyond, a shear centre off the axis is felt
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

/// Mean of both halves, each mirrored; NaN where the outline is too lopsided for that.
SaintVenant outline_shear(const Outline& outline, double uneven) {
  const std::vector<Point> points = polygon(outline, 0.5 * kChordTolerance);
  if (uneven > kMostAsymmetry) return {kNone, kNone, kNone, kNone};
  const SaintVenant right =
      saint_venant(mirrored_side(points, 1, 0.5 * kChordTolerance), kFitPoisson);
  if (uneven < 1e-6) return right;
  const SaintVenant left =
      saint_venant(mirrored_side(points, -1, 0.5 * kChordTolerance), kFitPoisson);
  const auto mean = [](double a, double b) { return 0.5 * (a + b); };
  return {mean(right.torsion, left.torsion), mean(right.shear_factor_y, left.shear_factor_y),
          mean(right.shear_factor_z, left.shear_factor_z),
          mean(right.shear_centre_height, left.shear_centre_height)};
}

Section fitted_section(const SectionFit& fit, double height) {
  return {properties(fit.section), saint_venant(polygon(fit.section), kFitPoisson), height};
}

Section read_profile_section(const std::filesystem::path& file) {
  const Outline outline = read_profile(file).outline;
  return fitted_section(fit_section(outline), outline.height);
}

Section read_section(const std::filesystem::path& file) {
  const Table root = read_toml(file);
  static_cast<void>(root.integer("schema", 1, 1));  // a newer one is refused
  static_cast<void>(root.string("name", "-"));
  static_cast<void>(root.string("source", "-"));
  static_cast<void>(root.number("symmetric_difference_m2", at_least(0.0), 0.0));
  const Table t = root.table("section");
  const auto positive = [&t](const char* key) { return t.number(key, above(0.0)); };
  const Section section{{positive("area_m2"), positive("centroid_height_m"),
                         positive("inertia_y_m4"), positive("inertia_z_m4")},
                        {positive("torsion_m4"), positive("shear_factor_y"),
                         positive("shear_factor_z"), positive("shear_centre_height_m")},
                        t.number("height_m", above_upto(0.0, 1.0))};
  if (section.area.centroid_height >= section.height)
    t.refuse("centroid_height_m", "is not below height_m");
  pass_over(root, "outline", kSectionKeys);
  pass_over(root, "target", kSectionKeys);
  pass_over(root, "dimensions",
            {"foot_width_m", "foot_height_m", "web_width_m", "web_height_m", "head_width_m",
             "head_height_m"});
  pass_over(root, "relative_errors", {"area", "inertia_y", "inertia_z", "centroid_height"});
  root.finish();
  return section;
}

std::optional<Rectangles<double>> read_dimensions(const std::filesystem::path& file) {
  const std::optional<Table> t = read_toml(file).table_if("dimensions");
  if (!t) return std::nullopt;
  const auto size = [&t](const char* key) { return t->number(key, above_upto(0.0, 1.0)); };
  return Rectangles<double>{{size("foot_width_m"), size("web_width_m"), size("head_width_m")},
                            {size("foot_height_m"), size("web_height_m"), size("head_height_m")}};
}

}  // namespace railstep
