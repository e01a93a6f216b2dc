#pragma once
#include "online/runner/rolling_contact.h"

namespace railstep {

/// Derivatives of WheelForce::generalised over kPlaced and over the rates of the motions.
struct WheelSlopes {
  double by_motion[6][4], by_rate[6][6];
};

/// wheel_force() with all derivatives. @param side  1 of the left wheel, -1 of the right
/// @param u, v  [6] motions of the wheelset over rails that stand still, and their rates
WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, WheelSlopes& slopes);

}  // namespace railstep
