#pragma once
#include "online/contact/ports.h"
#include "online/contact/wheel.h"
#include "online/contact/wheel_seat.h"
#include "online/math/dense.h"
#include "online/math/newton.h"
#include "online/model/contact_id.h"
#include "online/track/residual.h"

namespace railstep {

/// A wheelset's six coordinates in a step, before wheel forces and multipliers.
struct FreeWheelset {
  double free[6];
  double held[kGuideRows];  // force of a guide by elimination on the track, without contact
};

inline constexpr int kMaxWheelSeatRows = 2 * kWheelSeatRows * kMaxSeatedWheelsets;
inline constexpr int kMaxTrackRows = kMaxWheels + kMaxWheelSeatRows;

/// A step's coupled problem: positions of the track and of the bodies on it without contact, and
/// the responses of both to contact forces. Not zero-initialised; each entry is written before it
/// is read.
struct Coupling {
  int contacts, rows, ports;  // rows of the track (contact_id.h); ports: these, then the fixed ones
  int bases;                  // rows along which the lines are moved: see base_row()
  bool mirrored;              // one base serves the seats of both rails
  int of_set;                 // bases of a wheelset of runners
  bool shapes_levers;         // the shapes of bases by levers are needed, else those of the rolls
  WheelContact contact[kMaxWheels];
  WheelSeatRow seat[kMaxWheelSeatRows];
  RailForce place[kMaxTrackRows];
  bool acts[kMaxTrackRows][kMaxLines];      // whether forces along a base move a line
  Panels panels[kMaxTrackRows][kMaxLines];  // of a base's response, in banded lines that it moves
  double by_loads[kMaxTrackRows];           // residual displacement by the loads, m
  double rail_depth[kMaxWheels];  // penetration when located, less the lift by the bodies, m
  double located[kMaxTrackRows];  // displacement of the lines when contacts were located, m
  double moved[kMaxTrackRows];    // without contact forces since then, m
  FreeWheelset wheelset[kMaxWheelsets];
  double* W;            // [ports][ports] m/N
  PortLaw law[kPorts];  // of the contacts, then of the fixed ports
  /// Penetration from the track and the frozen geometry, of a seat the displacement, m, rad.
  double track_free[kPorts + kMaxWheelSeatRows];
  double force[kPorts + kMaxWheelSeatRows];  // N, N m, against each row
  double penetration[kPorts];                // m; of scenes without runners [ports]
};

inline ContactIds contacts(const Coupling& c) noexcept { return {0, c.contacts}; }

/// Displacement along a coordinate of a wheelset by a unit force along it, m/N or rad/(N m).
inline double compliance_of(const WheelsetModel& set, int k) noexcept {
  return set.inverse[(kMotions + 1) * k];
}
/// Whether there is a rail or ground under a contact that acts.
inline bool stands(const WheelContact& at) noexcept { return at.on_rail || at.on_ground; }

/// The lift of a contact off its rail over the coordinates of its bodies, in the step's geometry.
inline const double* lift_row(const Model& model, const Coupling& c, ContactId i) noexcept {
  return is_upright(model, i) ? model.contact[i].row : c.contact[i].body_row;
}
/// Coordinate k of these bodies moved by a unit force there; a wheelset's inverse is diagonal.
inline double moved_by_force(const Model& model, const Coupling& c, ContactId i, int k) noexcept {
  const ContactModel& own = model.contact[i];
  return is_upright(model, i)
             ? own.moved[k]
             : compliance_of(model.wheelset[own.bodies], k) * c.contact[i].body_row[k];
}
/// The lift of a contact by displacements or rates of all unknowns.
inline double lift_by(const Model& model, const Coupling& c, ContactId i,
                      const double* u) noexcept {
  const SuspendedModel& own = bodies_of(model, i);
  return dot(lift_row(model, c, i), u + own.first, own.size);
}

inline bool is_on_rail(const Coupling& c, int row) noexcept {
  return row < c.contacts ? c.contact[row].on_rail : c.seat[row - c.contacts].on_rail;
}

// Lines are moved along bases: the rows of contacts, then those of seats; where seats mirror, the
// rows of the left seat of each wheelset and then, if the model has levers (p_delta.h), those of
// its left and right seat along z.

/// The place of a base in Coupling::seat.
inline int seat_of_base(const Coupling& c, int base) noexcept {
  const int of_seats = base - c.contacts;
  return 2 * kWheelSeatRows * (of_seats / c.of_set) + of_seats % c.of_set;
}
inline const RailRow& base_row(const Coupling& c, int base) noexcept {
  return base < c.contacts ? c.contact[base].row : c.seat[seat_of_base(c, base)].row;
}
/// Whether a base is the part of a row by the levers of a rail.
inline bool is_by_levers(const Coupling& c, int base) noexcept {
  return c.mirrored && base >= c.contacts && (base - c.contacts) % c.of_set >= kWheelSeatRows;
}
/// The roll of the right rail by a line where seats mirror, over that of the left one.
constexpr double right_roll(const LineModel& line) noexcept {
  return line.rail_factor[1] == line.rail_factor[0] ? -1. : 1.;
}
/// Finds which lines forces along each base move, Coupling::acts.
inline void find_acting(const Model& model, Coupling& c) noexcept {
  for (int i = 0; i < c.bases; ++i) {
    const bool on_rail = i < c.contacts ? c.contact[i].on_rail : c.seat[seat_of_base(c, i)].on_rail;
    for (std::int32_t l = 0; l < model.lines; ++l)
      c.acts[i][l] = on_rail && carries(model.line[l], base_row(c, i));
  }
}

/// The rows of the track that a base is a part of on a line: factor times it. Rows along y and z
/// also have -lean times that of the roll.
struct RowsOfBase {
  int count, row[2];
  double factor[2];
};
inline RowsOfBase rows_of_base(const Coupling& c, int base, const LineModel& line) noexcept {
  if (base < c.contacts || !c.mirrored) return {1, {base, 0}, {1., 0.}};
  const int d = (base - c.contacts) % c.of_set, left = c.contacts + seat_of_base(c, base) - d;
  if (d >= kWheelSeatRows)
    return {1, {left + 1 + kWheelSeatRows * (d - kWheelSeatRows), 0}, {1., 0.}};
  const double roll = right_roll(line);
  return {2, {left + d, left + d + kWheelSeatRows}, {1., d == 1 ? -roll : roll}};
}

/// Subtracts from rows along y and z their part by the rolls. @param x  [rows]
inline void lean_rows(const Coupling& c, double* x) noexcept {
  for (int i = c.contacts; i < c.rows; i += kWheelSeatRows)
    for (int d = 0; d < 2; ++d) x[i + d] -= c.seat[i + d - c.contacts].lean * x[i + 2];
}

/// Adds a line's displacement along a base to those of its rows. @param x  [rows]
inline void add_to_rows(const Coupling& c, int base, const LineModel& line, double own,
                        double* x) noexcept {
  const RowsOfBase rows = rows_of_base(c, base, line);
  for (int k = 0; k < rows.count; ++k) x[rows.row[k]] += rows.factor[k] * own;
}

/// Sums up over lines and bases. @param value  value(base, line's number, line)
/// @param x  [rows] out
template <typename Value>
void sum_rows(const Model& model, const Coupling& c, const Value& value, double* x) noexcept {
  for (int i = 0; i < c.rows; ++i) x[i] = 0.;
  for (int i = 0; i < c.bases; ++i)
    for (std::int32_t l = 0; l < model.lines; ++l)
      if (c.acts[i][l]) add_to_rows(c, i, model.line[l], value(i, l, model.line[l]), x);
  lean_rows(c, x);
}

}  // namespace railstep
