#pragma once
#include "runs.h"

namespace railstep::property {

/// A scene as another one that must behave alike, and where its trace's columns are then found.
struct Transformed {
  Document scene;
  ImageOf image;
};

/// The scene without what has no mirror image: scatter, irregularities of a spectrum, and along the
/// track (axis 0) corrugation, whose first wave is not its last one.
Document without_scatter(const Document& scene, int axis);

/// Seen in a mirror across x (0: x -> length - x of a track, -x of a system) or y (1).
/// @param scene  without scatter
Transformed reflected(const Document& scene, int axis);

/// In other units: lengths, times and masses times these. Of a track with weight length / time^2
/// has to be 1, as its gravity is none of its keys.
struct Units {
  double length = 1., time = 1., mass = 1.;
};
Transformed rescaled(const Document& scene, const Units& units);

/// All traffic and all sensors of a track some bays on.
Transformed moved_on(const Document& scene, int bays);
/// A system somewhere else.
Transformed moved_off(const Document& scene, const double by[3]);

}  // namespace railstep::property
