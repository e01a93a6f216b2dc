#pragma once
#include <cmath>

#include "online/model/runner_model.h"

namespace railstep {

/// Slip of the wheel over the rail at a contact, m/s, and spin, rad/s.
template <typename T>
struct Slip {
  T along, across, spin;
};

/// How a wheel rolls along its rail.
struct Rolling {
  double frame;  // speed of the wheelset's frame, m/s
  double over;   // speed over which slip gives creepages, m/s; negative backwards
  /// Slip that represents the creep of the step before, m/s, m/s and rad/s; 0 unless `keeps`. At a
  /// standstill creep is a spring.
  double left[3];
  bool keeps;
  double grip;  // part of the rail's friction at this place
  /// A wheelset that goes along with its frame.
  // NOLINTNEXTLINE(google-explicit-constructor)
  Rolling(double speed = 0., double of_friction = 1.) noexcept
      : frame(speed), over(speed), left{}, keeps(false), grip(of_friction) {}
};

/// Creep of a contact: forces on the wheel along and across, N, and the moment about the normal,
/// N m, and their derivatives.
struct ContactCreep {
  double force[3];
  double by_slip[3][3];  // over Slip's along, across and spin
  double by_normal[3];   // over the normal force, at the same slip
  double size;           // of linear creep over the limit; 0 of a law without one
  /// Linear creep would be at least three times the limit: it has saturated.
  bool slides() const noexcept { return size >= kSlides; }
  static constexpr double kSlides = 3.;  // Shen, Hedrick and Elkins
};

/// Where a contact in touch is pressed.
struct Pressed {
  /// Penetration beyond that at which the force begins, m, above 0; normal force, N.
  double depth, normal;
};

inline constexpr double kLeastRolling = .1;   // m/s: slower wheels have creepages over this speed
inline constexpr double kLeastNormal = 1e-6;  // N: a smaller normal force makes no creep
/// Reciprocal of the speed over which creepages are taken, s/m.
inline double per_rolling(double speed) noexcept {
  const double size = std::fabs(speed);
  return 1. / (size > kLeastRolling ? size : kLeastRolling);
}

/// Creep by a law with a limit, or of a patch that grows.
ContactCreep creep_by_law(const RollingCreep& c, const RollingPatch& patch, double friction,
                          const Pressed& pressed, const Slip<double>& slip, double speed,
                          CreepWanted wanted) noexcept;

/// Creep of a contact in touch by the scene's law. The moment is that of linear creep times
/// 1 - u/3 + u^2/27, u the linear force over the limit, and 1/u from u = 3 on.
/// @param friction  coefficient
/// @param speed  of the wheelset, m/s
inline ContactCreep contact_creep(const RollingCreep& c, const RollingPatch& patch, double friction,
                                  const Pressed& pressed, const Slip<double>& slip, double speed,
                                  CreepWanted wanted = CreepWanted::slopes) noexcept {
  if (!(pressed.normal > kLeastNormal)) return {};
  if (c.law != CreepLaw::linear || patch.exponent > 0.)
    return creep_by_law(c, patch, friction, pressed, slip, speed, wanted);
  const double per = per_rolling(speed), turned = speed < 0. ? -per : per;
  const double area = patch.half_length * patch.half_width, force = patch.shear * area;
  const double along = -force * patch.kalker.c11 * per, across = -force * patch.kalker.c22 * per,
               both = force * std::sqrt(area) * patch.kalker.c23 * turned,
               spin = -force * area * patch.kalker.c33 * per;
  return {{along * slip.along, across * slip.across - both * slip.spin,
           both * slip.across + spin * slip.spin},
          {{along, 0., 0.}, {0., across, -both}, {0., both, spin}},
          {},
          0.};
}

/// Slip plus the slip that represents the creep of the step before.
inline Slip<double> with_creep_before(const Slip<double>& slip, const Rolling& rolling) noexcept {
  const double* const left = rolling.left;
  return {slip.along + left[0], slip.across + left[1], slip.spin + left[2]};
}

/// The parts of a rail's friction at a place along the track, m. @param part  [left, right] out
void grip_at(const RollingFriction& f, double x, double* part) noexcept;

/// Adds to the derivatives the effect of friction that falls over the slip. A force is homogeneous
/// in slip and friction, as friction acts through the limit alone.
/// @param part  of friction that the slip leaves
/// @param slip  with_creep_before()
/// @param over_rail  the same without the creep before
void add_fall(const RollingFriction& f, double part, const Slip<double>& slip,
              const Slip<double>& over_rail, ContactCreep& creep) noexcept;

/// Part of friction that a slip leaves.
double left_by_slip(const RollingFriction& f, const Slip<double>& slip) noexcept;

/// Creep of a contact in touch.
/// @param side  1 of the left rail, -1 of the right
/// @param slip  of the wheel over the rail
/// @param wanted  derivatives that are not wanted may be 0
inline ContactCreep creep_on_rail(const RollingCreep& c, const RollingPatch& patch, double side,
                                  const Pressed& pressed, const Slip<double>& slip,
                                  const Rolling& rolling,
                                  CreepWanted wanted = CreepWanted::slopes) noexcept {
  const RollingFriction& f = c.friction;
  const double most = rolling.grip * f.rail[side > 0. ? 0 : 1];
  const Slip<double> all = with_creep_before(slip, rolling);
  if (!falls(f)) return contact_creep(c, patch, most, pressed, all, rolling.over, wanted);
  const double part = left_by_slip(f, slip);
  ContactCreep creep = contact_creep(c, patch, part * most, pressed, all, rolling.over, wanted);
  if (wanted == CreepWanted::slopes) add_fall(f, part, all, slip, creep);
  return creep;
}

}  // namespace railstep
