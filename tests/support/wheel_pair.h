#pragma once
#include <string>

#include "offline/profile/wheel_rail.h"
#include "section/running_profile.h"

namespace railstep {

inline constexpr double kSteelModulus = 210e9 / (1. - .09);  // E / (1 - nu^2), N/m2

/// A wheelset of 0.46 m, 1.36 m back to back, on 60E1 at 1.435 m.
/// @param wheel  a file of config/profiles
inline WheelRail wheel_pair(const std::string& wheel, double inclination) {
  const std::string folder = std::string(RAILSTEP_SOURCE) + "/config/profiles/";
  return {read_wheel_profile(folder + wheel).growth,
          read_placed_rail(folder + "60e1.toml", {inclination, 1.435}).surface, .75, .46};
}
inline WheelRail s1002_on_60e1() { return wheel_pair("s1002.toml", 1. / 40.); }

}  // namespace railstep
