// Laws of force elements: their slopes, what is known of them in closed form, and that none makes
// energy.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "online/math/decay.h"
#include "online/runner/element_law.h"

using namespace railstep;

namespace {

constexpr double kStiff = 2e6, kLimit = 3e3;  // N/m, N

/// Friction that is moved from displacement to displacement.
class Rubbed {
 public:
  explicit Rubbed(ElementLaw law, double limit = kLimit) : limit_(limit) {
    element_.law = law;
    element_.stiffness = kStiff;
  }
  ElementForce at(double z) const { return element_force(element_, step(), z - memory_[0], 0.); }
  double move_to(double z) {
    const double from = z - memory_[0], force = element_force(element_, step(), from, 0.).force;
    keep_element(element_, step(), from, 0., memory_.data());
    return force;
  }
  void set_limit(double limit) { limit_ = limit; }

 private:
  ElementStep step() const { return {memory_.data(), limit_, 0., 0.}; }
  ForceElement element_{};
  double limit_;
  std::array<double, kMostElementMemory> memory_{};
};

constexpr std::array kFrictions = {ElementLaw::slider, ElementLaw::exponential, ElementLaw::berg};

ForceElement with_curve(ElementLaw law, const std::vector<double>& points, double before) {
  ForceElement e{};
  e.law = law;
  e.curve = {static_cast<std::int32_t>(points.size() / 3), before, points.data()};
  return e;
}

}  // namespace

TEST_CASE("the decaying exponential is that of the C library", "[element_law]") {
  double worst = 0.;
  for (double x = 0.; x < 40.; x += 1e-3)
    worst = std::max(worst, std::fabs(decay(x) / std::exp(-x) - 1.));
  INFO("relative error " << worst);
  CHECK(worst < 3e-14);
  CHECK(decay(0.) == 1.);
  CHECK(decay(41.) == 0.);
}

TEST_CASE("a spring of a table presses from its gaps on, a damper saturates", "[element_law]") {
  const std::vector<double> gaps = {-.01, 0., 0., .02, 0., 2e7};
  const ForceElement stop = with_curve(ElementLaw::spring, gaps, 2e7);
  const auto pressed = [&](double z) { return element_force(stop, {}, z, 0.); };
  for (const double z : {-.05, -.0101, -.005, .0, .015, .0201, .07}) {
    CAPTURE(z);
    CHECK((pressed(z + 1e-6).force - pressed(z - 1e-6).force) / 2e-6 ==
          Approx(pressed(z).slope).margin(1e-4));
  }
  CHECK(pressed(-.03).force == Approx(2e7 * .02));
  CHECK(pressed(.03).force == Approx(-2e7 * .01));
  CHECK(pressed(.015).force == 0.);

  const std::vector<double> yaw = {-.02, -12e3, 6e5, .02, 12e3, 0.};
  const ForceElement damper = with_curve(ElementLaw::damper, yaw, 0.);
  const auto damped = [&](double rate) {
    return element_force(damper, {nullptr, 0., 100., 0.}, rate / 100., 0.);
  };
  CHECK(damped(.01).force == Approx(-6e3));
  CHECK(damped(.01).slope == Approx(-6e5 * 100.));
  for (const double rate : {.02, .3, 5.}) CHECK(damped(rate).force == Approx(-12e3));
  for (const double rate : {-.02, -.3, -5.}) CHECK(damped(rate).force == Approx(12e3));
  CHECK(damped(.3).slope == 0.);
}

TEST_CASE("friction begins as its spring and ends at its limit", "[element_law]") {
  for (const ElementLaw law : kFrictions) {
    CAPTURE(static_cast<int>(law));
    const Rubbed rest(law);
    CHECK(rest.at(1e-9).force == Approx(-kStiff * 1e-9).epsilon(1e-5));
    CHECK(rest.at(1.).force == Approx(-kLimit).epsilon(2e-3));  // a hyperbola nears it slowly
    CHECK(rest.at(-1.).force == Approx(kLimit).epsilon(2e-3));
  }
  // Half of the limit: of a hyperbola where the tangent at rest has all of it (Berg's x2).
  CHECK(Rubbed(ElementLaw::berg).at(kLimit / kStiff).force == Approx(-.5 * kLimit));
  CHECK(Rubbed(ElementLaw::exponential).at(kLimit / kStiff).force ==
        Approx(-kLimit * (1. - std::exp(-1.))));
  CHECK(Rubbed(ElementLaw::slider).at(.999 * kLimit / kStiff).force == Approx(-.999 * kLimit));
}

TEST_CASE("friction in one direction does not depend on its steps", "[element_law]") {
  for (const ElementLaw law : kFrictions) {
    CAPTURE(static_cast<int>(law));
    Rubbed one(law), many(law);
    one.move_to(-1e-3);  // where it turns
    many.move_to(-1e-3);
    for (int i = 1; i < 1000; ++i) many.move_to(-1e-3 + 4e-6 * i);
    CHECK(many.move_to(3e-3) == Approx(one.move_to(3e-3)).epsilon(1e-11));
    CHECK(many.move_to(1e-3) == Approx(one.move_to(1e-3)).epsilon(1e-11));
  }
}

TEST_CASE("slopes of friction are its derivatives", "[element_law]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1., 1.);
  for (const ElementLaw law : kFrictions)
    for (int trial = 0; trial < 2000; ++trial) {
      ForceElement e{};
      e.law = law;
      e.stiffness = kStiff;
      e.loaded = 1;
      e.load_at_rest = 1e4;
      e.load_stiffness = 1e6;
      // The state of Berg's friction is an end of a branch as its law has it.
      const double before = 1e3 * any(random), way = 1e-3 * any(random),
                   missing = kLimit - (way < 0. ? -before : before),
                   after = before + missing * way / (missing / kStiff + std::fabs(way));
      const bool berg = law == ElementLaw::berg;
      const std::array<double, kMostElementMemory> memory = {0., before, berg ? way : 0., after};
      if (berg) e.loaded = 0;
      const ElementStep step{memory.data(), berg ? kLimit : .3, 0., 0.};
      const double z = 3e-3 * any(random), load = 5e-3 * any(random), small = 1e-8;
      const auto force = [&](double at_z, double at_load) {
        return element_force(e, step, at_z, at_load).force;
      };
      const ElementForce own = element_force(e, step, z, load);
      // Corners have no slope: those at which a slider begins to slide, and where motions turn.
      const double left = (own.force - force(z - small, load)) / small,
                   right = (force(z + small, load) - own.force) / small;
      if (std::fabs(left - right) > 1e-3 * kStiff) continue;
      CAPTURE(static_cast<int>(law), trial, z, load);
      CHECK(.5 * (left + right) == Approx(own.slope).epsilon(1e-4).margin(1e-6 * kStiff));
      CHECK(own.slope <= 0.);
      CHECK((force(z, load + small) - force(z, load - small)) / (2. * small) ==
            Approx(own.load_slope).epsilon(1e-4).margin(10.));
    }
}

TEST_CASE("an element behind its own compliance has the force of the displacement it has then",
          "[element_law]") {
  const std::vector<double> gaps = {-.01, 0., 0., .02, 0., 2e7},
                            yaw = {-.02, -12e3, 6e5, .02, 12e3, 0.};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1., 1.);
  double worst = 0.;
  for (int trial = 0; trial < 20'000; ++trial) {
    const auto law = static_cast<ElementLaw>(trial % kElementLaws);
    ForceElement e{};
    e.law = law;
    e.curve = {2, law == ElementLaw::spring ? 2e7 : 0.,
               law == ElementLaw::spring ? gaps.data() : yaw.data()};
    e.stiffness = kStiff;
    e.damping = law == ElementLaw::slider ? 200. : 0.;
    const double before = 1e3 * any(random), way = 1e-3 * any(random),
                 missing = kLimit - (way < 0. ? -before : before),
                 after = before + missing * way / (missing / kStiff + std::fabs(way));
    const bool berg = law == ElementLaw::berg;
    const std::array<double, kMostElementMemory> memory = {0., before, berg ? way : 0., after};
    const double value = law == ElementLaw::controlled ? 1e4 : kLimit;
    const ElementStep step{memory.data(), value, 2e3, any(random)};
    // Up to 1e4 times as soft as the element is stiff.
    const double compliance = std::pow(10., 4. * any(random)) / kStiff,
                 q = (2e-2 + 2. * kLimit * compliance) * any(random);
    const ElementForce own = element_force_behind(e, step, compliance, q, 0.);
    const double z = q + compliance * own.force;
    const ElementForce there = element_force(e, step, z, 0.);
    // Rounding of the displacement is a force by the slope of either side of a corner, and that of
    // the force a displacement by the compliance.
    const double stiffest = law == ElementLaw::spring   ? 2e7
                            : law == ElementLaw::damper ? 6e5 * step.rate
                                                        : 2e7;
    const double rounding =
        stiffest * 1e-16 * (std::fabs(q) + (1. + compliance * stiffest) * (std::fabs(z) + 1e-3)) +
        1e-9;
    worst = std::max(worst, std::fabs(there.force - own.force) / rounding);
    const double small = 1e-7 * (std::fabs(q) + 1e-3);
    const auto force = [&](double at_q) {
      return element_force_behind(e, step, compliance, at_q, 0.).force;
    };
    const double left = (own.force - force(q - small)) / small,
                 right = (force(q + small) - own.force) / small;
    if (std::fabs(left - right) > 1e-3 / compliance) continue;  // a corner
    CAPTURE(static_cast<int>(law), trial, q, compliance);
    CHECK(.5 * (left + right) == Approx(own.slope).epsilon(1e-3).margin(1e-4 / compliance));
    CHECK(own.slope <= 0.);
    CHECK(own.slope >= -1. / compliance);
  }
  INFO("largest difference over rounding " << worst);
  CHECK(worst < 50.);
}

TEST_CASE("no friction makes energy, whatever its limit does", "[element_law]") {
  constexpr int kParts = 20;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1., 1.);
  for (const ElementLaw law : kFrictions)
    for (const bool changes : {false, true}) {
      if (changes && law == ElementLaw::berg) continue;  // its limit does not
      CAPTURE(static_cast<int>(law), changes);
      double least = 0.;
      for (int trial = 0; trial < 2'000; ++trial) {
        Rubbed own(law);
        const double size = kLimit / kStiff * std::pow(10., any(random));
        double z = 0., last = 0., taken = 0.;
        for (int i = 0; i < 60; ++i) {
          if (changes) own.set_limit(kLimit * (1.1 + any(random)));
          const double part = size * any(random) / kParts;
          for (int k = 0; k < kParts; ++k) {
            const double force = own.move_to(z + part);
            // At constant limit the mean over a step: an implicit step takes no less.
            taken -= (changes ? force : .5 * (force + last)) * part;
            z += part;
            last = force;
            least = std::min(least, taken);
          }
        }
      }
      INFO("least energy taken " << least << " J, a spring at its limit has "
                                 << .5 * kLimit * kLimit / kStiff);
      CHECK(least > -1e-9);
    }
}

TEST_CASE("friction under less than its limit does not creep", "[element_law]") {
  for (const ElementLaw law : kFrictions) {
    CAPTURE(static_cast<int>(law));
    Rubbed own(law);
    own.move_to(.4 * kLimit / kStiff);
    const double held = own.at(.4 * kLimit / kStiff).force;
    // Rounding of a displacement that stands.
    for (int i = 0; i < 1'000'000; ++i)
      own.move_to(.4 * kLimit / kStiff * (1. + (i % 2 == 0 ? 1e-15 : -1e-15)));
    CHECK(own.move_to(.4 * kLimit / kStiff) == Approx(held).epsilon(1e-9));
  }
}

TEST_CASE("friction has no limit where nothing presses its faces", "[element_law]") {
  for (const ElementLaw law : {ElementLaw::slider, ElementLaw::exponential}) {
    ForceElement e{};
    e.law = law;
    e.stiffness = kStiff;
    e.loaded = 1;
    e.load_at_rest = 1e4;
    e.load_stiffness = 1e6;
    std::array<double, kMostElementMemory> memory{};
    const ElementStep step{memory.data(), .3, 0., 0.};
    CAPTURE(static_cast<int>(law));
    CHECK(element_force(e, step, 1., -.02).force == 0.);
    CHECK(element_force(e, step, 1., 0.).force == Approx(-3e3).epsilon(2e-3));
    keep_element(e, step, 1e-2, 0., memory.data());
    CHECK(element_force(e, step, 0., -.02).force == 0.);  // it lets go at once
    CHECK(std::fabs(element_force(e, step, 0., -.005).force) < 1.5e3 + 1e-9);
  }
}
