#pragma once
#include "online/model/contact_id.h"
#include "online/track/p_delta.h"
#include "online/track/residual.h"

namespace railstep {

/// A row of a seat under a runner's wheel.
struct WheelSeatRow {
  bool on_rail;
  double rise;  // m, of second order in the roll of the rail (track/p_delta.h)
  RailRow row;
};

/// The rows of the seat under a wheel at a place along the model's elements.
/// @param seats  of one configuration
/// @param seat   [kWheelSeatRows] out
/// @param place  [kWheelSeatRows] out: of the row along z for the residual flexibility
void locate_wheel_seat(const Model& model, const Configuration& at, const RunnerModel& runner,
                       double x, int side, SeatMotions& seats, WheelSeatRow* seat,
                       RailForce* place) noexcept;

}  // namespace railstep
