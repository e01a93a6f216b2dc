// Rigid contact of a wheelset on its rails and equivalent conicity.
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/profile/wheel_rail.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

std::optional<double> conicity(const WheelRail& pair, double amplitude, bool with_roll = true) {
  RadiusDifference of;
  for (const WheelsetTouch& t : touches(pair, .0075, 5e-5, with_roll)) {
    of.shift.push_back(t.shift);
    of.difference.push_back(t.radius_difference());
  }
  return equivalent_conicity(of, amplitude, 1.5, .46);
}

}  // namespace

TEST_CASE("S1002 on 60E1 at 1:40 touches where it is known to", "[profile]") {
  // shift, radius difference mm, roll mrad, s right, left, rail right, left mm, angles degrees; by
  // another program on a grid of 0.01 mm.
  const double known[][9] = {{0, 0, 0, 3.226, 3.226, 35.726, 35.726, 1.395, 1.395},
                             {.5, .53115, .02349, -8.195, 5.107, 24.816, 37.096, 3.742, 1.135},
                             {1, .61379, .05286, -9.035, 6.529, 24.490, 38.005, 3.975, .963},
                             {2, .77672, .11373, -10.798, 8.720, 23.755, 39.167, 4.499, .745},
                             {3, .95865, .17967, -12.718, 10.437, 22.865, 39.854, 5.135, .617},
                             {4, 1.18555, .25345, -14.908, 11.876, 21.709, 40.259, 5.963, .544},
                             {4.5, 1.33149, .29450, -16.190, 12.522, 20.946, 40.386, 6.510, .522},
                             {5.5, 4.03211, .46741, -29.627, 13.766, 8.589, 40.552, 19.335, .501},
                             {6, 4.66110, .62111, -31.204, 14.384, 7.584, 40.598, 24.099, .501},
                             {6.5, 16.80889, 4.16724, -40.099, 17.102, .880, 41.180, 67.361, .593},
                             {7, 18.79511, 6.36060, -41.050, 18.629, 1.479, 41.190, 61.094, .716},
                             {8, 20.84164, 8.62198, -42.331, 20.309, 2.286, 40.817, 54.232, .917}};
  const WheelRail pair = wheel_pair("s1002.toml", 1. / 40.);
  for (const auto& row : known) {
    const WheelsetTouch t = touch(pair, 1e-3 * row[0], true);
    const double found[] = {1e3 * t.radius_difference(),   1e3 * t.roll,
                            1e3 * t.right.on_wheel,        1e3 * t.left.on_wheel,
                            1e3 * t.right.on_rail - 717.5, 1e3 * t.left.on_rail - 717.5,
                            t.right.angle * 180. / M_PI,   t.left.angle * 180. / M_PI};
    const double bound[] = {1e-3, 1e-3, 3e-3, 3e-3, 3e-3, 3e-3, 3e-3, 3e-3};
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(row[0], i);
      CHECK(found[i] == Approx(row[i + 1]).margin(bound[i]));
    }
  }
}

TEST_CASE("a wheelset shifted to the left lies as the mirror image", "[profile]") {
  const WheelRail pair = wheel_pair("s1002.toml", 1. / 20.);
  for (const double shift : {.7e-3, 3.1e-3, 6.3e-3}) {
    const WheelsetTouch a = touch(pair, shift, true), b = touch(pair, -shift, true);
    CHECK(a.radius_difference() == Approx(-b.radius_difference()).margin(1e-11));
    CHECK(a.roll == Approx(-b.roll).margin(1e-12));
    CHECK(a.height == Approx(b.height).epsilon(1e-12));
    CHECK(a.right.on_wheel == Approx(b.left.on_wheel).margin(1e-8));
  }
}

TEST_CASE("contacts of S1002 on 60E1 jump where they are known to", "[profile]") {
  const auto shifts = [](double inclination) {
    const WheelRail pair = wheel_pair("s1002.toml", inclination);
    std::vector<double> at;
    for (const ContactJump& jump : jumps_of(pair, touches(pair, .0065, 1e-4, true), true))
      if (jump.shift > 0.) at.push_back(1e3 * jump.shift);
    return at;
  };
  // Intervals of 0.05 mm in which the jumps lie, by another program.
  const auto within = [](const std::vector<double>& found, const std::vector<double>& low) {
    REQUIRE(found.size() == low.size());
    for (std::size_t i = 0; i < low.size(); ++i) {
      CAPTURE(found[i], low[i]);
      CHECK(found[i] > low[i]);
      CHECK(found[i] < low[i] + .05);
    }
  };
  within(shifts(1. / 40.), {.20, 4.95, 6.25});
  within(shifts(1. / 20.), {6.00, 6.05, 6.35});
}

TEST_CASE("equivalent conicities of S1002 on 60E1 are the known ones", "[profile]") {
  const double amplitude[] = {.5, 1., 2., 3., 4., 5.};
  const double at_40[] = {.590, .356, .221, .1771, .1588, .1735};
  const double at_20[] = {.0091, .0091, .0092, .0095, .0098, .0102};
  const WheelRail steep = wheel_pair("s1002.toml", 1. / 40.),
                  flat = wheel_pair("s1002.toml", 1. / 20.);
  for (std::size_t i = 0; i < 6; ++i) {
    CAPTURE(amplitude[i]);
    CHECK(conicity(steep, 1e-3 * amplitude[i]).value() == Approx(at_40[i]).margin(6e-4));
    CHECK(conicity(flat, 1e-3 * amplitude[i]).value() == Approx(at_20[i]).margin(6e-5));
  }
}

TEST_CASE("a cone has its own slope as conicity, level; with roll it is larger", "[profile]") {
  for (const auto& [name, slope] : {std::pair("cone_20.toml", .05), {"cone_40.toml", .025}}) {
    const WheelRail pair = wheel_pair(name, 1. / 40.);
    for (const double amplitude : {1e-3, 2e-3, 4e-3}) {
      CAPTURE(name, amplitude);
      const double level = conicity(pair, amplitude, false).value();
      CHECK(level == Approx(slope).epsilon(1e-3));
      const double with_roll = conicity(pair, amplitude).value();
      CHECK(with_roll > slope * 1.001);
      CHECK(with_roll < slope * 1.1);
    }
  }
}

TEST_CASE("the wavelength of a radius difference is that of its motion", "[profile]") {
  // y'' = -d(y) / (e r), integrated by small steps over a wave.
  RadiusDifference of;
  for (int i = -800; i <= 800; ++i) {
    const double y = 1e-5 * i;
    of.shift.push_back(y);
    of.difference.push_back(.3 * y + 4e3 * y * y * y + 30. * y * y);
  }
  const double amplitude = 3e-3, e = 1.5, r = .46;
  const double found = equivalent_conicity(of, amplitude, e, r).value();
  const auto difference = [](double y) { return .3 * y + 4e3 * y * y * y + 30. * y * y; };
  // Starts at the lower turning point, which a search finds, and ends at the upper one.
  double low = -6e-3, high = 0., wave = 0.;
  for (int turn = 0; turn < 60; ++turn) {
    const double start = .5 * (low + high);
    double y = start, rate = 0., x = 0.;
    const double dx = 2e-4;
    do {  // Verlet
      rate -= .5 * dx * difference(y) / (e * r);
      y += dx * rate;
      rate -= .5 * dx * difference(y) / (e * r);
      x += dx;
    } while (rate > 0.);
    (y - start > 2. * amplitude ? low : high) = start;
    wave = 2. * x;
  }
  CHECK(found == Approx(2. * M_PI * M_PI * e * r / (wave * wave)).epsilon(1e-3));
  CHECK_FALSE(equivalent_conicity(of, 9e-3, e, r).has_value());  // beyond the shifts
}

TEST_CASE("a wheel beside its rail is refused", "[profile]") {
  WheelRail pair = wheel_pair("s1002.toml", 1. / 40.);
  pair.half_distance = .6;
  CHECK_THROWS_WITH(touch(pair, 0., false), Catch::Matchers::Contains("E-TOUCH-01"));
}

TEST_CASE("a wheel that ends where it touches is refused", "[profile]") {
  WheelRail pair = s1002_on_60e1();
  pair.wheel = RunningSurface({{-.03, -.01, 0., 0., 0., {0., -.05}}});
  CHECK_THROWS_WITH(touch(pair, 0., false), Catch::Matchers::Contains("E-TOUCH-04"));
}

TEST_CASE("a wheelset that turns back half-way has no wave", "[profile]") {
  // V = y^4/4 - a^2 y^2/2 rises in the middle: at 3 mm the wheelset stays on one side.
  RadiusDifference of;
  for (int i = -800; i <= 800; ++i) {
    const double y = 1e-5 * i;
    of.shift.push_back(y);
    of.difference.push_back(1e5 * y * (y * y - 9e-6));
  }
  CHECK_FALSE(equivalent_conicity(of, 3e-3, 1.5, .46).has_value());
  CHECK(equivalent_conicity(of, 6e-3, 1.5, .46).value() > 0.);
}
