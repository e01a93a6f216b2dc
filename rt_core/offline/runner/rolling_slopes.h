#pragma once
#include "online/runner/rolling_contact.h"

namespace railstep {

/// Derivatives of WheelForce::generalised, and of its force across as a seventh row, over kPlaced,
/// the rates of the motions, and slip across that none of these makes.
struct WheelSlopes {
  double by_motion[7][4], by_rate[7][6], by_across[7];
};

/// wheel_force() with all derivatives. @param side  1 of the left wheel, -1 of the right
/// @param u, v  [6] motions of the wheelset over rails that stand still, and their rates
WheelForce wheel_force(const RollingContact& c, double radius, double side, double speed,
                       const double* u, const double* v, WheelSlopes& slopes);

}  // namespace railstep
