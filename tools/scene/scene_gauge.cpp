#include <fmt/core.h>

#include "offline/section/outline.h"
#include "offline/section/rectangles.h"
#include "scene/scene_read.h"
#include "section/profile.h"
#include "section/section_file.h"

namespace railstep {
namespace {

std::optional<double> width_of(const Outline& outline) {
  return length_inside(polygon(outline, kChordTolerance), 1, outline.height - kGaugeDepth,
                       -outline.height, outline.height);
}

std::optional<double> width_of(const std::array<double, 3>& widths,
                               const std::array<double, 3>& heights) {
  double below = kGaugeDepth;
  for (int i = 2; i >= 0; --i) {
    const auto part = static_cast<std::size_t>(i);
    if (below < heights[part]) return widths[part];
    below -= heights[part];
  }
  return std::nullopt;
}

/// head_width() for each way to give a section.
struct HeadWidth {
  std::optional<double> operator()(const ProfileFile& file) const {
    return width_of(read_profile(file.path).outline);
  }
  std::optional<double> operator()(const SectionFile& file) const {
    const std::optional<Rectangles<double>> shape = read_dimensions(file.path);
    return shape ? width_of(shape->width, shape->height) : std::nullopt;
  }
  std::optional<double> operator()(const RectangleSizes& r) const {
    return width_of({r.foot_width, r.web_width, r.head_width},
                    {r.foot_height, r.web_height, r.head_height});
  }
  std::optional<double> operator()(const RectangleSize& r) const {
    return width_of({r.width, r.width, r.width}, {0.0, 0.0, r.height});
  }
  std::optional<double> operator()(const Section&) const { return std::nullopt; }
};

double width_for_gauge(const Table& track, const BarScene& bar) {
  const std::optional<double> width = head_width(bar);
  if (!width)
    track.refuse("gauge_m", "E-RAIL-01",
                 "gauge_m is measured between the heads, 14 mm below their tops, but the "
                 "section does not say how wide the head is there; expected "
                 "rail_spacing_m, or a rail whose section has a shape");
  return *width;
}

}  // namespace

std::optional<double> head_width(const BarScene& rail) {
  return std::visit(HeadWidth{}, rail.shape);
}

double spacing_of_gauge(const Table& track, const Scene& scene, double gauge) {
  const RailScene& right = scene.right_rail ? *scene.right_rail : scene.rail;
  return gauge + 0.5 * (width_for_gauge(track, scene.rail) + width_for_gauge(track, right));
}

}  // namespace railstep
