#pragma once
#include "offline/track/track.h"

namespace railstep {

/// Squeeze of a rail's section between its centroid and a point, which only unknowns with the
/// section's strain can represent. A force F along z at height z over the centroid stretches it by
/// b(x), with
///   E A b - G I b'' = F z delta(x),   b = F z e^(-|x|/l) / (2 sqrt(E A G I)),   l^2 = G I / E A,
/// I = I_y. This follows from the element's energy for a rail that is free to widen and to move
/// along x (docs/unknowns.md).
struct Squeeze {
  double softness;  // 1 / (2 sqrt(E A G I)), 1/(N m)
  double length;    // l, m: some 40 mm
};
Squeeze squeeze_of(const Track& track, int rail);

/// Remaining part of a pad's stiffness along z, k'/k, with the section between axis and pad in
/// series if the unknowns do not have its squeeze, otherwise 1:
///   k' = k / (1 + k s),   s = softness (height over the centroid)^2 f,
/// and c' = c (k'/k)^2 of its damping. f averages e^(-|x - x'|/l) over the pad's length L and those
/// of equal seats d apart,
///   f = 2 (r - 1 + e^-r) / r^2 + 2 (sinh(r/2) / (r/2))^2 / (e^(d/l) - 1),   r = L/l,
/// which tends to 2 l / d, an evenly pressed section, as the pads meet. At a rail's end it is twice
/// that.
double part_of_pad(const Track& track, int border, int rail);

/// The same track with the section's strain among its unknowns, under vertical forces:
/// Unknowns::in_plane for a vertical one, otherwise Unknowns::full. It is held softly along x, so
/// that motions which the track's own unknowns do not have are not free modes. No effect on a track
/// that has the strain.
Track with_strain(Track track);

}  // namespace railstep
