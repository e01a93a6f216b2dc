#include "offline/analysis/decay_length.h"

#include <algorithm>
#include <cmath>

namespace railstep {

double decay_length(const Track& track) {
  if (track.rigid) return 0.;
  double longest = 0.;
  for (int rail = 0; rail < track.rails; ++rail) {
    const RailBar bar = track.bar(rail);
    double softness = 1. / track.support.stiffness[2];
    if (track.sleeper) softness += 1. / track.sleeper->ballast_stiffness[2];
    const double foundation = 1. / (softness * track.bay_length);
    longest = std::max(
        longest, 7. * std::pow(4. * bar.material.young * bar.section.inertia_y / foundation, .25));
  }
  return longest;
}

}  // namespace railstep
