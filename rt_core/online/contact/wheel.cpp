#include "online/contact/wheel.h"

#include <cmath>

#include "online/math/sine.h"
#include "online/math/vector3.h"
#include "online/track/p_delta.h"
#include "online/track/rail_point.h"

namespace railstep {

namespace {

constexpr int kWindow = 2;  // elements of the search: the wheel's and the nearest other
constexpr int kWindowNodes = 3 * kWindow;  // elements on both sides of a joint share none

struct Window {
  std::int32_t first;  // element
  std::int32_t elements;
  double nodes[9 * kWindowNodes];  // [elements][3][9]
};

/// Adds a line's displacements of a window's nodes, for both rails together: a line with one table
/// moves both rails alike, up to sign and weight.
void gather_line(const LineModel& line, const Configuration& at, Window* sides) noexcept {
  const std::int32_t from = 27 * sides[0].first, nodes = 3 * sides[0].elements;
  const std::int32_t* left = line.unknown_of[0] + from;
  const std::int32_t* right = line.unknown_of[1] + from;
  double of_left[9], of_right[9];
  for (int k = 0; k < 9; ++k) {
    of_left[k] = weight_of(line, 0, k);
    of_right[k] = weight_of(line, 1, k);
  }
  double moved_left[9] = {}, moved_right[9] = {};  // of the node before: borders are shared
  for (std::int32_t i = 0; i < nodes; ++i)
    for (int k = 0; k < 9; ++k) {
      const std::int32_t j = 9 * i + k, a = left[j], b = right[j];
      const bool same = i > 0 && a == left[j - 9] && b == right[j - 9];
      if (!same) moved_left[k] = a < 0 ? 0. : unknown_value(line, a, at);
      if (!same) moved_right[k] = b < 0 ? 0. : a == b ? moved_left[k] : unknown_value(line, b, at);
      if (a >= 0) sides[0].nodes[j] += of_left[k] * moved_left[k];
      if (b >= 0) sides[1].nodes[j] += of_right[k] * moved_right[k];
    }
}

/// Displacements of the nodes around x.
void gather(const Model& model, double x, const Configuration& at, Window* sides) noexcept {
  const double scaled = x / model.element_length - .5;  // 1.2: right half of element 1
  Window window{};
  window.elements = model.elements < kWindow ? model.elements : kWindow;
  if (scaled > 0. && scaled < model.elements) window.first = static_cast<std::int32_t>(scaled);
  if (scaled >= model.elements || window.first > model.elements - window.elements)
    window.first = model.elements - window.elements;
  sides[0] = sides[1] = window;
  for (std::int32_t l = 0; l < model.lines; ++l) gather_line(model.line[l], at, sides);
}

/// From displacements in the rail's axes to positions in the track's axes, with rest added.
void add_rest(const Model& model, int rail, Window& window) noexcept {
  const Cant& cant = model.cant[rail];
  for (std::int32_t i = 0; i < 3 * window.elements; ++i) {
    double* q = window.nodes + 9 * i;
    const std::int32_t node = 2 * (window.first + i / 3) + i % 3;
    q[4] += 1.;
    q[8] += 1.;
    keep_section(q);
    double own[9];
    for (int k = 0; k < 9; ++k) own[k] = q[k];
    for (int k = 0; k < 9; k += 3) to_track(cant, own + k, q + k);
    q[0] += .5 * model.element_length * node;
    q[1] += model.rail_y[rail];
    q[2] += model.rail_z[rail];
  }
}

/// Accurate to 1e-9 up to half a radian; the wheelset's roll and yaw stay far below.
double sine(double x) noexcept { return x * sinc_series(x * x, 8); }
double cosine(double x) noexcept { return cosine_series(x * x, 8); }

/// Position of a wheelset: its centre and its axes; the first axis does not roll.
struct Pose {
  double centre[3], ahead[3], axle[3], up[3];
};

Pose pose_of(const WheelsetModel& w, const double* p) noexcept {
  const double centre[3] = {w.start + p[0], p[1], w.rest_z + p[2]};
  const double sr = sine(p[3]), cr = cosine(p[3]), sy = sine(p[5]), cy = cosine(p[5]);
  return {{centre[0], centre[1], centre[2]},
          {cy, sy, 0.},
          {-sy * cr, cy * cr, sr},
          {sy * sr, -cy * sr, cr}};
}

/// Interpolates [r, a, b] at a place of the window.
void interpolate_nodes(const Window& window, RailPlace place, const double* shape,
                       double* q) noexcept {
  const double* n = window.nodes + 27 * place.element;
  for (int k = 0; k < 9; ++k) q[k] = shape[0] * n[k] + shape[1] * n[9 + k] + shape[2] * n[18 + k];
}

/// Roll of a section about x from rest, rad; q of a node in the track's axes.
double section_roll(const Cant& cant, const double* q) noexcept {
  double a[3], b[3];
  to_rail(cant, q + 3, a);
  to_rail(cant, q + 6, b);
  return .5 * (a[2] - b[1]);
}

/// Start of a search in a window: at x on the straight rail.
RailPlace guess(const Model& model, const Window& window, double x) noexcept {
  double at = x / model.element_length - window.first;
  if (!(at > 0.)) at = 0.;
  if (at > window.elements) at = window.elements;
  const int element = static_cast<int>(at);
  return {element, 2. * (at - element) - 1.};
}

/// Row of the material point (y, z) along the normal. If an irregular rail moves along x, the
/// height of the steel behind arrives: the row leans back by the slope.
void fill_row(const Cant& cant, const double* shape, double slope, WheelContact& at) noexcept {
  const double along[3] = {at.normal[0] - slope, at.normal[1], at.normal[2]};
  set_point_row(cant, at.y, at.z, shape, along, at.row);
}

/// d(gap)/d(coordinates) of the wheelset. @param arm  from its centre to the force, m
void fill_body_row(const Pose& body, const double* arm, WheelContact& at) noexcept {
  double lever[3];
  cross(arm, at.normal, lever);
  for (int d = 0; d < 3; ++d) at.body_row[d] = at.normal[d];
  at.body_row[3] = body.ahead[0] * lever[0] + body.ahead[1] * lever[1];
  at.body_row[4] = 0.;  // the normal meets the axle, or the face is right below: no torque about it
  at.body_row[5] = lever[2];
}

/// Finds the contact of wheel `side`: closest approach of its axle and the crown's centre curve,
/// then the material point of the railhead under the normal.
WheelContact find_contact(const Model& model, const WheelsetModel& w, const SignalModel& tread,
                          int side, const Configuration& now, double ahead, const Window& window,
                          SeatMotions& seats) noexcept {
  const Pose body = pose_of(w, now.u + w.first);
  const double *const centre = body.centre, *const axle = body.axle;
  WheelContact at{};
  at.row.rail = side;
  const double z_crown = model.head_z[side] - model.crown_radius[side];
  const WheelOnRail found = locate_wheel({window.elements, window.nodes, 27}, centre, axle, z_crown,
                                         guess(model, window, centre[0]));
  at.cap_reached = found.status == LocateStatus::cap_reached;
  at.on_rail = found.status == LocateStatus::found || at.cap_reached;
  if (std::fabs(std::fabs(found.along) - std::fabs(model.rail_y[side])) > w.tread_half_width)
    at.on_rail = false;
  if (!at.on_rail) return at;

  at.row.element = window.first + found.place.element;
  at.xi = found.place.xi;
  double shape[3];
  shape_functions(at.xi, shape);
  for (int d = 0; d < 3; ++d) at.normal[d] = found.normal[d];
  double q[9];
  interpolate_nodes(window, found.place, shape, q);
  // The crown's material point under the normal: a railhead that is squeezed carries it along.
  const double n_a = dot(at.normal, q + 3), n_b = dot(at.normal, q + 6);
  const double length = std::sqrt(n_a * n_a + n_b * n_b);
  at.y = model.crown_radius[side] * (n_a / length);
  at.z = z_crown + model.crown_radius[side] * (n_b / length);
  if (!(std::fabs(at.y) <= model.head_half_width[side])) at.on_rail = false;
  const double arm[3] = {found.along * axle[0], found.along * axle[1], found.along * axle[2]};
  // Irregularities are those of the steel right under the axle. The nearest point is beside it by
  // the radius times the rail's slope. If they were read there, they would do work as the rail
  // bends, which contact at the nearest points of the true shapes does not.
  const double x = (at.row.element + .5 * (at.xi + 1.)) * model.element_length +
                   (centre[0] + arm[0] - (q[0] + at.y * q[3] + at.z * q[6]));
  const double rolled = (now.track_offset + model.endless.origin) + now.u[w.first];
  const Irregularity off =
      irregularity(model, tread, side, at.normal, (x + now.track_offset) + ahead, rolled + ahead);
  fill_row(model.cant[side], shape, off.rail_slope, at);
  at.x = (at.row.element + .5 * (at.xi + 1.)) * model.element_length;
  at.roll = section_roll(model.cant[side], q);
  const double higher =
      add_p_delta(model, now, at.roll, at.xi, at.y, at.z, at.normal, at.row, seats);
  double gap = 0.;
  for (int d = 0; d < 3; ++d)
    gap += at.normal[d] * (centre[d] + arm[d] - (q[d] + at.y * q[3 + d] + at.z * q[6 + d]));
  at.penetration = (w.radius - gap) + off.depth + higher;
  at.irregularity = off.depth;
  at.slope = off.slope;
  fill_body_row(body, arm, at);
  return at;
}

/// Slope along x, in the direction of the normal, of the line of the material point of a contact.
double slope_along(const Model& model, const Window& window, RailPlace place,
                   const WheelContact& at) noexcept {
  const double per_metre = 2. / model.element_length, xi = place.xi;
  const double shape[3] = {(xi - .5) * per_metre, -2. * xi * per_metre, (xi + .5) * per_metre};
  double q[9];
  interpolate_nodes(window, place, shape, q);
  return dot(at.normal, q) + at.y * dot(at.normal, q + 3) + at.z * dot(at.normal, q + 6);
}

/// Finds the contact of flange `side` as find_flanges() describes.
WheelContact find_flange(const Model& model, const FlangeModel& flange, int side,
                         const Configuration& now, double ahead, const Window& window,
                         SeatMotions& seats) noexcept {
  const WheelsetModel& w = model.wheelset[flange.wheelset];
  const Pose body = pose_of(w, now.u + w.first);
  const double *const centre = body.centre, *const axle = body.axle, *const up = body.up;
  WheelContact at{};
  at.row.rail = side;
  double face[3];
  for (int d = 0; d < 3; ++d) {
    face[d] = centre[d] + (flange.point[side][0] * axle[d] + flange.point[side][1] * up[d]);
    at.normal[d] =
        (side == 0 ? flange.normal[0] : -flange.normal[0]) * axle[d] + flange.normal[1] * up[d];
  }
  const PointOnRail found =
      locate_point({window.elements, window.nodes, 27}, face, guess(model, window, face[0]));
  at.cap_reached = found.status == LocateStatus::cap_reached;
  at.on_rail = found.status == LocateStatus::found || at.cap_reached;
  if (!at.on_rail) return at;

  at.row.element = window.first + found.place.element;
  at.xi = found.place.xi;
  at.x = (at.row.element + .5 * (at.xi + 1.)) * model.element_length;
  at.y = flange.gauge[side][0];
  at.z = flange.gauge[side][1];
  double shape[3], q[9], arm[3], gap = 0.;
  shape_functions(at.xi, shape);
  interpolate_nodes(window, found.place, shape, q);
  for (int d = 0; d < 3; ++d) {
    const double gauge = q[d] + at.y * q[3 + d] + at.z * q[6 + d];
    arm[d] = gauge - centre[d];
    gap += at.normal[d] * (face[d] - gauge);
  }
  const double x = at.x + (face[0] - (centre[0] + arm[0]));
  const Irregularity off =
      irregularity(model, SignalModel{}, side, at.normal, (x + now.track_offset) + ahead, 0.);
  fill_row(model.cant[side], shape, off.rail_slope, at);
  at.roll = section_roll(model.cant[side], q);
  const double higher =
      add_p_delta(model, now, at.roll, at.xi, at.y, at.z, at.normal, at.row, seats);
  at.penetration = (off.depth + higher) - gap;
  at.irregularity = off.depth;
  at.slope = off.slope + slope_along(model, window, found.place, at);
  if (at.penetration > 0. && dot(arm, up) < flange.tip) at.on_rail = false;
  fill_body_row(body, arm, at);
  return at;
}

}  // namespace

Irregularity irregularity(const Model& model, const SignalModel& tread, int rail,
                          const double* normal, double x, double rolled) noexcept {
  const SignalValue round = signal_at(tread, rolled);
  Irregularity sum{round.value, round.slope, 0.};
  for (std::int32_t i = 0; i < model.signals; ++i) {
    const RailSignal& own = model.signal[i];
    if (own.rail != rail) continue;
    const SignalValue at = signal_at(own.signal, x);
    sum.depth += normal[own.direction] * at.value;
    sum.rail_slope += normal[own.direction] * at.slope;
  }
  sum.slope += sum.rail_slope;
  return sum;
}

void find_contacts(const Model& model, std::int32_t wheelset, const Configuration& at,
                   WheelContact* sides, double ahead) noexcept {
  const WheelsetModel& own = model.wheelset[wheelset];
  Window windows[2];
  SeatMotions seats;
  gather(model, own.start + at.u[own.first], at, windows);
  for (int side = 0; side < 2; ++side) {
    add_rest(model, side, windows[side]);
    sides[side] = find_contact(model, own, model.contact[tread_of(wheelset, side)].tread, side, at,
                               ahead, windows[side], seats);
  }
}

void find_flanges(const Model& model, const FlangeModel& flange, const Configuration& at,
                  WheelContact* sides, double ahead) noexcept {
  const WheelsetModel& wheelset = model.wheelset[flange.wheelset];
  Window windows[2];
  SeatMotions seats;
  gather(model, wheelset.start + at.u[wheelset.first], at, windows);
  for (int side = 0; side < 2; ++side) {
    add_rest(model, side, windows[side]);
    sides[side] = find_flange(model, flange, side, at, ahead, windows[side], seats);
  }
}

}  // namespace railstep
