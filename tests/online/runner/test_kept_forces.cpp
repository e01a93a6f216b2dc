// Normal forces of patches at depths near one for which they were found in full.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/runner/rolling_profiles.h"
#include "online/runner/profile_contact.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

constexpr double kKeptWheel = .46, kKeptRolling = 30.;

struct NearForce {
  double normal, stiffness[kMostZones];
};
NearForce at_height(const RollingContact& c, ProfileWheel& wheel, const double* u) {
  const double rest[6] = {};
  NearForce found{};
  found.normal =
      profile_force(c, wheel, kKeptWheel, 1., kKeptRolling, {u, 0.}, rest, {}, found.stiffness)
          .normal;
  return found;
}

}  // namespace

TEST_CASE("forces near a force in full are that force's power law", "[profile_contact]") {
  RollingProfiles profiles = rolling_profiles(s1002_on_60e1(), {}, .3, 55e3);
  RollingContact c = profiles.contact;
  c.creep = {CreepLaw::she, 10, {{.3, .3}}, {1., 1., 80.8e9, 1., {}}};
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> part(-1., 1.);
  int touching = 0;
  for (int n = 0; n < 400; ++n) {
    double u[6] = {0., 9e-3 * part(engine), 1e-4 * part(engine), 0., 0., 5e-3 * part(engine)};
    ProfileWheel wheel;
    find_profile_wheel(c, kKeptWheel, 1., {u, 0.}, wheel);
    const double first = at_height(c, wheel, u).normal;
    if (!(first > 100.)) continue;
    ++touching;
    ProfileWheel afresh = wheel;
    for (ProfilePatch& patch : afresh.patch) patch.last.normal = 0.;
    CHECK(at_height(c, afresh, u).normal == first);
    double deep = 1.;
    for (int i = 0; i < wheel.patches; ++i)
      if (wheel.patch[i].zone.depth > 0.) deep = std::min(deep, wheel.patch[i].zone.depth);
    u[2] += 4e-7 * deep * part(engine);
    for (ProfilePatch& patch : afresh.patch) patch.last.normal = 0.;
    const NearForce near = at_height(c, wheel, u), full = at_height(c, afresh, u);
    CAPTURE(n, first, deep);
    CHECK(near.normal != first);
    CHECK(near.normal == Approx(full.normal).epsilon(2e-10));
    for (int i = 0; i < wheel.patches; ++i)
      CHECK(near.stiffness[i] == Approx(full.stiffness[i]).epsilon(1e-4));
  }
  CHECK(touching > 200);
}
