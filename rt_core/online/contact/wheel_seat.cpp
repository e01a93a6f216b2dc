#include "online/contact/wheel_seat.h"

#include <cmath>

#include "online/track/rail_point.h"

namespace railstep {

namespace {

void clear(bool on_rail, int side, std::int32_t element, WheelSeatRow* seat,
           RailForce* place) noexcept {
  for (int d = 0; d < kWheelSeatRows; ++d) {
    seat[d].on_rail = on_rail;
    seat[d].row.rail = side;
    seat[d].row.element = element;
    seat[d].row.seats = 0;
    seat[d].rise = seat[d].lean = 0.;
    place[d].load_point = kNoLoadPoint;
  }
}

constexpr double kAlong[2][3] = {{0., 1., 0.}, {0., 0., 1.}};  // of a seat's rows along y and z

void fill_seat_rows(const Model& model, const SectionPoint& centre, int side, const double* shape,
                    WheelSeatRow* seat) noexcept {
  for (int d = 0; d < 2; ++d)
    set_point_row(model.cant[side], centre.y, centre.z, shape, kAlong[d], seat[d].row);
  set_roll_row(shape, seat[2].row);
}

/// Whether no section of any line strains, so that it moves as its axis and its roll do.
bool has_rigid_sections(const Model& model) noexcept {
  bool rigid = true;
  for (std::int32_t l = 0; l < model.lines; ++l) rigid = rigid && model.line[l].rigid_section != 0;
  return rigid;
}

/// Displacement of a point of the section along a direction of the track by a unit of its roll, m.
double by_roll(const Cant& cant, const SectionPoint& point, const double* direction) noexcept {
  double along[3];
  to_rail(cant, direction, along);
  return point.y * along[2] - point.z * along[1];
}

}  // namespace

double side_of_crown(const RollingContact& contact, int side) noexcept {
  const double cosine = 1. / std::sqrt(1. + contact.slope * contact.slope);
  const double outwards = contact.crown_radius * (contact.slope * cosine);
  return side == 0 ? outwards : -outwards;
}

SectionPoint crown_centre(const Model& model, const RollingContact& contact, int side) noexcept {
  const Cant& cant = model.cant[side];
  const CrownTop top = crown_top(cant, model.head_z[side], model.crown_radius[side]);
  const double cosine = 1. / std::sqrt(1. + contact.slope * contact.slope);
  const double in_track[3] = {0., side_of_crown(contact, side), -contact.crown_radius * cosine};
  double in_section[3];
  to_rail(cant, in_track, in_section);
  return {top.y + in_section[1], top.z + in_section[2]};
}

SeatFlexibility seat_flexibility(const Model& model, const RunnerModel& runner, int side,
                                 const RailForce& place) noexcept {
  SeatFlexibility all = seat_flexibility_beside(model, runner, side, place);
  all.along[1][1] += residual_under(model, place);
  return all;
}

SeatFlexibility seat_flexibility_beside(const Model& model, const RunnerModel& runner, int side,
                                        const RailForce& place) noexcept {
  const ResidualModel& r = model.residual;
  if (r.seat == nullptr || place.load_point == kNoLoadPoint) return {};
  const std::ptrdiff_t seat = 2 * (&runner - model.runner) + side,
                       row = seat * r.elements + place.element % r.elements;
  const Cubic at = cubic(r.points, place.xi);
  const double* const value = r.seat + (row * (r.points + 1) + at.first) * kSeatResiduals;
  double own[kSeatResiduals];
  for (int i = 0; i < kSeatResiduals; ++i)
    own[i] = (at.weight[0] * value[i] + at.weight[1] * value[kSeatResiduals + i]) +
             (at.weight[2] * value[2 * kSeatResiduals + i] +
              at.weight[3] * value[3 * kSeatResiduals + i]);
  const auto of = [&own](SeatResidual which) noexcept { return own[static_cast<int>(which)]; };
  const double yz = of(SeatResidual::yz), yr = of(SeatResidual::yr), zr = of(SeatResidual::zr);
  return {{{of(SeatResidual::yy), yz, yr},
           {yz, of(SeatResidual::zz), zr},
           {yr, zr, of(SeatResidual::rr)}}};
}

bool seats_mirror(const Model& model) noexcept {
  const Cant &left = model.cant[0], &right = model.cant[1];
  bool mirror = left.cosine == right.cosine && left.sine == -right.sine &&
                model.head_z[0] == model.head_z[1] &&
                model.crown_radius[0] == model.crown_radius[1] &&
                (model.p_delta.lever[0] == nullptr) == (model.p_delta.lever[1] == nullptr);
  for (std::int32_t l = 0; l < model.lines; ++l) {
    const LineModel& line = model.line[l];
    const double of_left = line.rail_factor[0], of_right = line.rail_factor[1];
    mirror = mirror && line.mirrored != 0 && line.unknown_of[0] == line.unknown_of[1] &&
             of_left != 0. && (of_left == of_right || of_left == -of_right);
  }
  return mirror;
}

SeatLean seat_lean(const Model& model, const RollingContact& contact, int side,
                   double roll) noexcept {
  const SectionPoint centre = crown_centre(model, contact, side);
  double up[3];
  to_rail(model.cant[side], kUp, up);
  // The row has the slope of what is a square of rolls, so that it gives twice its value.
  const double lean = roll * (centre.z * up[2] + centre.y * up[1]);
  return {lean, .5 * roll * lean};
}

void locate_mirrored_seats(const Model& model, const Configuration& at, const RunnerModel& runner,
                           double x, WheelSeatRow* seat, RailForce* place) noexcept {
  const auto [on_rail, element, xi] = place_on_rails(model, x);
  for (int side = 0; side < 2; ++side) {
    clear(on_rail, side, element, seat + kWheelSeatRows * side, place + kWheelSeatRows * side);
    if (on_rail)
      place[kWheelSeatRows * side + 1] = {model, runner.load_point[side], element, xi, 0.};
  }
  if (!on_rail) return;
  double shape[3];
  shape_functions(xi, shape);
  const bool rigid = has_rigid_sections(model);
  const SectionPoint crown = crown_centre(model, runner.contact, 0);
  fill_seat_rows(model, rigid ? SectionPoint{0., 0.} : crown, 0, shape, seat);
  for (int side = 0; side < 2 && rigid; ++side)
    for (int d = 0; d < 2; ++d)
      seat[kWheelSeatRows * side + d].lean =
          -by_roll(model.cant[side], crown_centre(model, runner.contact, side), kAlong[d]);
  if (!has_levers(model)) return;
  SeatMotions motions;
  for (int side = 0; side < 2; ++side) {
    RailRow& row = seat[kWheelSeatRows + side].row;
    row = {};
    row.rail = side;
    row.element = element;
    if (model.form == Form::condensed)
      take_levers(seat_levers(model, side, element, xi), row);
    else
      seat[kWheelSeatRows * side + 1].rise = -add_levers(model, at, xi, kUp, row, motions);
  }
}

void locate_wheel_seat(const Model& model, const Configuration& at, const RunnerModel& runner,
                       double x, int side, SeatMotions& seats, WheelSeatRow* seat,
                       RailForce* place) noexcept {
  const auto [on_rail, element, xi] = place_on_rails(model, x);
  clear(on_rail, side, element, seat, place);
  if (!on_rail) return;
  double shape[3];
  shape_functions(xi, shape);
  const SectionPoint centre = crown_centre(model, runner.contact, side);
  fill_seat_rows(model, centre, side, shape, seat);
  const double roll = motion(model, seat[2].row, at);
  seat[1].rise = seat_lean(model, runner.contact, side, roll).rise -
                 add_p_delta(model, at, roll, xi, centre.y, centre.z, kUp, seat[1].row, seats);
  place[1] = {model, runner.load_point[side], element, xi, 0.};
}

}  // namespace railstep
