#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "offline/irregularity/defect.h"
#include "online/math/pi.h"

using namespace railstep;

namespace {

double at(const Signal& signal, double place) { return signal_at(signal.model(), place).value; }
double slope(const Signal& signal, double place) { return signal_at(signal.model(), place).slope; }

}  // namespace

TEST_CASE("a dipped joint has straight ramps, and the contact patch leaves its angle unchanged") {
  for (const double patch : {0., .014}) {
    const Signal dip = dipped_joint(30., .01, 1., {2e-3, patch});
    CHECK(at(dip, 28.9) == Approx(0.).margin(1e-12));
    CHECK(at(dip, 31.1) == Approx(0.).margin(1e-12));
    CHECK(at(dip, 29.5) == Approx(-5e-3).epsilon(1e-9));
    // A mean over the patch raises a kink by an eighth of the patch times its angle, 2 depth /
    // ramp.
    CHECK(at(dip, 30.) == Approx(-.01 + .02 * patch / 8.).epsilon(patch > 0. ? 1e-3 : 1e-12));
    const double away = 8 * 2e-3 + patch;  // a kink moves the spline n samples off by 0.27^n
    CHECK(slope(dip, 30. - away) == Approx(-.01).epsilon(1e-3));
    CHECK(slope(dip, 30. + away) == Approx(.01).epsilon(1e-3));
  }
}

TEST_CASE("corrugation is a wave between its ends") {
  const Signal wave = corrugation(10., 12., .1, 5e-5, {5e-3, 0.});
  CHECK(at(wave, 9.99) == Approx(0.).margin(1e-9));
  CHECK(at(wave, 12.01) == Approx(0.).margin(1e-9));
  for (int k = 0; k < 20; ++k)
    CHECK(at(wave, 10.9 + .01 * k) ==
          Approx(5e-5 * std::sin(2. * kPi * (.9 + .01 * k) / .1)).margin(1e-7));  // spline: 1e-4
  const Signal felt = corrugation(10., 12., .1, 5e-5, {5e-3, .02});
  CHECK(at(felt, 11.025) == Approx(5e-5 * std::sin(.2 * kPi) / (.2 * kPi)).epsilon(1e-3));
}

TEST_CASE("flats have their depths, and the wheel is whole elsewhere") {
  const double R = .46, l = .05, turn_length = 2. * kPi * R;
  const Signal fresh = fresh_flat(R, l, {5e-4, 0.});
  const Signal rounded = rounded_flat(R, l, l * l / (16. * R), {5e-4, 0.});
  CHECK(at(fresh, .5 * turn_length) == Approx(-l * l / (8. * R)).epsilon(1e-9));
  CHECK(at(rounded, .5 * turn_length) == Approx(-l * l / (16. * R)).epsilon(1e-9));
  for (const Signal* flat : {&fresh, &rounded}) {
    CHECK(at(*flat, .5 * turn_length - .6 * l) == Approx(0.).margin(1e-10));
    CHECK(at(*flat, .1) == Approx(0.).margin(1e-14));
    // Every turn of the wheel is the same.
    CHECK(at(*flat, .5 * turn_length + .01 + 1000. * turn_length) ==
          Approx(at(*flat, .5 * turn_length + .01)).epsilon(1e-9));
  }
  // A quarter of the length from the middle: the fresh flat falls by (l/4)^2 / 2R from its corner;
  // the rounded one is a half wave.
  CHECK(at(fresh, .5 * turn_length + .25 * l) == Approx(-l * l / (32. * R)).epsilon(1e-5));
  CHECK(at(rounded, .5 * turn_length + .25 * l) == Approx(-l * l / (32. * R)).epsilon(1e-5));
  CHECK(slope(fresh, .5 * turn_length + .25 * l) == Approx(l / (4. * R)).epsilon(1e-4));
}

TEST_CASE("an out-of-round wheel is a wave around its circumference") {
  const double R = .46;
  const Signal oval = out_of_round(R, 3, 2e-4, {.01, 0.});
  for (int k = 0; k < 12; ++k) {
    const double angle = 2. * kPi * k / 12. + .1;  // from the middle of the turn
    CHECK(at(oval, R * (kPi + angle)) == Approx(2e-4 * std::cos(3. * angle)).margin(2e-9));
  }
}

TEST_CASE("invalid defects are refused") {
  CHECK_THROWS_AS(dipped_joint(0., .01, 0., {1e-3, 0.}), std::invalid_argument);
  CHECK_THROWS_AS(dipped_joint(0., .01, 1., {0., 0.}), std::invalid_argument);
  CHECK_THROWS_AS(dipped_joint(0., .01, 1., {1e-9, 0.}), std::invalid_argument);
  CHECK_THROWS_AS(corrugation(0., .1, .1, 1e-5, {1e-3, 0.}), std::invalid_argument);
  // Under a patch of 12 mm a ramp of 1 nm needs 6e8 samples, one of 1e-300 m more than int holds.
  for (const double ramp : {1e-9, 1e-300})
    CHECK_THROWS_AS(dipped_joint(0., .01, ramp, {ramp / 50., .012}), std::invalid_argument);
  CHECK_THROWS_AS(fresh_flat(.46, .5, {1e-3, 0.}), std::invalid_argument);
  CHECK_THROWS_AS(out_of_round(.46, 0, 1e-4, {1e-3, 0.}), std::invalid_argument);
}
