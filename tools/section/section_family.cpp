#include "section/section_family.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "section/section_solve.h"

namespace railstep {
namespace {

/// The widths that give area, first and second moment at these heights.
Rectangles<double> with_heights(const FitTargets& t, double foot, double head) {
  const std::array<double, 3> height = {foot, t.height - foot - head, head};
  const double c = t.area.centroid_height;
  // Heights in units of H, so that the three rows are of one size.
  Eigen::Matrix3d rows;
  double z0 = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double z1 = z0 + height[static_cast<std::size_t>(i)] / t.height;
    rows.col(i) << z1 - z0, (z1 * z1 - z0 * z0) / 2.0, (z1 * z1 * z1 - z0 * z0 * z0) / 3.0;
    z0 = z1;
  }
  const double H = t.height;
  const Eigen::Vector3d want(t.area.area / H, t.area.area * c / (H * H),
                             (t.area.inertia_y + t.area.area * c * c) / (H * H * H));
  const Eigen::Vector3d width = rows.partialPivLu().solve(want);
  return {{width[0], width[1], width[2]}, height};
}

double lateral_excess(const FitTargets& t, double foot, double head) {
  return properties(with_heights(t, foot, head)).inertia_z / t.area.inertia_z - 1.0;
}

/// Every split of a plain rectangle in three is exact, so that there is no root to bracket or
/// branch to follow: thirds stand for all of them.
std::optional<Rectangles<double>> plain_rectangle(const FitTargets& t) {
  const double width = t.area.area / t.height, third = t.height / 3.0;
  const Rectangles<double> thirds{{width, width, width}, {third, third, third}};
  return largest(relative_errors(t, thirds)) < kExact ? std::make_optional(thirds) : std::nullopt;
}

/// Halves the interval between two foot heights at which the error of Iz has different signs.
std::optional<Rectangles<double>> exact_between(const FitTargets& t, double low, double high,
                                                double head) {
  const bool below = lateral_excess(t, low, head) < 0.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    ((lateral_excess(t, middle, head) < 0.0) == below ? low : high) = middle;
  }
  const Rectangles<double> section = with_heights(t, 0.5 * (low + high), head);
  // A sign change over a pole of the widths is not a root.
  const bool exact = is_section(section) &&
                     std::abs(properties(section).inertia_z / t.area.inertia_z - 1.0) < 1e-6;
  return exact ? std::make_optional(section) : std::nullopt;
}

}  // namespace

std::vector<Rectangles<double>> section_family(const FitTargets& t, int head_heights) {
  if (const auto plain = plain_rectangle(t)) return {*plain};
  std::vector<Rectangles<double>> found;
  const int n = 400;  // foot heights
  for (int j = 1; j < head_heights; ++j) {
    const double head = t.height * j / head_heights;
    const double room = t.height - head;
    double last = lateral_excess(t, room / n, head);
    for (int i = 2; i < n; ++i) {
      const double low = room * (i - 1) / n, high = room * i / n, at_low = last;
      last = lateral_excess(t, high, head);
      if ((at_low < 0.0) == (last < 0.0)) continue;
      if (const auto section = exact_between(t, low, high, head)) found.push_back(*section);
    }
  }
  return found;
}

std::optional<Rectangles<double>> section_beside(const FitTargets& t,
                                                 const Rectangles<double>& section, double head) {
  constexpr int kSteps = 50;
  const double step = 0.05 * t.height / kSteps, foot = section.height[0];
  for (int i = 0; i < kSteps; ++i)  // outwards, by turns below and above
    for (const double low : {foot - (i + 1) * step, foot + i * step}) {
      const double high = low + step;
      if (!(low > 0.0 && high + head < t.height)) continue;
      if ((lateral_excess(t, low, head) < 0.0) == (lateral_excess(t, high, head) < 0.0)) continue;
      if (const auto found = exact_between(t, low, high, head)) return found;
    }
  return std::nullopt;
}

}  // namespace railstep
