#pragma once
#include "runs.h"

namespace railstep::property {

/// Another scene that must behave alike, and where each column of the trace is found in its trace.
struct Transformed {
  Document scene;
  ImageOf image;
};

/// The scene without parts that have no mirror image: scatter, irregularities of a spectrum, and
/// along the track (axis 0) corrugation, whose first wave differs from its last one.
Document without_scatter(const Document& scene, int axis);

/// The scene mirrored across x (axis 0: x -> length - x of a track, -x of a system) or y (axis 1).
/// @param scene  without scatter
Transformed reflected(const Document& scene, int axis);

/// Other units: lengths, times and masses are multiplied by these. For a track with weight length /
/// time^2 must be 1, as gravity has no key there.
struct Units {
  double length = 1., time = 1., mass = 1.;
};
Transformed rescaled(const Document& scene, const Units& units);

/// The scene with all traffic and sensors of a track some bays further.
Transformed moved_on(const Document& scene, int bays);
/// The system moved to another place.
Transformed moved_off(const Document& scene, const double by[3]);

}  // namespace railstep::property
