#pragma once
#include <memory>

#include "offline/profile/contact_tables.h"
#include "online/model/runner_model.h"

namespace railstep {

/// Wheels on rails by their profiles, and the tables that these point to.
struct RollingProfiles {
  RollingContact contact;  // without creep
  std::shared_ptr<const ContactTables> tables;
};

/// @param crown_radius  of the rail's section, m: the circle from whose highest point it is placed
/// @param load  upright on each wheel, N, near that of the vehicle at rest
/// Throws Refused as loaded() does.
RollingProfiles rolling_profiles(const WheelRail& pair, const Elastic& bodies, double crown_radius,
                                 double load);

}  // namespace railstep
