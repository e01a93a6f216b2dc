#include "offline/track/end_zone.h"

#include <cmath>

namespace railstep {

namespace {

constexpr double kNepers = 1.5;  // of the fastest bending wave, lost there and back

/// Distance of an element's middle from the start of a zone of length 1 before an end; 0 outside
/// the zone.
double depth(const Track& track, std::size_t end, int element) {
  if (track.ends[end] != RailEnd::non_reflecting) return 0.;
  const double from_end = end == 0 ? element + .5 : track.elements() - element - .5;
  const double zone = track.end_zone_bays * track.elements_per_bay;
  return std::fmax(0., 1. - from_end / zone);
}

}  // namespace

int end_zones(const Track& track) {
  int count = 0;
  for (const RailEnd end : track.ends) count += end == RailEnd::non_reflecting ? 1 : 0;
  return count;
}

double end_damping_rate(const Track& track, int rail, int element) {
  const double s = depth(track, 0, element) + depth(track, 1, element);  // zones do not overlap
  if (s == 0.) return 0.;
  const RailBar bar = track.bar(rail);
  const double fastest =
      std::sqrt(bar.section.shear_factor_z * bar.material.shear_modulus() / bar.material.density);
  const double length = track.end_zone_bays * track.bay_length;
  return 4. * kNepers * fastest / length * (s * s * s);
}

}  // namespace railstep
