#include "offline/runner/rolling_profiles.h"

#include <cmath>

#include "offline/math/golden_section.h"

namespace railstep {

namespace {

/// Place of the highest point of a rail, by halves about the highest of many.
double highest(const RunningSurface& rail) {
  constexpr int kPlaces = 1000;
  const double step = (rail.last() - rail.first()) / kPlaces;
  int most = 1;
  const auto height = [&](int i) { return rail.at(rail.first() + step * i).height; };
  for (int i = 2; i < kPlaces; ++i)
    if (height(i) > height(most)) most = i;
  const double middle = rail.first() + step * most;
  return golden_section([&](double y) { return rail.at(y).height; }, middle - step, middle + step,
                        1e-8)
      .first;
}

struct PlacingPoint {
  double y, z;
};
/// The highest point of the circle of a rail's crown; of a rail without that circle its own.
PlacingPoint placing_point(const RunningSurface& rail, double crown_radius) {
  for (const SurfacePiece& piece : rail.pieces())
    if (std::abs(piece.radius - crown_radius) < 1e-6 * crown_radius)
      return {piece.middle, piece.height + piece.radius};
  const double y = highest(rail);
  return {y, rail.at(y).height};
}

}  // namespace

RollingProfiles rolling_profiles(const WheelRail& pair, const Elastic& bodies, double crown_radius,
                                 double load) {
  const WheelsetTouch rigid = touch(pair, 0., true);
  const WheelsetLoaded pressed = loaded(pair, bodies, 0., load);
  auto tables = std::make_shared<const ContactTables>(pair, bodies);
  RollingContact contact{};
  contact.half_distance = pair.half_distance + rigid.right.on_wheel;
  contact.hertz = load / std::pow(pressed.right.approach, 1.5);
  contact.creep.patch.shear = .5 * bodies.young / (1. + bodies.poisson);
  const PlacingPoint point = placing_point(pair.rail, crown_radius);
  contact.profiles = {tables->pair(), rigid.height, point.y, point.z, bodies.poisson};
  return {contact, std::move(tables)};
}

}  // namespace railstep
