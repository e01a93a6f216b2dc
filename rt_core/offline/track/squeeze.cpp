#include "offline/track/squeeze.h"

#include <cmath>

namespace railstep {

namespace {

constexpr double kHold = 1e-6;  // of a bay's stiffness along x, at one node

/// f of part_of_pad(). @param ratio  L/l  @param spacing  d/l
double spread(double ratio, double spacing) {
  const double others = 2. / std::expm1(spacing);
  if (ratio < 1e-3) return 1. - ratio / 3. + others;  // to its second order, 1e-7
  const double wide = std::sinh(.5 * ratio) / (.5 * ratio);
  return 2. * (ratio - 1. + std::exp(-ratio)) / (ratio * ratio) + others * wide * wide;
}

}  // namespace

Squeeze squeeze_of(const Track& track, int rail) {
  const RailBar bar = track.bar(rail);
  const double stretch = bar.material.young * bar.section.area;
  const double shear = bar.material.shear_modulus() * bar.section.inertia_y;
  return {.5 / std::sqrt(stretch * shear), std::sqrt(shear / stretch)};
}

double part_of_pad(const Track& track, int border, int rail) {
  if (strains_section(track.unknowns)) return 1.;
  const Support pad = track.seat(border).pad[static_cast<std::size_t>(rail)];
  const double height = pad.height_z + track.axis_z;
  if (height == 0.) return 1.;
  const Squeeze squeeze = squeeze_of(track, rail);
  const bool at_end = !track.ring && (border == 0 || border == track.bays);
  const double flexibility = (at_end ? 2. : 1.) * squeeze.softness * height * height *
                             spread(pad.length / squeeze.length, track.bay_length / squeeze.length);
  return 1. / (1. + pad.stiffness[2] * flexibility);
}

Track with_strain(Track track) {
  if (strains_section(track.unknowns)) return track;
  track.unknowns = moves_sideways(track.unknowns) ? Unknowns::full : Unknowns::in_plane;
  track.hold_along = kHold * track.material.young * track.section.area / track.bay_length;
  return track;
}

}  // namespace railstep
