#include <fmt/core.h>

#include "build/build.h"
#include "offline/math/refuse.h"
#include "offline/section/rectangles.h"
#include "offline/section/saint_venant.h"
#include "section/profile.h"
#include "section/section_file.h"

namespace railstep {
namespace {

using Polygon = std::vector<std::array<double, 2>>;

Section solved(const AreaProperties<double>& area, const Polygon& polygon, double height,
               double poisson) {
  return {area, saint_venant(polygon, poisson), height};
}

/// Moments of rectangles as the rule integrates them.
SectionMoments integrated(const Rectangles<double>& shape, int points) {
  return points == 0 ? moments(shape) : moments(shape, points);
}

RailSection from(const RectangleSizes& r, const BarScene& bar) {
  const Rectangles<double> shape{{r.foot_width, r.web_width, r.head_width},
                                 {r.foot_height, r.web_height, r.head_height}};
  const double height = r.foot_height + r.web_height + r.head_height;
  return {solved(properties(shape), polygon(shape), height, bar.poisson),
          integrated(shape, bar.section_points)};
}

RailSection from(const RectangleSize& r, const BarScene& bar) {
  const double w = r.width, h = r.height;
  const Polygon outline = {{-.5 * w, 0.}, {.5 * w, 0.}, {.5 * w, h}, {-.5 * w, h}};
  return {
      solved({w * h, .5 * h, w * h * h * h / 12., h * w * w * w / 12.}, outline, h, bar.poisson),
      rectangle_moments(h, w, bar.section_points == 0 ? 3 : bar.section_points)};
}

RailSection from(const Section& given, const BarScene&) { return {given, std::nullopt}; }

/// The constants of the file. Its shear factors are those at kFitPoisson, like a profile's.
RailSection from(const SectionFile& file, const BarScene& bar) {
  const std::optional<Rectangles<double>> shape = read_dimensions(file.path);
  RailSection result{read_section(file.path), std::nullopt};
  if (shape) result.moments = integrated(*shape, bar.section_points);
  return result;
}

SaintVenant shear_of(const Outline& outline) {
  const OutlineShear found = outline_shear(outline, 0.);
  if (!found.missing.empty()) refuse("E-RAIL-14", found.missing);
  return found.constants;
}

RailSection from(const ProfileFile& file, const BarScene& bar) {
  const Outline outline = read_profile(file.path).outline;
  if (file.exact)
    return {{properties(outline), shear_of(outline), outline.height}, moments(outline)};
  const SectionFit fit = fit_section(outline);
  return {fitted_section(fit, outline.height), integrated(fit.section, bar.section_points)};
}

}  // namespace

RailSection bar_section(const BarScene& bar, bool nonlinear, const std::string& place) try {
  RailSection found = std::visit([&](const auto& shape) { return from(shape, bar); }, bar.shape);
  SaintVenant& shear = found.section.shear;
  shear.shear_factor_y = bar.shear_factor_y.value_or(shear.shear_factor_y);
  shear.shear_factor_z = bar.shear_factor_z.value_or(shear.shear_factor_z);
  if ((nonlinear || bar.section_points > 0) && !found.moments)
    throw InputError(
        "E-RAIL-15",
        fmt::format("{} gives a section's constants, but {} needs its shape, for moments of "
                    "third and fourth degree; expected profile, rectangles or rectangle",
                    place,
                    bar.section_points > 0 ? "rule.section_points" : "the nonlinear element"));
  return found;
} catch (const Refused& error) {
  throw InputError(place, error);
} catch (const NoSection& error) {
  throw InputError(place, error);
}

BeamSection beam_section(const RailSection& bar) {
  const Section& section = bar.section;
  return {.area = section.area.area,
          .inertia_y = section.area.inertia_y,
          .inertia_z = section.area.inertia_z,
          .torsion = section.shear.torsion,
          .shear_factor_y = section.shear.shear_factor_y,
          .shear_factor_z = section.shear.shear_factor_z,
          .shear_centre_z = section.shear.shear_centre_height - section.area.centroid_height,
          .moments = bar.moments};
}

RailSection rail_section_of(const Scene& scene, int rail) {
  const bool nonlinear =
      scene.track.model == RailModel::nonlinear || scene.track.linearised_under_weight;
  const bool right = rail == kRightRail && scene.right_rail;
  return bar_section(right ? *scene.right_rail : scene.rail, nonlinear,
                     scene.file.string() + (right ? ": [rail.right]" : ": [rail]"));
}

Section section_of(const Scene& scene) { return rail_section_of(scene).section; }

RailSections sections_of(const Scene& scene) {
  const Section left = section_of(scene);
  return {left, scene.right_rail ? rail_section_of(scene, kRightRail).section : left};
}

double height_z(Height at, const Section& section, double axis_z) {
  if (at == Height::axis) return -axis_z;
  return (at == Height::head ? section.height : 0.) - section.area.centroid_height - axis_z;
}

double axis_z_of(ReferenceLine line, const Section& section) {
  switch (line) {
    case ReferenceLine::mid_height:
      return .5 * section.height - section.area.centroid_height;
    case ReferenceLine::foot:
      return height_z(Height::foot, section);
    case ReferenceLine::head:
      return height_z(Height::head, section);
    case ReferenceLine::centroid:
      break;
  }
  return 0.;
}

}  // namespace railstep
