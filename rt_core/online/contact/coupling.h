#pragma once
#include "online/contact/ports.h"
#include "online/contact/wheel.h"
#include "online/contact/wheel_seat.h"
#include "online/math/newton.h"
#include "online/track/residual.h"

namespace railstep {

/// A wheelset's six coordinates in a step, before wheel forces and multipliers.
struct FreeWheelset {
  double compliance[6];  // m/N or rad/(N m)
  double free[6];
};

inline constexpr int kMaxWheelSeatRows = 2 * kWheelSeatRows * kMaxSeatedWheelsets;
inline constexpr int kMaxTrackRows = kMaxWheels + kMaxWheelSeatRows;

/// A step's coupled problem: positions of the track and of the bodies on it without contact, and
/// the responses of both to contact forces. Not zero-initialised; each entry is written before it
/// is read.
struct Coupling {
  int contacts, rows, ports;  // rows of the track (contact_id.h); ports: these, then the fixed ones
  WheelContact contact[kMaxWheels];
  WheelSeatRow seat[kMaxWheelSeatRows];
  RailForce place[kMaxTrackRows];
  Panels panels[kMaxTrackRows][kMaxLines];  // of its response, in banded lines that it moves
  double by_loads[kMaxTrackRows];           // residual displacement by the loads, m
  double located[kMaxTrackRows];  // displacement of the lines when contacts were located, m
  FreeWheelset wheelset[kMaxWheelsets];
  double vehicle[kMaxVehicles][kMaxVehicleUnknowns];  // coordinates without wheel forces
  double* W;                                          // [ports][ports] m/N
  PortLaw law[kPorts];                                // of the contacts, then of the fixed ports
  /// Penetration from the track and the frozen geometry, of a seat the displacement, m, rad.
  double track_free[kPorts + kMaxWheelSeatRows];
  double force[kPorts + kMaxWheelSeatRows];  // N, N m, against each row
  double penetration[kPorts];                // m; of scenes without runners [ports]
};

inline const RailRow& track_row(const Coupling& c, int row) noexcept {
  return row < c.contacts ? c.contact[row].row : c.seat[row - c.contacts].row;
}
inline bool is_on_rail(const Coupling& c, int row) noexcept {
  return row < c.contacts ? c.contact[row].on_rail : c.seat[row - c.contacts].on_rail;
}

}  // namespace railstep
