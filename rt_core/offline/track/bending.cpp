#include "offline/track/bending.h"

#include <array>

#include "offline/element/shape.h"

namespace railstep {

namespace {

constexpr int kTurn = 6;  // b_x among a node's unknowns

/// A border belongs to the element ahead of it; from behind, to the one before.
ElementPlace place_from(const Track& track, double x, From from) {
  ElementPlace place = place_on(track, x);
  const bool at_border = place.xi < -1. + 1e-9;
  if (from == From::behind && at_border && place.element > 0) return {place.element - 1, 1.};
  return place;
}

}  // namespace

double bending_moment(const Track& track, const std::vector<Line>& lines,
                      const std::vector<Eigen::VectorXd>& displacement, int rail, double x,
                      From from) {
  const auto [element, xi] = place_from(track, x, from);
  const std::array<double, 3> slope = shape_slope(xi);
  double turn = 0.;  // d(b_x)/d(xi)
  for (std::size_t l = 0; l < lines.size(); ++l)
    for (int i = 0; i < 3; ++i) {
      const int unknown = lines[l].element_unknown(rail, element, i, kTurn);
      if (unknown >= 0)
        turn += lines[l].rail_factor[static_cast<std::size_t>(rail)] *
                slope[static_cast<std::size_t>(i)] * displacement[l][unknown];
    }
  const RailBar bar = track.bar(rail);
  return -bar.material.young * bar.section.inertia_y * 2. / track.element_length() * turn;
}

}  // namespace railstep
