#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "offline/section/section.h"

namespace railstep {

/// Three rectangles on one upright axis, from the foot up: foot, web, head.
template <typename T>
struct Rectangles {
  std::array<T, 3> width;   // along y, m
  std::array<T, 3> height;  // along z, m
};

/// Closed forms: A = sum w h; centroid by first moments; Iy = sum w h3/12 + w h d2; Iz = sum h
/// w3/12.
template <typename T>
AreaProperties<T> properties(const Rectangles<T>& section) {
  T area(0.0), first(0.0), inertia_z(0.0), base(0.0);
  std::array<T, 3> middle;
  for (std::size_t i = 0; i < 3; ++i) {
    const T& w = section.width[i];
    const T& h = section.height[i];
    middle[i] = base + h * 0.5;
    area += w * h;
    first += w * h * middle[i];
    inertia_z += h * w * w * w / 12.0;
    base += h;
  }
  const T centroid = first / area;
  T inertia_y(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const T& h = section.height[i];
    const T off = middle[i] - centroid;
    inertia_y += section.width[i] * h * (h * h / 12.0 + off * off);
  }
  return {area, centroid, inertia_y, inertia_z};
}

/// The union's outline, counter-clockwise from the foot's lower right corner, first not repeated.
/// Steps narrower than 1e-8 of the height are left out: no mesh could follow them.
inline std::vector<std::array<double, 2>> polygon(const Rectangles<double>& section) {
  const double least = 1e-8 * (section.height[0] + section.height[1] + section.height[2]);
  std::vector<std::array<double, 2>> right;
  double z = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double half = 0.5 * section.width[i];
    const bool step = right.empty() || std::abs(right.back()[0] - half) > least;
    if (!step) right.pop_back();
    const double side = step ? half : right.back()[0];
    if (step) right.push_back({side, z});
    z += section.height[i];
    right.push_back({side, z});
  }
  std::vector<std::array<double, 2>> all = right;
  for (auto p = right.rbegin(); p != right.rend(); ++p) all.push_back({-(*p)[0], (*p)[1]});
  return all;
}

}  // namespace railstep
