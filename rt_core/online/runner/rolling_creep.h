#pragma once
#include <cmath>

#include "online/model/runner_model.h"

namespace railstep {

/// Slip of the wheel over the rail at a contact, m/s, and spin, rad/s.
template <typename T>
struct Slip {
  T along, across, spin;
};

/// Creep of a contact: forces on the wheel along and across, N, and the moment about the normal,
/// N m, and their derivatives.
struct ContactCreep {
  double force[3];
  double by_slip[3][3];  // over Slip's along, across and spin
  double by_normal[3];   // over the normal force, at the same slip
  bool slides;           // linear creep would be at least three times the limit: it has saturated
};

inline constexpr double kLeastRolling = .1;  // m/s: creepages of slower wheels are over this speed
/// Reciprocal of the speed over which creepages are taken, s/m.
inline double per_rolling(double speed) noexcept {
  const double size = std::fabs(speed);
  return 1. / (size > kLeastRolling ? size : kLeastRolling);
}

/// Creep of a contact in touch by the scene's law. The moment is that of linear creep times
/// 1 - u/3 + u^2/27, u the linear force over the limit, and 1/u from u = 3 on. A normal force under
/// 1 uN makes no creep.
/// @param friction  coefficient
/// @param depth  penetration, m, above 0
/// @param speed  of the wheelset, m/s
ContactCreep contact_creep(const RollingCreep& c, double friction, double depth, double normal,
                           const Slip<double>& slip, double speed) noexcept;

}  // namespace railstep
