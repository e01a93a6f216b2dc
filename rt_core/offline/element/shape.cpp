#include "offline/element/shape.h"

namespace railstep {

std::array<double, 3> shape(double xi) {
  return {-.5 * xi * (1. - xi), 1. - xi * xi, .5 * xi * (1. + xi)};
}

std::array<double, 3> shape_slope(double xi) { return {xi - .5, -2. * xi, xi + .5}; }

Vector27 point_row(double xi, double y, double z, int direction) {
  const std::array<double, 3> n = shape(xi);
  Vector27 row = Vector27::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = n[static_cast<std::size_t>(i)];
    row[9 * i + direction] = value;
    row[9 * i + 3 + direction] = y * value;
    row[9 * i + 6 + direction] = z * value;
  }
  return row;
}

}  // namespace railstep
