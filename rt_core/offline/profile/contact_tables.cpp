#include "offline/profile/contact_tables.h"

#include <cmath>

namespace railstep {

namespace {

constexpr double kSpacing = .125e-3;  // m

}  // namespace

ContactTables::Tabled::Tabled(const RunningSurface& surface) : first(surface.first()) {
  const double length = surface.last() - first;
  const int count = static_cast<int>(std::ceil(length / kSpacing));
  step = length / count;
  for (int i = 0; i <= count; ++i) {
    const SurfacePoint p = surface.at(first + step * i);
    value.insert(value.end(), {p.height, step * p.slope});
  }
}

ProfileTable ContactTables::Tabled::table() const {
  return {static_cast<std::int32_t>(value.size() / 2), first, step, value.data()};
}

ContactTables::ContactTables(const WheelRail& pair, const Elastic& bodies)
    : wheel_(pair.wheel),
      rail_(pair.rail),
      half_distance_(pair.half_distance),
      radius_(pair.radius),
      modulus_(bodies.young / (1. - bodies.poisson * bodies.poisson)) {}

WheelOnRail ContactTables::pair() const {
  return {wheel_.table(), rail_.table(), half_distance_, radius_, modulus_};
}

}  // namespace railstep
