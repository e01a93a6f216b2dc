#include "section_family.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

bool all_positive(const Rectangles<double>& r) {
  const auto positive = [](double v) { return v > 0.0; };
  return std::all_of(r.width.begin(), r.width.end(), positive) &&
         std::all_of(r.height.begin(), r.height.end(), positive);
}

}  // namespace

std::vector<Rectangles<double>> section_family(const FitTargets& t, int head_heights) {
  std::vector<Rectangles<double>> found;
  const int n = 400;  // foot heights
  for (int j = 1; j < head_heights; ++j) {
    const double head = t.height * j / head_heights;
    const double room = t.height - head;
    double last = lateral_excess(t, room / n, head);
    for (int i = 2; i < n; ++i) {
      double low = room * (i - 1) / n, high = room * i / n;
      const double next = lateral_excess(t, high, head);
      const bool bracketed = (last < 0.0) != (next < 0.0);
      const double low_value = last;
      last = next;
      if (!bracketed) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        ((lateral_excess(t, middle, head) < 0.0) == (low_value < 0.0) ? low : high) = middle;
      }
      const Rectangles<double> section = with_heights(t, 0.5 * (low + high), head);
      // A sign change over a pole of the widths is no root.
      if (all_positive(section) &&
          std::abs(properties(section).inertia_z / t.area.inertia_z - 1.0) < 1e-6)
        found.push_back(section);
    }
  }
  return found;
}

}  // namespace railstep
