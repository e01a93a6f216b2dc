#pragma once
#include "offline/track/track.h"

namespace railstep {

/// How the section of a rail is squeezed between its centroid and a point, which only unknowns that
/// strain it have. A force F along z at height z over the centroid stretches it by b(x), with
///   E A b - G I b'' = F z delta(x),   b = F z e^(-|x|/l) / (2 sqrt(E A G I)),   l^2 = G I / E A,
/// I = I_y: what the element's energy leaves where the rail is free to widen and to move along x
/// (docs/unknowns.md).
struct Squeeze {
  double softness;  // 1 / (2 sqrt(E A G I)), 1/(N m)
  double length;    // l, m: some 40 mm
};
Squeeze squeeze_of(const Track& track, int rail);

/// What of a pad's stiffness along z is left, k'/k, with the section between axis and pad in series
/// where the unknowns lack its squeeze, else 1:
///   k' = k / (1 + k s),   s = softness (height over the centroid)^2 f,
/// and c' = c (k'/k)^2 of its damping. f averages e^(-|x - x'|/l) over the pad's length L and those
/// of equal seats d apart,
///   f = 2 (r - 1 + e^-r) / r^2 + 2 (sinh(r/2) / (r/2))^2 / (e^(d/l) - 1),   r = L/l,
/// which goes to 2 l / d, a section pressed evenly, as pads meet. At a rail's end it is twice that.
double part_of_pad(const Track& track, int border, int rail);

/// The same track with the section's strain among its unknowns, as vertical forces press it:
/// Unknowns::in_plane of a vertical one, else Unknowns::full; held softly along x, so that what few
/// unknowns do not carry is no free mode. No effect on a track that has the strain.
Track with_strain(Track track);

}  // namespace railstep
