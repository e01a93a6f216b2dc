#include "offline/profile/contact_tables.h"

#include <cmath>

namespace railstep {

namespace {

constexpr double kSpacing = .125e-3;  // m

/// kSearchStrips places from end to end, as far apart along the profile.
std::vector<double> spread_along(const RunningSurface& surface) {
  const double length = surface.last() - surface.first();
  const int count = static_cast<int>(std::ceil(length / kSpacing));
  std::vector<double> along{0.};
  for (int i = 0; i < count; ++i)
    along.push_back(along.back() +
                    std::hypot(1., surface.at(surface.first() + length * (i + .5) / count).slope));
  std::vector<double> places{surface.first()};
  std::size_t cell = 0;
  for (int i = 1; i < kSearchStrips - 1; ++i) {
    const double wanted = along.back() * i / (kSearchStrips - 1);
    while (along[cell + 1] < wanted) ++cell;
    const double part = (wanted - along[cell]) / (along[cell + 1] - along[cell]);
    places.push_back(surface.first() + length * (static_cast<double>(cell) + part) / count);
  }
  places.push_back(surface.last());
  return places;
}

}  // namespace

ContactTables::Tabled::Tabled(const RunningSurface& surface) : first(surface.first()) {
  const double length = surface.last() - first;
  const int intervals = static_cast<int>(std::ceil(length / kSpacing));
  step = length / intervals;
  SurfacePoint a = surface.at(first);
  for (int i = 0; i < intervals; ++i) {  // Hermite's cubics
    const SurfacePoint b = surface.at(first + step * (i + 1));
    const double rise = b.height - a.height, from = step * a.slope, to = step * b.slope;
    coefficient.insert(coefficient.end(),
                       {a.height, from, 3. * rise - 2. * from - to, from + to - 2. * rise});
    a = b;
  }
  coefficient.insert(coefficient.end(), {a.height, step * a.slope, 0., 0.});
}

ProfileTable ContactTables::Tabled::table() const {
  return {static_cast<std::int32_t>(coefficient.size() / 4), first, 1. / step, coefficient.data()};
}

ContactTables::ContactTables(const WheelRail& pair, const Elastic& bodies)
    : wheel_(pair.wheel),
      rail_(pair.rail),
      half_distance_(pair.half_distance),
      radius_(pair.radius),
      modulus_(bodies.young / (1. - bodies.poisson * bodies.poisson)) {
  search_place_ = spread_along(pair.wheel);
  for (const double s : search_place_) {
    const SurfacePoint p = pair.wheel.at(s);
    search_growth_.push_back(p.height);
    search_slope_.push_back(p.slope);
  }
}

ProfilePair ContactTables::pair() const {
  return {wheel_.table(),
          search_place_.data(),
          search_growth_.data(),
          search_slope_.data(),
          rail_.table(),
          half_distance_,
          radius_,
          modulus_,
          kMostLeast};
}

}  // namespace railstep
