// Creep of a contact by every law: its derivatives, its limit and its loss.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "online/runner/rolling_creep.h"

using namespace railstep;

namespace {

constexpr double kHertz = 9.4e10;           // N/m^1.5
constexpr double kSpeed = 40.;              // m/s
constexpr double kFriction[2] = {.3, .15};  // left, right

/// A patch of 50 kN that grows with the force, or one that keeps its size.
RollingCreep creep_by(CreepLaw law, bool grows, double kinetic = 1.) {
  const double root = std::sqrt(std::pow(5e4 / kHertz, 2. / 3.));
  const double part = grows ? root : 1.;
  return {law,
          10,
          {{kFriction[0], kFriction[1]}, kinetic, .05},
          {5.9e-3 / part, 4.4e-3 / part, 80.8e9, grows ? 1. / 3. : 0., kalker(1.34, .3)}};
}

double normal_at(double depth) { return kHertz * depth * std::sqrt(depth); }

ContactCreep creep_at(const RollingCreep& c, double depth, const Slip<double>& slip,
                      const Rolling& rolling = kSpeed) {
  return creep_on_rail(c, c.patch, 1., {depth, normal_at(depth)}, slip, rolling);
}

struct Drawn {
  double depth;
  Slip<double> slip;
};
/// Penetrations of 20 to 200 kN, and slips of up to a few times the limit of friction.
Drawn drawn(std::mt19937_64& random, double most_slip) {
  std::uniform_real_distribution<double> part(-1., 1.);
  const double force = 1.1e5 + 9e4 * part(random);
  const double size = most_slip * std::pow(10., -2. + 2. * std::fabs(part(random)));
  return {std::pow(force / kHertz, 2. / 3.),
          {size * part(random), size * part(random), 20. * size * part(random)}};
}

}  // namespace

TEST_CASE("derivatives of a contact's creep are those of its forces", "[rolling_creep]") {
  for (const CreepLaw law : {CreepLaw::linear, CreepLaw::she, CreepLaw::fastsim, CreepLaw::polach})
    for (const auto& [grows, kinetic] : {std::pair{false, 1.}, {true, 1.}, {true, .4}}) {
      const RollingCreep c = creep_by(law, grows, kinetic);
      Rolling rolling(kSpeed);
      if (falls(c.friction)) {  // backwards and slowly, with creep before, on part of the friction
        rolling.grip = .7;
        rolling.over = -kSpeed;
        const double before[3] = {.015, -.02, .1};
        std::copy_n(before, 3, rolling.left);
      }
      std::mt19937_64 random(11);
      for (int n = 0; n < 200; ++n) {
        const Drawn own = drawn(random, .3);
        const double depth = own.depth;
        const Slip<double> slip = own.slip;
        INFO("law " << static_cast<int>(law) << ", grows " << grows << ", kinetic " << kinetic
                    << ", case " << n);
        const ContactCreep at = creep_at(c, depth, slip, rolling);
        const double largest = std::max({std::fabs(at.force[0]), std::fabs(at.force[1]), 1.});
        for (int k = 0; k < 4; ++k) {
          // FASTSIM has a kink wherever a cell begins to slide.
          const double step[4] = {3e-7, 3e-7, 3e-6, 1e-6 * depth};
          const auto moved = [&](double by) {
            Slip<double> s = slip;
            (k == 0 ? s.along : k == 1 ? s.across : s.spin) += k < 3 ? by : 0.;
            return creep_at(c, depth + (k == 3 ? by : 0.), s, rolling);
          };
          const ContactCreep above = moved(step[k]), below = moved(-step[k]);
          if (above.slides() != below.slides()) continue;
          const double by_depth = 1.5 * normal_at(depth) / depth;
          for (int i = 0; i < 3; ++i) {
            const double slope = k < 3 ? at.by_slip[i][k] : by_depth * at.by_normal[i];
            const double found = above.force[i] - below.force[i];
            const double size = i == 2 ? .01 * largest : largest;
            const double allowed = law == CreepLaw::fastsim ? 2e-3 : 1e-7;
            CHECK(std::fabs(found - 2. * step[k] * slope) <=
                  allowed * std::fabs(found) + 3e-9 * size);
          }
        }
      }
    }
}

TEST_CASE("creep takes work, and is within friction", "[rolling_creep]") {
  for (const CreepLaw law : {CreepLaw::linear, CreepLaw::she})
    for (const bool grows : {false, true}) {
      const RollingCreep c = creep_by(law, grows);
      std::mt19937_64 random(12);
      double power = -1e300, beyond = 0., least = 1e300;
      for (int n = 0; n < 250'000; ++n) {
        const auto [depth, slip] = drawn(random, 3.);
        const ContactCreep at = creep_at(c, depth, slip);
        power = std::max(
            power, at.force[0] * slip.along + at.force[1] * slip.across + at.force[2] * slip.spin);
        const double limit = kFriction[0] * normal_at(depth);
        const double size = std::hypot(at.force[0], at.force[1]) / limit;
        beyond = std::max(beyond, size);
        if (at.slides()) least = std::min(least, size);
      }
      INFO("law " << static_cast<int>(law) << ", grows " << grows);
      CHECK(power <= 0.);
      if (law == CreepLaw::linear) continue;
      CHECK(beyond < 1. + 1e-12);
      CHECK(least > 1. - 1e-12);
    }
}

TEST_CASE("the limit of creep is friction times normal force", "[rolling_creep]") {
  const RollingCreep c = creep_by(CreepLaw::she, true);
  const double depth = std::pow(5e4 / kHertz, 2. / 3.);
  for (const int side : {0, 1}) {
    const ContactCreep at =
        creep_on_rail(c, c.patch, side == 0 ? 1. : -1., {depth, 5e4}, {10., 0., 0.}, kSpeed);
    CHECK(at.slides());
    CHECK(at.force[0] == Approx(-kFriction[side] * 5e4).epsilon(1e-12));
  }
  CHECK(contact_creep(c, c.patch, .3, {1e-30, 0.}, {1., 0., 0.}, kSpeed).force[0] == 0.);
  // A fifth of it is there, of which 0.4 + 0.6 / 2 is left at the slip of 0.05 m/s.
  const RollingCreep falling = creep_by(CreepLaw::she, true, .4);
  const ContactCreep at =
      creep_on_rail(falling, falling.patch, 1., {depth, 5e4}, {.04, -.03, 0.}, Rolling(1., .2));
  CHECK(std::hypot(at.force[0], at.force[1]) ==
        Approx(.7 * .2 * kFriction[0] * 5e4).epsilon(1e-12));
  CHECK(at.by_slip[0][0] * .8 - at.by_slip[0][1] * .6 > 0.);
}

TEST_CASE("friction over the place is linear between places", "[rolling_creep]") {
  const double parts[] = {10., 1., .5, 12., .5, 1., 20., .25, 1.};
  const RollingFriction f{{.3, .3}, 1., 1., 3, parts};
  struct Known {
    double x, left, right;
  };
  for (const Known& known : {Known{-1e6, 1., .5},
                             {10., 1., .5},
                             {11., .75, .75},
                             {12., .5, 1.},
                             {16., .375, 1.},
                             {20., .25, 1.},
                             {1e9, .25, 1.}}) {
    double part[2];
    grip_at(f, known.x, part);
    INFO(known.x << " m");
    CHECK(part[0] == Approx(known.left));
    CHECK(part[1] == Approx(known.right));
  }
}

TEST_CASE("the moment of a contact is bounded where linear creep has no force", "[rolling_creep]") {
  for (const CreepLaw law : {CreepLaw::she, CreepLaw::fastsim, CreepLaw::polach}) {
    const RollingCreep c = creep_by(law, false);
    const double depth = std::pow(5e4 / kHertz, 2. / 3.);
    for (const double spin : {-60., -5., 5., 60.}) {
      const double across = -c.patch.kalker.c23 / c.patch.kalker.c22 *
                            std::sqrt(c.patch.half_length * c.patch.half_width) * spin;
      for (const double off : {0., 1e-6, 1e-2}) {
        const ContactCreep linear =
            creep_at(creep_by(CreepLaw::linear, false), depth, {0., across * (1. + off), spin});
        const ContactCreep at = creep_at(c, depth, {0., across * (1. + off), spin});
        CHECK(std::fabs(at.force[2]) <= std::fabs(linear.force[2]));
        CHECK(std::fabs(at.by_slip[2][1]) < 2. * std::fabs(linear.by_slip[2][1]));
      }
    }
  }
}

TEST_CASE("a wheel that rolls back creeps as the mirror image", "[rolling_creep]") {
  for (const CreepLaw law :
       {CreepLaw::linear, CreepLaw::she, CreepLaw::fastsim, CreepLaw::polach}) {
    const RollingCreep c = creep_by(law, true);
    std::mt19937_64 random(13);
    for (int n = 0; n < 100; ++n) {
      const auto [depth, slip] = drawn(random, .3);
      const double normal = normal_at(depth);
      const ContactCreep ahead = contact_creep(c, c.patch, .3, {depth, normal}, slip, kSpeed),
                         back = contact_creep(c, c.patch, .3, {depth, normal},
                                              {-slip.along, slip.across, -slip.spin}, -kSpeed);
      constexpr double kMirrored[3] = {-1., 1., -1.};
      for (int i = 0; i < 3; ++i) {
        CHECK(back.force[i] == kMirrored[i] * ahead.force[i]);
        CHECK(back.by_normal[i] == kMirrored[i] * ahead.by_normal[i]);
        for (int k = 0; k < 3; ++k)
          CHECK(back.by_slip[i][k] == kMirrored[i] * kMirrored[k] * ahead.by_slip[i][k]);
      }
    }
  }
}
