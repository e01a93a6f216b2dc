#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene.h"
#include "study/row.h"

namespace railstep {

/// What a scene's model misses of its first moments, and what of that is known.
struct TransientError {
  double window_s;  // from the start
  double largest;   // of loads' deflections and rails' heights under wheels, over each one's peak
  double reference_error;  // the reference's own, estimated
  ErrorParts parts;
  /// What the law of contact takes away: what wheels with a linear contact, or bonded to the rail,
  /// do otherwise than by Hertz's law. In no other number here; none where all follow it.
  std::optional<double> contact_law;
};

/// Runs the scene and a reference of it: full order, elements and steps halved until its own error
/// is a tenth of the scene's, two or three times. Where the scene starts released, the first fifth
/// of the window is left out. The window is shorter than kTransientWindow where a reference of the
/// whole would take too long.
/// @param overrides  with which the scene was read
TransientError transient_error(const Scene& scene, const std::vector<std::string>& overrides);

inline constexpr double kTransientWindow = .1;  // s, at most

}  // namespace railstep
