#include "online/contact/wheel_seat.h"

#include <cmath>

namespace railstep {

namespace {

/// The centre of the crown in the rail's section: its contact with a centred wheel is in the middle
/// of the railhead.
struct SectionPoint {
  double y, z;
};
SectionPoint crown_centre(const Model& model, const RollingContact& contact, int side) noexcept {
  const Cant& cant = model.cant[side];
  const CrownTop top = crown_top(cant, model.head_z[side], model.crown_radius[side]);
  const double cosine = 1. / std::sqrt(1. + contact.slope * contact.slope);
  const double outwards = contact.crown_radius * (contact.slope * cosine);
  const double in_track[3] = {0., side == 0 ? outwards : -outwards, -contact.crown_radius * cosine};
  double in_section[3];
  to_rail(cant, in_track, in_section);
  return {top.y + in_section[1], top.z + in_section[2]};
}

/// Row of a point of the section along a direction of the track.
void fill_point_row(const Cant& cant, const SectionPoint& point, const double* shape,
                    const double* direction, RailRow& row) noexcept {
  const double lever[3] = {1., point.y, point.z};
  double along[3];
  to_rail(cant, direction, along);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) row.coefficient[i][k] = shape[i] * (lever[k / 3] * along[k % 3]);
}

/// Row of the roll (a_z - b_y) / 2 of the section.
void fill_roll_row(const double* shape, RailRow& row) noexcept {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 9; ++k) row.coefficient[i][k] = 0.;
    row.coefficient[i][5] = .5 * shape[i];
    row.coefficient[i][7] = -.5 * shape[i];
  }
}

}  // namespace

void locate_wheel_seat(const Model& model, const Configuration& at, const RunnerModel& runner,
                       double x, int side, SeatMotions& seats, WheelSeatRow* seat,
                       RailForce* place) noexcept {
  const double scaled = x / model.element_length;
  const bool on_rail = scaled >= 0. && scaled <= model.elements;
  for (int d = 0; d < kWheelSeatRows; ++d) {
    seat[d].on_rail = on_rail;
    seat[d].row.rail = side;
    seat[d].row.element = 0;
    seat[d].row.seats = 0;
    seat[d].rise = 0.;
    place[d].load_point = kNoLoadPoint;
  }
  if (!on_rail) return;
  std::int32_t element = static_cast<std::int32_t>(scaled);
  if (element == model.elements) element = model.elements - 1;
  const double xi = 2. * (scaled - element) - 1.;
  double shape[3];
  shape_functions(xi, shape);
  const SectionPoint centre = crown_centre(model, runner.contact, side);
  constexpr double kAlong[2][3] = {{0., 1., 0.}, {0., 0., 1.}};
  for (int d = 0; d < kWheelSeatRows; ++d) seat[d].row.element = element;
  for (int d = 0; d < 2; ++d)
    fill_point_row(model.cant[side], centre, shape, kAlong[d], seat[d].row);
  fill_roll_row(shape, seat[2].row);
  double roll = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) roll += motion(model.line[l], seat[2].row, at);
  // The row has the slope of what is a square of rolls, so that it gives twice its value.
  double up[3];
  to_rail(model.cant[side], kAlong[1], up);
  const double own = -.5 * roll * roll * (centre.z * up[2] + centre.y * up[1]);
  seat[1].rise =
      -(own + add_p_delta(model, at, roll, xi, centre.y, centre.z, kAlong[1], seat[1].row, seats));
  place[1] = {model, runner.load_point[side], element, xi, 0.};
}

}  // namespace railstep
