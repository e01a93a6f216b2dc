#pragma once
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
  bool slides;           // linear creep would be at least three times the limit of friction
};

/// Creep of a contact in touch by the scene's law; creepages are slip times per_speed, s/m. The
/// moment is that of linear creep, less by the same factor as the force. A force under 1 uN makes
/// no creep.
/// @param side   0: left, 1: right
/// @param depth  penetration, m, above 0
ContactCreep contact_creep(const RollingCreep& c, int side, double depth, double normal,
                           const Slip<double>& slip, double per_speed) noexcept;

}  // namespace railstep
