#pragma once
#include "online/model/state.h"
#include "online/runner/rolling_contact.h"

namespace railstep {

// Wheels on rails by their profiles. Where a wheel touches is found for one place of the wheelset,
// and holds for places near it: strips and the shapes of patches do not change, and depths follow
// the place to second order.

/// Where a wheelset is over one of its rails.
struct OverRail {
  const double* motion;  // [6] of the wheelset over the rail's top, m and rad
  double section;        // roll of the rail's section, rad
};

/// How the normal of a contact leans across as the bodies move, to first order: a throat on a gauge
/// corner turns by 0.1 rad within 0.1 mm. With curvatures across w of the wheel and r of the rail,
/// k = w - r, a shift t of the wheel across and rolls a of the wheel and s of the rail about the
/// contact, its point goes (w t - a + s) / k over the rail, and the gap there grows by
///   -w r / (2 k) t^2 + t (r a - w s) / k,
/// less (a - s)^2 / (2 k). That term is left out, and so is the point's way in the arms of forces:
/// both are small within a step, and Newton's slopes would need them, too. The mean of 1/k over the
/// patch is shift_by_tilt(). A normal leans by at most 0.2 rad.
struct PatchTurn {
  double by_shift, by_roll, by_section;  // -w r / k, rad/m; r / k; -w / k
};

/// A normal force of a patch.
struct PatchNormal {
  double depth, normal, stiffness;  // m, N, N/m
};

struct ProfilePatch {
  WheelRows<double> rows;
  PatchTurn turn;
  double across_turned;  // slip across by a unit of yaw, over the wheel's spin, m
  RollingPatch creep;
  PatchNormal last;  // found in full; depths very near to it follow its power law
  WheelZone zone;
};

/// A wheel as it touches at one place.
struct ProfileWheel {
  double placed[4], section;  // that place: kPlaced over the rail, and the section's roll
  std::int32_t patches;       // also those that do not touch yet
  bool at_edge;  // a patch reaches the end of a profile, or the wheel is beside its rail
  ProfilePatch patch[kMostZones];
  ContactSlopes slopes[kMostZones];  // of the last evaluation with slopes
};

/// The wheels of a wheelset in the workspace, [2]. @param wheelset  among those of all runners
ProfileWheel* profile_wheels(const Workspace& w, std::int32_t wheelset) noexcept;

/// Finds where a wheel touches. Zones that are more than 0.2 mm off are left out; a wheel that is
/// more than 3 mm deep in its rail, as one that fell beside it may be, is beside it. A patch is as
/// long as Kik and Piotrowski's at its point of least gap and has its area; it is pressed, and has
/// its slope, at the centre of its pressure.
/// @param side  1 of the left wheel, -1 of the right
void find_profile_wheel(const RollingContact& c, double radius, double side, const OverRail& at,
                        ProfileWheel& wheel) noexcept;

/// Largest turn of the planes of those patches that touch, from the place at which the wheel was
/// found to another one, rad.
double turned_by(const ProfileWheel& wheel, const OverRail& at) noexcept;

/// Sum of the forces of a wheel's patches at a place near that at which it was found. Most depths
/// of a solve are within 1e-6 of one for which a patch's force was found in full. Their force is by
/// the power law that has its value and its slope there; it errs by less than 2e-10, and by up to
/// the distance itself where a strip begins to touch in between.
/// @param wheel  its patches keep the forces that were found in full
/// @param stiffness  [patches] out: of the normal forces, N/m
/// @param slopes     [patches] out; null: none
WheelForce profile_force(const RollingContact& c, ProfileWheel& wheel, double radius, double side,
                         const Rolling& rolling, const OverRail& at, const double* v,
                         const RailRate& rail, double* stiffness,
                         ContactSlopes* slopes = nullptr) noexcept;

}  // namespace railstep
