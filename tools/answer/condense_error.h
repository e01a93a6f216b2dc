#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "study/study_row.h"

namespace railstep {

/// The errors of a scene's model, as far as they are known.
struct TransientError {
  double from_s;    // what comes before is left out
  double window_s;  // from the start
  double largest;   // of loads' deflections and rails' heights under wheels, over each one's peak
  double reference_error;  // the reference's own, estimated
  ErrorParts parts;
  /// The error of the law of contact: the difference that wheels with a linear contact, or bonded
  /// to the rail, make against Hertz's law. It is in no other number here; nothing where all wheels
  /// follow Hertz's law.
  std::optional<double> contact_law;
};

/// Runs the scene and a reference of it: full order, elements and steps halved until its own error
/// is a tenth of the scene's, two or three times. Where the scene starts released, the first fifth
/// of the window is left out, 0.02 s at most.
/// @param overrides  with which the scene was read
/// @param asked  s, of the window; none: the whole scene, or what of it a reference can be made of
/// in some seconds
TransientError transient_error(const Scene& scene, const std::vector<std::string>& overrides,
                               std::optional<double> asked = std::nullopt);

}  // namespace railstep
