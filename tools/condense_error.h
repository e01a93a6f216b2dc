#pragma once
#include <string>
#include <vector>

#include "scene.h"

namespace railstep {

/// What a scene's model misses of its first moments.
struct TransientError {
  double window_s;  // from the start
  double largest;   // of loads' deflections and rails' heights under wheels, over each one's peak
};

/// Runs the scene and a reference of it: full order, twice the elements per bay, half the step.
/// Where the scene starts released, the first fifth of the window is left out.
/// @param overrides  with which the scene was read
TransientError transient_error(const Scene& scene, const std::vector<std::string>& overrides);

}  // namespace railstep
