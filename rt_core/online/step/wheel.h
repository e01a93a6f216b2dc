#pragma once
#include "online/contact/locate.h"
#include "online/model/state.h"
#include "online/step/line.h"

namespace railstep {

/// Where one wheel meets its rail, frozen for a step; found on the configuration that the state's
/// velocities lead to.
struct WheelContact {
  bool on_rail;
  bool cap_reached;
  double xi;
  double normal[3];    // unit, from the rail to the axle
  double y, z;         // of the contact in the section, m from the axis
  RailRow row;         // displacement of that material point along the normal
  double penetration;  // of that configuration, m; negative is a gap
  double body_row[6];  // d(gap)/d(coordinates) of the wheelset
};

/// Finds the contact of wheel `side` (0 left, 1 right) of a wheelset: closest approach of its axle
/// and the crown's centre curve, then the material point of the railhead under the normal.
/// @param at  displacements of track and bodies at which to look
WheelContact find_contact(const Model& model, const WheelsetModel& wheelset, int side,
                          const Configuration& at) noexcept;

/// Vertical displacement of the rail's axis under the wheel, by the lines alone, m.
double axis_height(const Model& model, const WheelContact& wheel, const Configuration& at) noexcept;

}  // namespace railstep
