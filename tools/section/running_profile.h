#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "offline/profile/rail_head.h"

namespace railstep {

/// How far a smoothed surface leaves the points that it was made from.
struct Smoothing {
  double tolerance, rms, largest;  // m
};

/// A wheel's running surface from a profile file.
struct WheelProfile {
  std::string name, source;
  RunningSurface growth;  // of the radius over s from the tread datum outwards, m
  double flange_back;     // s of the back of the flange, m, negative
  std::optional<Smoothing> smoothing;
};

/// A rail's running surface in the track.
struct PlacedRail {
  std::string name, source;
  RunningSurface
      surface;  // y from the middle of the track outwards, heights from the top of rail, m
  std::optional<Smoothing> smoothing;
};

/// Reads a wheel profile: TOML with kind = "wheel" as in config/README.md, "Profiles of wheels".
/// Throws InputError.
WheelProfile read_wheel_profile(const std::filesystem::path& file);

/// Reads a rail profile and places it: an outline as read_profile() takes it, or a measured head,
/// TOML with kind = "rail". Throws InputError.
PlacedRail read_placed_rail(const std::filesystem::path& file, const RailPlace& place);

}  // namespace railstep
