// Zones of contact by strips online, against wheels under load offline and against a search over
// the whole surface of a wheel that yaws and rolls.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/profile/contact_tables.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

constexpr double kLeastDepth = kLeastPatchDepth;
const Elastic kSteel;

struct Forces {
  double upright = 0., growth = 0., stiffness = 0.;
  int patches = 0;
};

Forces forces_of(const WheelRail& profiles, const ProfilePair& pair, const WheelsetPlace& at) {
  WheelZone zone[kMostZones];
  Forces sum;
  double normals = 0.;
  for (int i = 0; i < find_zones(pair, at, kLeastDepth, zone); ++i) {
    PatchForce force = patch_force(patch_of(zone[i]), zone[i].depth);
    if (!(force.normal > 0.)) continue;
    force.normal *= zone[i].share;
    force.stiffness *= zone[i].share;
    CHECK_FALSE(zone[i].at_edge);
    const double s = zone[i].s + zone[i].cosine_of_wheel * force.centre;
    const double cosine = zone[i].cosine;
    sum.upright += cosine * force.normal;
    sum.stiffness += cosine * cosine * force.stiffness;
    sum.growth += force.normal * profiles.wheel.at(s).height;
    normals += force.normal;
    ++sum.patches;
  }
  sum.growth /= normals;
  return sum;
}

/// Least height of the whole wheel over the rail near a place, and where it is along the rail.
struct Least {
  double gap, ahead;
};
Least least_gap(const WheelRail& pair, const WheelsetPlace& at, double s_from, double s_to) {
  Least least{1., 0.};
  constexpr int kPlaces = 800, kAngles = 801;
  for (int i = 0; i <= kPlaces; ++i) {
    const double s = s_from + (s_to - s_from) * i / kPlaces;
    const double along = pair.half_distance + s, radius = pair.radius + pair.wheel.at(s).height;
    for (int k = 0; k < kAngles; ++k) {
      const double angle = .05 * (2. * k / (kAngles - 1) - 1.);
      const double level = along * std::cos(at.roll) + radius * std::cos(angle) * std::sin(at.roll);
      const double before = radius * std::sin(angle);
      const double y = at.outwards + level * std::cos(at.yaw) + before * std::sin(at.yaw);
      if (y < pair.rail.first() || y > pair.rail.last()) continue;
      const double z =
          at.up + along * std::sin(at.roll) - radius * std::cos(angle) * std::cos(at.roll);
      const double gap = z - pair.rail.at(y).height;
      if (gap < least.gap) least = {gap, before * std::cos(at.yaw) - level * std::sin(at.yaw)};
    }
  }
  return least;
}

}  // namespace

TEST_CASE("zones of a wheel carry what its patches carry offline", "[profile]") {
  for (const double inclination : {1. / 40., 1. / 20.}) {
    const WheelRail profiles = wheel_pair("s1002.toml", inclination);
    const ContactTables tables(profiles, kSteel);
    for (const double load : {1e4, 6e4, 1.2e5})
      for (const double shift : {0., .5e-3, 1e-3, 2e-3, 3e-3, 4e-3, 5.5e-3, 6.5e-3}) {
        INFO("1 : " << 1. / inclination << ", " << load << " N, " << 1e3 * shift << " mm");
        const WheelsetLoaded exact = loaded(profiles, kSteel, shift, load);
        for (const bool right : {true, false}) {
          INFO((right ? "right" : "left"));
          const WheelLoaded& wheel = right ? exact.right : exact.left;
          const WheelsetPlace at{right ? shift : -shift, wheel.height,
                                 right ? exact.roll : -exact.roll, 0.};
          const Forces found = forces_of(profiles, tables.pair(), at);
          CHECK(found.patches == static_cast<int>(wheel.patches.size()));
          CHECK(found.upright == Approx(load).epsilon(.03));
          CHECK(found.growth == Approx(wheel.growth()).margin(6e-5));
        }
      }
  }
}

TEST_CASE("a wheel that yaws and rolls touches where its whole surface does", "[profile]") {
  const WheelRail profiles = s1002_on_60e1();
  const ContactTables tables(profiles, kSteel);
  for (const double yaw : {-.01, .003, .01})
    for (const double roll : {0., 3e-3})
      for (const double shift : {1e-3, 4e-3, 7e-3}) {
        INFO("yaw " << yaw << ", roll " << roll << ", shift " << shift);
        WheelsetPlace at{shift, profiles.radius - .75 * roll, roll, yaw};
        WheelZone zone[kMostZones];
        const auto gap_of = [&zone](int i) { return -zone[i].depth / zone[i].cosine; };
        int lowest = 0;
        for (int turn = 0; turn < 3; ++turn) {  // until the wheel just touches
          const int count = find_zones(tables.pair(), at, kLeastDepth, zone);
          REQUIRE(count > 0);
          lowest = 0;
          for (int i = 1; i < count; ++i)
            if (gap_of(i) < gap_of(lowest)) lowest = i;
          if (turn < 2) at.up -= gap_of(lowest);
        }
        const WheelZone& own = zone[lowest];
        const Least least = least_gap(profiles, at, own.s - 2e-3, own.s + 2e-3);
        const double gap = gap_of(lowest);
        CHECK(gap == Approx(least.gap).margin(1e-6));
        CHECK(pressed_point(tables.pair(), at, own.s, 1e-3).ahead ==
              Approx(least.ahead).margin(6e-5));
      }
}

TEST_CASE("of several least gaps as many are looked at as asked for, the deepest ones",
          "[profile]") {
  const WheelRail profiles = s1002_on_60e1();
  const ContactTables tables(profiles, kSteel);
  int several = 0;
  for (double shift = 0.; shift < 8e-3; shift += 2e-5) {
    const WheelsetPlace at{shift, loaded(profiles, kSteel, shift, 6e4).right.height, 0., 0.};
    ProfilePair pair = tables.pair();
    WheelZone all[kMostZones], one[kMostZones];
    const int count = find_zones(pair, at, kLeastDepth, all);
    pair.patches = 1;
    REQUIRE(find_zones(pair, at, kLeastDepth, one) == 1);
    CHECK(one[0].share == 1.);
    for (int i = 0; i < count; ++i)
      CHECK(all[i].depth / all[i].cosine <= one[0].depth / one[0].cosine + 1e-12);
    several += count > 1 ? 1 : 0;
  }
  CHECK(several > 5);
}

TEST_CASE("a wheel beside its rail has no zone", "[profile]") {
  const WheelRail profiles = s1002_on_60e1();
  const ContactTables tables(profiles, kSteel);
  WheelZone zone[kMostZones];
  CHECK(find_zones(tables.pair(), {.2, .46, 0., 0.}, kLeastDepth, zone) == 0);
  CHECK(find_zones(tables.pair(), {0., .47, 0., 0.}, kLeastDepth, zone) == 1);
  CHECK(zone[0].depth < -9e-3);
}

TEST_CASE("zones are within their arrays wherever the wheel is", "[profile]") {
  const WheelRail profiles = s1002_on_60e1();
  const ContactTables tables(profiles, kSteel);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> part(-1., 1.);
  for (int n = 0; n < 20'000; ++n) {
    const WheelsetPlace at{.15 * part(engine), .46 + .02 * part(engine), .05 * part(engine),
                           .05 * part(engine)};
    WheelZone zone[kMostZones];
    const double least_depth = 1e-7 * std::pow(10., 2. + 2. * part(engine));
    const int count = find_zones(tables.pair(), at, least_depth, zone);
    REQUIRE(count <= kMostZones);
    for (int i = 0; i < count; ++i) {
      REQUIRE(zone[i].patch.deepest >= 0.);
      REQUIRE(zone[i].patch.deepest <= kZoneStrips - 1.);
      REQUIRE(zone[i].patch.width > 0.);
      REQUIRE(*std::min_element(zone[i].gap, zone[i].gap + kZoneStrips) >= 0.);
      REQUIRE(std::isfinite(zone[i].depth));
    }
  }
}

TEST_CASE("no minimum of the gap near contact is missed by much", "[profile]") {
  // Against strips 20 um apart; a flange's overlap is some 0.3 mm wide on the wheel.
  const WheelRail profiles = s1002_on_60e1();
  const ContactTables tables(profiles, kSteel);
  std::mt19937 engine(6);
  std::uniform_real_distribution<double> part(-1., 1.);
  double most = 0.;
  for (int n = 0; n < 300; ++n) {
    WheelsetPlace at{5e-3 + 5e-3 * part(engine), .46, 5e-3 * part(engine), 0.};
    WheelZone zone[kMostZones];
    const auto least = [&] {
      double gap = 1.;
      const int count = find_zones(tables.pair(), at, kLeastDepth, zone);
      for (int i = 0; i < count; ++i) gap = std::min(gap, -zone[i].depth / zone[i].cosine);
      return gap;
    };
    at.up -= least();
    const double found = least();
    const WheelOverRail exact(profiles, at.outwards, at.roll);
    double dense = 1.;
    for (double s = -.045; s < .04; s += 2e-5) dense = std::min(dense, exact.distance(s) + at.up);
    most = std::max(most, found - dense);
  }
  CHECK(most < 2e-6);
}
