#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "build.h"
#include "offline/section/rectangles.h"
#include "offline/section/saint_venant.h"

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
  Polygon outline = polygon(shape);
  // Where a rectangle is as wide as the next, their corners coincide: one of them is enough.
  outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
  return solved(properties(shape), outline, r.foot_height + r.web_height + r.head_height, poisson);
}

Section from(const RectangleSize& r, double poisson) {
  const double w = r.width, h = r.height;
  const Polygon outline = {{-.5 * w, 0.}, {.5 * w, 0.}, {.5 * w, h}, {-.5 * w, h}};
  return solved({w * h, .5 * h, w * h * h * h / 12., h * w * w * w / 12.}, outline, h, poisson);
}

Section from(const Section& given, double) { return given; }

/// The dimensions alone: all else in the file follows from them and the scene's Poisson ratio.
Section from(const SectionFile& file, double poisson) {
  const Table t = read_toml(file.path).table("dimensions");
  const Range size = between(1e-4, 1.0);
  return from(RectangleSizes{t.number("foot_width_m", size), t.number("foot_height_m", size),
                             t.number("web_width_m", size), t.number("web_height_m", size),
                             t.number("head_width_m", size), t.number("head_height_m", size)},
              poisson);
}

Section from(const ProfileFile& file, double) {
  throw InputError(
      fmt::format("[rail] profile = '{}': run takes no outline; accepted is section = a file that "
                  "`railstep fit --out` wrote, or rectangles, rectangle, constants",
                  file.path.filename().string()));
}

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
