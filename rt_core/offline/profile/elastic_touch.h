#pragma once
#include <vector>

#include "offline/math/constants.h"
#include "offline/profile/wheel_rail.h"
#include "online/patch/strip_patch.h"

namespace railstep {

/// Two like elastic bodies.
struct Elastic {
  double young = kSteelYoung, poisson = kSteelPoisson;  // Pa, 1
};

/// A contact patch of a wheel.
struct WheelPatch {
  WheelTouch deepest;  // where the bodies would overlap most
  double approach;     // along the normal, m
  double upright;      // part of the normal force, N
  PatchForce force;    // its centre is along the contact plane
  WheelTouch centre;   // at the centre of its pressure
  double share;        // WheelZone::share; of the forces it is taken
};

/// A wheel under load.
struct WheelLoaded {
  double height;                    // of the axle's middle above the top of rail, m
  double approach;                  // upwards, beyond first contact, m
  std::vector<WheelPatch> patches;  // in the order of s
  /// Growth of the rolling radius, its mean over the normal forces, m.
  [[nodiscard]] double growth() const;
};

/// A wheelset that carries the same upright force on both wheels, at its shift.
struct WheelsetLoaded {
  double shift, roll;  // m, rad as in WheelsetTouch
  WheelLoaded right, left;
  [[nodiscard]] double radius_difference() const { return right.growth() - left.growth(); }
};

/// The wheelset without yaw at a shift under `force` upright on each wheel, N, above 0: it rolls
/// until both wheels carry it. Patches are those of patch_force(), each by itself, with one
/// approach upwards. Throws Refused as touch() does, where the rails do not carry the force within
/// 3 mm, and where no roll near that of rigid contact lets both wheels carry it.
WheelsetLoaded loaded(const WheelRail& pair, const Elastic& bodies, double shift, double force);

}  // namespace railstep
