// The law of strips and local Hertz contact against elastic half-spaces, S1002 on 60E1 under 60 kN.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/contact/hertz.h"
#include "offline/profile/elastic_touch.h"
#include "support/half_space.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

constexpr int kElements = 36;  // each way

/// Approach and centre on the wheel of half-spaces that carry the force of a patch, m.
struct Reference {
  double approach, centre;
};

Reference half_space(const WheelRail& pair, const WheelOverRail& wheel, const WheelPatch& patch) {
  const double s = patch.deepest.on_wheel, cosine = std::cos(patch.deepest.angle);
  const double lowest = wheel.distance(s), radius = (pair.radius + patch.deepest.growth) / cosine;
  const auto normal = [&](double place) { return cosine * (wheel.distance(place) - lowest); };
  double from = s, to = s;  // where undeformed bodies overlap
  while (normal(from) < patch.approach) from -= 1e-4;
  while (normal(to) < patch.approach) to += 1e-4;
  const double middle = .5 * (from + to), half_length = 1.27 * patch.force.half_length;
  const HalfSpace grid(kElements, kElements, 2. * half_length / kElements,
                       (to - from) / cosine / kElements, kSteelModulus);
  const auto gap = [&](double x, double t) {
    return x * x / (2. * radius) + normal(middle + cosine * t);
  };
  double approach = patch.approach;
  for (int turn = 0; turn < 4; ++turn)
    approach *= std::pow(patch.force.normal / grid.solve(gap, approach).force, 1. / 1.6);
  const HalfSpace::Answer found = grid.solve(gap, approach);
  CHECK(found.force == Approx(patch.force.normal).epsilon(2e-3));
  return {approach, middle + cosine * found.centre};
}

/// Approach by Hertz with the curvatures at the rigid contact, m.
double local_hertz(const WheelRail& pair, const WheelTouch& at, double force) {
  const SurfacePoint wheel = pair.wheel.at(at.on_wheel), rail = pair.rail.at(at.on_rail);
  const auto curvature = [](const SurfacePoint& p) {
    return -p.curvature / std::pow(1. + p.slope * p.slope, 1.5);
  };
  return hertz_contact((pair.radius + at.growth) / std::cos(at.angle),
                       1. / (curvature(wheel) + curvature(rail)), 210e9, .3, force)
      .approach;
}

}  // namespace

TEST_CASE("half-spaces have Hertz's contact", "[half_space]") {
  const HalfSpace grid(40, 40, 2. * 8.2e-3 / 40., 2. * 6.3e-3 / 40., kSteelModulus);
  const HertzContact hertz = hertz_contact(.46, .3, 210e9, .3, 1e5);
  const HalfSpace::Answer found =
      grid.solve([](double x, double y) { return x * x / .92 + y * y / .6; }, hertz.approach);
  CHECK(found.force == Approx(1e5).epsilon(1e-3));
  CHECK(found.pressure == Approx(hertz.peak_pressure).epsilon(2e-3));
  CHECK(found.area == Approx(M_PI * hertz.half_along * hertz.half_across).epsilon(.03));
  CHECK(found.centre == Approx(0.).margin(1e-6));
}

TEST_CASE("strips have the approach and the centre of half-spaces, local Hertz has not",
          "[half_space]") {
  const WheelRail pair = s1002_on_60e1();
  double square = 0., most = 0., most_hertz = 0.;
  int count = 0;
  for (const double shift : {0., .5e-3, 1e-3, 2e-3, 4e-3, 6e-3}) {
    const WheelsetLoaded w = loaded(pair, {}, shift, 60e3);
    const WheelsetTouch rigid = touch(pair, shift, true);
    for (const bool right : {true, false}) {
      const auto& patches = (right ? w.right : w.left).patches;
      const WheelPatch& patch = *std::max_element(
          patches.begin(), patches.end(),
          [](const auto& a, const auto& b) { return a.force.normal < b.force.normal; });
      const WheelOverRail wheel(pair, right ? shift : -shift, right ? w.roll : -w.roll);
      const Reference exact = half_space(pair, wheel, patch);
      const double error = patch.approach / exact.approach - 1.;
      const double hertz =
          local_hertz(pair, right ? rigid.right : rigid.left, patch.force.normal) / exact.approach -
          1.;
      CAPTURE(shift, right, error, hertz);
      CHECK(std::abs(error) < .021);
      CHECK(patch.centre.on_wheel == Approx(exact.centre).margin(shift > 5e-3 ? 1e-4 : 6e-4));
      square += error * error;
      most = std::max(most, std::abs(error));
      most_hertz = std::max(most_hertz, std::abs(hertz));
      ++count;
    }
  }
  CHECK(std::sqrt(square / count) < .015);
  CHECK(most_hertz > 5. * most);
}
