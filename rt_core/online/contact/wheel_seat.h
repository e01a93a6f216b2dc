#pragma once
#include "online/model/contact_id.h"
#include "online/track/p_delta.h"
#include "online/track/residual.h"

namespace railstep {

/// A row of a seat under a runner's wheel.
struct WheelSeatRow {
  bool on_rail;
  double rise;  // m, of second order in the roll of the rail (track/p_delta.h)
  double lean;  // m: of rows along y and z, minus their part by the roll that is not in `row`
  RailRow row;
};

/// The centre of the crown in the rail's section: its contact with a centred wheel is in the middle
/// of the railhead.
struct SectionPoint {
  double y, z;  // m
};
/// Its place along y from the top of the railhead, m.
double side_of_crown(const RollingContact& contact, int side) noexcept;
SectionPoint crown_centre(const Model& model, const RollingContact& contact, int side) noexcept;

/// Residual displacements of a seat along its rows y, z and roll by unit forces along them, m/N,
/// rad/N, rad/(N m); symmetric.
struct SeatFlexibility {
  double along[kWheelSeatRows][kWheelSeatRows];
};
/// @param place  of its row along z
SeatFlexibility seat_flexibility(const Model& model, const RunnerModel& runner, int side,
                                 const RailForce& place) noexcept;
/// The same without residual_under(), where residual_displacement() has the forces along z of all
/// wheels.
SeatFlexibility seat_flexibility_beside(const Model& model, const RunnerModel& runner, int side,
                                        const RailForce& place) noexcept;

/// Displacement along a row by the forces of a wheel on its seat.
/// @param flexibility  [kWheelSeatRows] of the row by unit forces along those of the seat
/// @param wheel_force  [kWheelForces] State::wheel_force
inline double moved_by_wheel(const double* flexibility, const double* wheel_force) noexcept {
  return flexibility[2] * wheel_force[3] -
         (flexibility[0] * wheel_force[1] + flexibility[1] * wheel_force[2]);
}

/// Whether seats at one place of both rails have rows that are mirror images, so that one of them
/// serves both: every line has both rails alike.
bool seats_mirror(const Model& model) noexcept;

/// Effect of the roll of the section under a seat on its row along z.
struct SeatLean {
  double lean, rise;  // m
};
/// @param roll  rad
SeatLean seat_lean(const Model& model, const RollingContact& contact, int side,
                   double roll) noexcept;

/// The rows of both seats under a wheelset, where seats mirror. The first three are those of the
/// left seat, without the effect of the roll of the section there. On sections that do not strain
/// rows along y and z are those of the axis: the crown has the roll besides, WheelSeatRow::lean. If
/// the model has levers (p_delta.h), the next two are the parts of the left and of the right row
/// along z by the rolls over seats. On condensed lines their levers are those of SeatLevers, and
/// lean_on_seats() multiplies them with the rolls.
/// @param seat, place  [2 kWheelSeatRows] out
void locate_mirrored_seats(const Model& model, const Configuration& at, const RunnerModel& runner,
                           double x, WheelSeatRow* seat, RailForce* place) noexcept;

/// The rows of the seat under a wheel at a place along the model's elements, with the effect of the
/// rail's roll.
/// @param seats  of one configuration
/// @param seat   [kWheelSeatRows] out
/// @param place  [kWheelSeatRows] out: of the row along z for the residual flexibility
void locate_wheel_seat(const Model& model, const Configuration& at, const RunnerModel& runner,
                       double x, int side, SeatMotions& seats, WheelSeatRow* seat,
                       RailForce* place) noexcept;

}  // namespace railstep
