#include "section/fit_profile.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "section/section_file.h"
#include "text/read.h"

namespace railstep {
namespace {

// Part of the area. Rails with a broad foot are 0.15 to 0.17 apart from their rectangles, whose J
// is then 0.80 to 0.87 of their own.
constexpr double kMuchApart = 0.25;
constexpr double kWider = 1.01;  // than the outline: more than round-off and chords

double width_of(const std::vector<Point>& points) {
  const auto [left, right] = std::minmax_element(points.begin(), points.end());
  return (*right)[0] - (*left)[0];
}

void describe_outline(FitResult& r, const std::vector<Point>& points) {
  const Outline& outline = r.profile->outline;
  const double foot = foot_middle(points), share = asymmetry(points);
  const OutlineShear shear = outline_shear(outline, share);
  r.outline = {properties(outline), shear.constants, outline.height};
  r.lopsided = {share, product_of_inertia(outline), -foot, shear.shear_centre_y - foot};
  if (!shear.missing.empty())
    r.warnings.push_back(
        {"W-FIT-01",
         fmt::format("the outline has no shear factors, and those of the rectangles are used: {}",
                     shear.missing)});
}

/// Says where the rectangles have the outline's four properties and little else of it.
void compare(FitResult& r, const std::vector<Point>& points) {
  if (auto warning = lopsided_warning(r.lopsided, r.section)) r.warnings.push_back(*warning);
  const double widest = *std::max_element(r.fit.section.width.begin(), r.fit.section.width.end());
  if (widest > kWider * width_of(points))
    r.warnings.push_back(
        {"W-FIT-02",
         fmt::format(
             "the widest of the three rectangles is {:.1f} mm wide, and the outline {:.1f} mm",
             1e3 * widest, 1e3 * width_of(points))});
  const double apart = r.fit.symmetric_difference / r.outline.area.area;
  if (apart > kMuchApart)
    r.warnings.push_back(
        {"W-FIT-03",
         fmt::format(
             "the areas of rectangles and outline differ by {:.2g} of the area: J, the shear "
             "factors and the shear centre are those of the rectangles, not of the outline",
             apart)});
}

}  // namespace

FitResult fit_profile(Profile profile, const std::string& file) try {
  FitResult r{.name = profile.name, .source = profile.source};
  r.profile = std::move(profile);
  const Outline& outline = r.profile->outline;
  const std::vector<Point> points = polygon(outline, kChordTolerance);
  describe_outline(r, points);
  try {
    r.fit = fit_section(outline);
    r.section = fitted_section(r.fit, outline.height);
    compare(r, points);
  } catch (const NoSection& none) {
    r.refusal = Message(none.id(), none.sentence());
  }
  return r;
} catch (const Refused& error) {
  throw InputError(file, error);
}

}  // namespace railstep
