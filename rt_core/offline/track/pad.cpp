#include "offline/track/pad.h"

#include <algorithm>

#include "offline/math/gauss.h"

namespace railstep {

std::vector<PadPoint> pad_points(const Track& track, int border, double length) {
  const double seat = border * track.bay_length, step = track.element_length();
  const int first_after = border * track.elements_per_bay;  // element right of the seat
  if (length == 0.) {
    const bool last = first_after == track.elements();
    const int node = 2 * first_after;
    if (joint_at(track, 0, node) != nullptr || joint_at(track, 1, node) != nullptr)
      return {{first_after - 1, 1., seat - kBehind * step, 0., .5},
              {first_after, -1., seat, 0., .5}};
    return {{last ? first_after - 1 : first_after, last ? 1. : -1., seat, 0., 1.}};
  }
  const double from = std::max(-.5 * length, -seat);
  const double to = std::min(.5 * length, (track.bays - border) * track.bay_length);
  std::vector<PadPoint> points;
  // Elements by their place beside the seat: their borders are multiples of the step from it.
  for (int e = -track.elements_per_bay; e < track.elements_per_bay; ++e) {
    const double a = std::max(from, e * step), b = std::min(to, (e + 1) * step);
    if (!(b > a)) continue;
    for (const GaussPoint& g : gauss(3)) {
      const double offset = .5 * (a + b) + .5 * (b - a) * g.xi;
      points.push_back({first_after + e, 2. * (offset / step - e) - 1., seat + offset, offset,
                        .5 * g.weight * (b - a) / (to - from)});
    }
  }
  return points;
}

bool has_long_pads(const Track& track) {
  for (int border = 0; border <= track.bays; ++border)
    for (const Support& pad : track.seat(border).pad)
      if (pad.length > 0.) return true;
  return false;
}

}  // namespace railstep
