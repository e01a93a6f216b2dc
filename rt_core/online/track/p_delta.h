#pragma once
#include "online/track/line.h"

namespace railstep {

// The effect that a linear rail misses when it rolls (P-delta). A section that rolls by
// phi = (a_z - b_y)/2 about x keeps its shape: the nonlinear element shortens its slopes,
// b_z = a_y = -phi^2/2 to second order. By this a vertical force V on the head, z above the axis,
// does work: the moment V z phi rolls the rail further, and so does each seat's reaction R at the
// foot, by R |z_foot| phi. A linear rail has neither. Both are added at the force, on the row of
// its displacement.

/// Shortens a section's slopes by its roll. @param q  [9] r, a, b; or their change from rest
inline void keep_section(double* q) noexcept {
  const double roll = .5 * (q[5] - q[7]), shorter = .5 * roll * roll;
  q[4] -= shorter;
  q[8] -= shorter;
}

/// Whether rolls over seats count in the rows of contacts.
inline bool has_levers(const Model& model) noexcept {
  return model.p_delta.lever[0] != nullptr || model.p_delta.lever[1] != nullptr;
}

/// Motions of the nodes over seats by each line, for their roll. If a line moves both rails alike,
/// the other rail takes them from here.
struct SeatMotions {
  std::int32_t first = -kPDeltaSeats;        // seat; none yet
  double value[kMaxLines][kPDeltaSeats][2];  // a_z and b_y, before their weights in the rail
};

/// The seats around a point of a rail, and the share of its vertical force that each carries times
/// the height of its pad above the axis, m.
struct SeatLevers {
  std::int32_t first, count;          // of the seats around: that of the first, and how many are
  std::int32_t number[kPDeltaSeats];  // which of the seats around, from 0
  std::int32_t node[kPDeltaSeats];    // of the rail
  double lever[kPDeltaSeats];
};
/// None where the rolls over seats do not count.
SeatLevers seat_levers(const Model& model, std::int32_t rail, std::int32_t element,
                       double xi) noexcept;

/// Puts levers into a row that has none yet. lean_on_seats() multiplies them with the rolls.
void take_levers(const SeatLevers& around, RailRow& row) noexcept;

/// Multiplies the levers of a row with the rolls over their seats.
/// @param roll  [row.seats] rad, `first` of each
/// @param up    component along z of the row's direction
/// @returns rise along it, m
double lean_on_seats(const TwoMotions* roll, double up, RailRow& row) noexcept;

/// Adds to a row along a normal the rolls over the seats around, by which it rises. The row has
/// none yet.
/// @returns rise of its point along the normal, m. Other parameters: those of add_p_delta()
double add_levers(const Model& model, const Configuration& at, double xi, const double* normal,
                  RailRow& row, SeatMotions& motions) noexcept;

/// Adds to the row of the point (y, z) along a normal the effect of the section's roll under it and
/// of the rolls over the seats around; without roll it adds nothing.
/// @param roll     of the section under the point, rad
/// @param xi       of the point in row.element
/// @param normal   [3] unit, in the track's axes
/// @param motions  of one configuration
/// @returns rise of the point along the normal by the rolls over the seats, m. The effect of the
///          roll under the point itself is in places to which keep_section() was applied
double add_p_delta(const Model& model, const Configuration& at, double roll, double xi, double y,
                   double z, const double* normal, RailRow& row, SeatMotions& motions) noexcept;

/// Square of the roll above which the row's second order is off by more than 1 %: half of phi^2,
/// from the series of its sine and cosine.
inline constexpr double kLargeRollSquared = .02;

}  // namespace railstep
