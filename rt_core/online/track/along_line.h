#pragma once
#include "online/model/design_line.h"

namespace railstep {

// The design line at a place, m along the track's middle. Nothing sums up along the way, so that a
// place at 1000 km is as exact as the number that says it.

/// A quantity of the line and its derivative along it.
struct LineValue {
  double value, slope;
};
LineValue value_at(const LineTable& table, Transition transition, double place) noexcept;

/// Integral of a quantity from one place to another, and the integral of that one.
struct LineIntegral {
  double once, twice;
};
/// @param pieces  how many of the table lie between both places at most
LineIntegral integral(const LineTable& table, Transition transition, std::int32_t pieces,
                      double from, double to) noexcept;

/// Roll of the track, rad, its sine and cosine, and its derivative along the line, rad/m.
struct TrackRoll {
  double angle, sine, cosine, slope;
};
TrackRoll roll_at(const DesignLine& line, double place) noexcept;

/// How a frame that goes along the line rotates by a metre of way: about its own x, y and z, rad/m.
struct FrameRotation {
  double x, y, z;
};
FrameRotation rotation_at(const DesignLine& line, double place) noexcept;

/// The frame at one place in the frame at another one: displacement, m, and rotation, rad, and how
/// they change by a metre of way of both. Of first order in the angle between both, and along x of
/// second order.
struct FramePose {
  double pose[6], per_way[6];
};
FramePose pose_between(const DesignLine& line, double from, double to) noexcept;

/// A frame's motion as a body at rest in it feels it. `acceleration` is that of the frame's origin
/// less that of gravity, beyond its value on straight, level track, m/s2; `rate` is the angular
/// rate, rad/s, and `angular` its derivative, rad/s2.
struct FrameMotion {
  double acceleration[3], rate[3], angular[3];
};
/// @param speed, faster  m/s, m/s2
/// @param span           s, in which a jump of a rate takes place; 0: angular accelerations are
///                       those at one curvature
FrameMotion frame_motion(const DesignLine& line, double place, double speed, double faster,
                         double span, double gravity) noexcept;

}  // namespace railstep
