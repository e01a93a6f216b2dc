#pragma once
#include "online/model/cant.h"
#include "online/track/line.h"

namespace railstep {

/// An element of the model and a place in it.
struct PlaceOnRails {
  bool on_rail;  // else neither is set
  std::int32_t element;
  double xi;
};
/// @param x  along the model's elements, m
inline PlaceOnRails place_on_rails(const Model& model, double x) noexcept {
  const double scaled = x / model.element_length;
  if (!(scaled >= 0. && scaled <= model.elements)) return {};
  std::int32_t element = static_cast<std::int32_t>(scaled);
  if (element == model.elements) element = model.elements - 1;
  return {true, element, 2. * (scaled - element) - 1.};
}

/// Sets a row to the displacement of a point of the section along a direction of the track.
/// @param y, z   m, in the section
/// @param shape  [3] of the row's element
inline void set_point_row(const Cant& cant, double y, double z, const double* shape,
                          const double* direction, RailRow& row) noexcept {
  const double lever[3] = {1., y, z};
  double along[3];
  to_rail(cant, direction, along);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) row.coefficient[i][k] = shape[i] * (lever[k / 3] * along[k % 3]);
}

/// Sets a row to the roll (a_z - b_y) / 2 of the section. @param shape  [3] of the row's element
inline void set_roll_row(const double* shape, RailRow& row) noexcept {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 9; ++k) row.coefficient[i][k] = 0.;
    row.coefficient[i][5] = .5 * shape[i];
    row.coefficient[i][7] = -.5 * shape[i];
  }
}

inline constexpr double kUp[3] = {0., 0., 1.};

}  // namespace railstep
