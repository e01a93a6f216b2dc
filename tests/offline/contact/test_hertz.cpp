#include <catch2/catch.hpp>
#include <cmath>

#include "offline/contact/hertz.h"

using namespace railstep;
using Catch::WithinAbs;
using Catch::WithinRel;

TEST_CASE("the elliptic integrals have the values of the tables", "[hertz]") {
  // Abramowitz and Stegun, table 17.1, to 15 digits: a dozen operations round.
  CHECK_THAT(elliptic_integrals(0.0).K, WithinRel(1.570796326794897, 1e-15));
  CHECK_THAT(elliptic_integrals(0.0).E, WithinRel(1.570796326794897, 1e-15));
  CHECK_THAT(elliptic_integrals(0.5).K, WithinRel(1.854074677301372, 1e-15));
  CHECK_THAT(elliptic_integrals(0.5).E, WithinRel(1.350643881047676, 1e-15));
  // Legendre's relation ties four values together: E K' + E' K - K K' = pi/2.
  for (double m : {0.01, 0.2, 0.7, 0.999}) {
    const auto [K, E] = elliptic_integrals(m);
    const auto [Kc, Ec] = elliptic_integrals(1.0 - m);
    CHECK_THAT(E * Kc + Ec * K - K * Kc, WithinRel(1.570796326794897, 1e-13));
  }
}

TEST_CASE("a wheel on a crown of 300 mm has the published contact", "[hertz]") {
  const HertzContact c = hertz_contact(0.46, 0.3, 210e9, 0.3, 100e3);
  // rail-data.md, Hertz: each to half of its last digit. hard-cases.md has C = 9.412508e10.
  CHECK_THAT(c.constant, WithinAbs(9.412508e10, 0.5e4));
  CHECK_THAT(c.half_along, WithinAbs(7.1617e-3, 0.5e-7));
  CHECK_THAT(c.half_across, WithinAbs(5.3872e-3, 0.5e-7));
  CHECK_THAT(c.peak_pressure, WithinAbs(1237.6e6, 0.05e6));
  CHECK_THAT(c.approach, WithinAbs(0.10412e-3, 0.5e-8));
  CHECK_THAT(c.stiffness, WithinAbs(1.4407e9, 0.5e5));

  const HertzContact narrow = hertz_contact(0.46, 0.254, 210e9, 0.3, 100e3);
  CHECK_THAT(narrow.half_along, WithinAbs(7.3446e-3, 0.5e-7));
  CHECK_THAT(narrow.half_across, WithinAbs(4.9464e-3, 0.5e-7));
  CHECK_THAT(narrow.peak_pressure, WithinAbs(1314.3e6, 0.05e6));
  CHECK_THAT(narrow.approach, WithinAbs(0.10680e-3, 0.5e-8));
}

TEST_CASE("equal radii give the contact of a sphere", "[hertz]") {
  const double R = 0.3, P = 100e3, modulus = 210e9 / (2.0 * (1.0 - 0.09));
  const HertzContact c = hertz_contact(R, R, 210e9, 0.3, P);
  // Closed form: a^3 = 3PR/(4E*), delta = a^2/R, C = 4/3 E* sqrt(R), with a few roundings.
  const double a = std::cbrt(0.75 * P * R / modulus);
  CHECK_THAT(c.half_along, WithinRel(a, 1e-14));
  CHECK_THAT(c.half_across, WithinRel(a, 1e-14));
  CHECK_THAT(c.approach, WithinRel(a * a / R, 1e-14));
  CHECK_THAT(c.constant, WithinRel(4.0 / 3.0 * modulus * std::sqrt(R), 1e-14));
  // The constant does not jump nearby: delta is even in the log of the ratio at fixed mean
  // curvature, so 1e-6 more radius on one side changes C as half of that on both sides.
  for (double x : {1e-12, 1e-9, 1e-6, 3e-5}) {
    const double beside = hertz_contact(R * (1.0 + x), R / (1.0 + x), 210e9, 0.3, P).constant;
    CHECK_THAT(beside, WithinRel(c.constant, x * x + 1e-10));
  }
}

TEST_CASE("the constant does not depend on the load, and the axes swap with the radii", "[hertz]") {
  const HertzContact light = hertz_contact(0.46, 0.3, 210e9, 0.3, 1.0);
  const HertzContact heavy = hertz_contact(0.46, 0.3, 210e9, 0.3, 1e6);
  CHECK_THAT(light.constant, WithinRel(heavy.constant, 1e-14));  // a dozen roundings
  const HertzContact turned = hertz_contact(0.3, 0.46, 210e9, 0.3, 1e6);
  CHECK(turned.half_along == heavy.half_across);
  CHECK(turned.constant == heavy.constant);
}

TEST_CASE("numbers that cannot describe a contact are refused in a sentence", "[hertz]") {
  CHECK_THROWS_WITH(hertz_contact(-1, 1, 1, 0, 1), Catch::Contains("E-CONTACT-01"));
  CHECK_THROWS_WITH(hertz_contact(1, std::nan(""), 1, 0, 1), Catch::Contains("E-CONTACT-02"));
  CHECK_THROWS_WITH(hertz_contact(1, 1, 0, 0, 1), Catch::Contains("E-CONTACT-03"));
  CHECK_THROWS_WITH(hertz_contact(1, 1, 1, 0.6, 1), Catch::Contains("E-CONTACT-04"));
  CHECK_THROWS_WITH(hertz_contact(1, 1, 1, 0, 0), Catch::Contains("E-CONTACT-05"));
  CHECK_THROWS_WITH(hertz_contact(1, 1e7, 1, 0, 1), Catch::Contains("E-CONTACT-06"));
}
