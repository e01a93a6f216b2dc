#pragma once
#include "online/contact/locate.h"
#include "online/model/state.h"
#include "online/track/line.h"

namespace railstep {

/// Contact of one wheel with its rail, frozen for a step and found on the configuration that the
/// state's velocities lead to.
struct WheelContact {
  bool on_rail;
  bool on_ground;  // of a vehicle: it rolls on level ground before or behind the rail
  bool inactive;   // of a flange: too far from its rail to take part in the step
  bool cap_reached;
  double xi;
  double x;             // of the contact along the undeformed rail, m
  double normal[3];     // unit, from the rail to the axle
  double y, z;          // of the contact in the section, m from the axis
  RailRow row;          // displacement of that material point along the normal
  double roll;          // of the rail's section there about x, rad
  double penetration;   // of that configuration, m; negative is a gap
  double body_row[6];   // d(gap)/d(coordinates) of the wheelset
  double irregularity;  // part of the penetration by irregularities, m
  double slope;         // of `irregularity`, per metre of the wheel's motion
};

/// Part of the penetration along a normal by irregularities, m, and its slope over x. It is of
/// first order: the normal is that of the true shapes.
/// @param tread   of the wheel
/// @param x       of the contact along the track, m
/// @param rolled  distance that the wheel has gone, m
struct Irregularity {
  double depth, slope;
  double rail_slope;  // part of the slope by the rail, which moves with its steel
};
Irregularity irregularity(const Model& model, const SignalModel& tread, int rail,
                          const double* normal, double x, double rolled) noexcept;

/// Finds the contacts of a wheelset's left and right wheel.
/// @param at     displacements of track and bodies
/// @param sides  [2] left, right
/// @param ahead  m; irregularities are those at this distance ahead
void find_contacts(const Model& model, std::int32_t wheelset, const Configuration& at,
                   WheelContact* sides, double ahead = 0.) noexcept;

/// Finds the contacts of a wheelset's left and right flange, each in the rail's section through its
/// face: X the gauge face's point there, c the wheelset's centre, n the face's normal, R its
/// rotation,
///   gap = n.(c + R point - X),  d(gap) = n.(dc - dX) + ((X - c) x n).(rotation of the wheelset),
/// so that a force f n on the wheelset at X is opposite to that on the rail. A flange whose tip is
/// over X on the rail's side has left the rail: on_rail is false. `slope` includes the rail's own
/// slope. Arguments are those of find_contacts().
void find_flanges(const Model& model, const FlangeModel& flange, const Configuration& at,
                  WheelContact* sides, double ahead = 0.) noexcept;

}  // namespace railstep
