#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace railstep {

/// A way to step, as a scene says it.
struct SteppedWay {
  const char* name;
  std::vector<std::string> overrides;
  /// Growth over 1 that is not the step's own, at most.
  double bound;
};

/// All that a track may be stepped by.
const std::vector<SteppedWay>& stepped_ways();

/// The largest growth factor of the coupled step at one place of the map.
struct Growth {
  const SteppedWay* way;
  double step, pad, mass;  // s, N/m of a seat, kg of the wheel
  double factor;
};

/// Over step size x pad stiffness x wheel mass, of the scene's track and wheel. Throws InputError.
std::vector<Growth> stability_map(const std::filesystem::path& scene, const SteppedWay& way);

}  // namespace railstep
