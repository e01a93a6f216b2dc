#pragma once
#include "online/contact/locate.h"
#include "online/model/state.h"

namespace railstep {

/// Where one wheel meets its rail, frozen for a step; found on the configuration that the state's
/// velocities lead to.
struct WheelContact {
  bool on_rail;
  bool cap_reached;
  std::int32_t rail, element;
  double xi;
  double normal[3];    // unit, from the rail to the axle
  double y, z;         // of the contact in the section, m from the axis
  double shape[3];     // N1..N3 at xi
  double penetration;  // of that configuration, m; negative is a gap
  double body_row[6];  // d(gap)/d(coordinates) of the wheelset
};

/// Finds the contact of wheel `side` (0 left, 1 right) of a wheelset: closest approach of its axle
/// and the crown's centre curve, then the material point of the railhead under the normal.
/// @param displacement  [unknowns] of track and bodies at which to look
WheelContact find_contact(const Model& model, const WheelsetModel& wheelset, int side,
                          const double* displacement) noexcept;

/// Displacement of the contact's material point along the normal, over one line's unknowns.
double rail_motion(const LineModel& line, const WheelContact& at, const double* u) noexcept;

/// rhs += force * row of that displacement.
void spread(const LineModel& line, const WheelContact& at, double force, double* rhs) noexcept;

/// Vertical displacement of the rail's axis under the wheel, by the lines alone, m.
double axis_height(const Model& model, const WheelContact& at, const double* u) noexcept;

}  // namespace railstep
