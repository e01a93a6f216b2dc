#pragma once
#include "online/runner/runner_contact.h"

namespace railstep {

/// Derivatives of WheelForce::generalised, and of its moment on the rail's section as a seventh
/// row, over kPlaced, the rates of the motions, the section's roll and its rate.
struct WheelSlopes {
  double by_motion[7][4], by_rate[7][6], by_section[7], by_section_rate[7];
};

/// force_on_wheel() with all derivatives on rails that stand still. By cones they are exact; by
/// profiles they are central differences, with all that moves along the profiles.
/// @param side  1 of the left wheel, -1 of the right
/// @param v     [6] rates of the wheelset's motions
WheelForce force_on_wheel(const RollingContact& c, double radius, double side,
                          const Rolling& rolling, const OverRail& at, const double* v,
                          WheelSlopes& slopes);

}  // namespace railstep
