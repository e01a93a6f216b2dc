#include <fmt/core.h>

#include <stdexcept>

#include "build.h"
#include "offline/section/rectangles.h"
#include "offline/section/saint_venant.h"
#include "section_file.h"

namespace railstep {
namespace {

using Polygon = std::vector<std::array<double, 2>>;

Section solved(const AreaProperties<double>& area, const Polygon& polygon, double height,
               double poisson) {
  return {area, saint_venant(polygon, poisson), height};
}

Section from(const RectangleSizes& r, double poisson) {
  const Rectangles<double> shape{{r.foot_width, r.web_width, r.head_width},
                                 {r.foot_height, r.web_height, r.head_height}};
  return solved(properties(shape), polygon(shape), r.foot_height + r.web_height + r.head_height,
                poisson);
}

Section from(const RectangleSize& r, double poisson) {
  const double w = r.width, h = r.height;
  const Polygon outline = {{-.5 * w, 0.}, {.5 * w, 0.}, {.5 * w, h}, {-.5 * w, h}};
  return solved({w * h, .5 * h, w * h * h * h / 12., h * w * w * w / 12.}, outline, h, poisson);
}

Section from(const Section& given, double) { return given; }

/// As the file has them: its shear factors are those at kFitPoisson, like a profile's.
Section from(const SectionFile& file, double) { return read_section(file.path); }

Section from(const ProfileFile& file, double) { return read_profile_section(file.path); }

}  // namespace

Section section_of(const Scene& scene) try {
  const RailScene& rail = scene.rail;
  Section section =
      std::visit([&](const auto& shape) { return from(shape, rail.poisson); }, rail.shape);
  section.shear.shear_factor_y = rail.shear_factor_y.value_or(section.shear.shear_factor_y);
  section.shear.shear_factor_z = rail.shear_factor_z.value_or(section.shear.shear_factor_z);
  return section;
} catch (const std::invalid_argument& error) {
  throw InputError(fmt::format("{}: [rail] {}", scene.file.string(), error.what()));
}

}  // namespace railstep
