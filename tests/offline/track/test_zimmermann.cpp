#include <catch2/catch.hpp>
#include <cmath>

#include "offline/analysis/statics.h"
#include "support/bending.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

// Zimmermann's rail on a continuous Winkler bed as the limit of seats that get closer, and the
// discretely supported rail of set S1 (rail-data.md).

namespace {

constexpr double kInertia = 3038.3e-8, kArea = 7670e-6, kLoad = 100e3;

Track r60(double shear_factor) {
  Track t;
  t.rails = 1;
  t.unknowns = Unknowns::vertical;
  t.section = {.area = kArea,
               .inertia_y = kInertia,
               .inertia_z = 512e-8,
               .torsion = 221e-8,
               .shear_factor_y = .4,
               .shear_factor_z = shear_factor};
  return t;
}

/// 24 m of R60 on a bed of `stiffness` per metre: seats `spacing` apart with one element between.
Track on_bed(double stiffness, double spacing, double shear_factor) {
  Track t = r60(shear_factor);
  t.bay_length = spacing;
  t.bays = 2 * static_cast<int>(std::lround(12. / spacing));
  t.elements_per_bay = 1;
  t.support.stiffness = {0., 0., stiffness * spacing};
  return t;
}

struct UnderLoad {
  double deflection, moment, aside, moment_aside;  // m, N m, and both 1.2 m away
};

UnderLoad under_load(const Track& t) {
  const Statics statics(t);
  const double x = .5 * t.length();
  const auto u = statics.solve({{{0, x, 0., 0., 2}, -kLoad}});
  const auto moment = [&](double at) { return bending_moment(t, statics.lines(), u, 0, at); };
  return {-statics.at(u, {0, x, 0., 0., 2}), moment(x), -statics.at(u, {0, x + 1.2, 0., 0., 2}),
          moment(x + 1.2)};
}

/// Winkler's closed form of an infinite Timoshenko beam, E I w'''' - (E I k / G A_s) w'' + k w = 0,
/// w down: w = w0 e^(-a x) (cos b x + c sin b x). The bed carries the load, 2 k int w = P, without
/// rotation under it, w'(0+) = -P / (2 G A_s). Zimmermann's has an infinite shear stiffness.
UnderLoad winkler(double k, double shear_factor) {
  const double EI = 210e9 * kInertia, GA = 210e9 / 2.6 * kArea * shear_factor;
  const double product = std::sqrt(k / (4. * EI)), half = k / (4. * GA);
  const double a = std::sqrt(product + half), b = std::sqrt(product - half);
  const double bed = kLoad * 2. * product / (2. * k), shear = kLoad / (2. * GA);
  const double w0 = (bed + shear) / (2. * a), c = (bed - shear) / (2. * b * w0);
  const auto w = [=](double x) {
    return w0 * std::exp(-a * x) * (std::cos(b * x) + c * std::sin(b * x));
  };
  const auto moment = [=](double x) {
    const double second = w0 * std::exp(-a * x) *
                          ((a * a - b * b - 2. * a * b * c) * std::cos(b * x) +
                           ((a * a - b * b) * c + 2. * a * b) * std::sin(b * x));
    return -EI * (second - k / GA * w(x));
  };
  return {w(0.), moment(0.), w(1.2), moment(1.2)};
}

}  // namespace

TEST_CASE("the closed form has the printed numbers", "[statics]") {
  // rail-data.md has four digits: half a unit of the last.
  const UnderLoad euler = winkler(60e6, 1e9), timoshenko = winkler(60e6, .4);
  CHECK_THAT(euler.deflection, WithinAbs(1.0319e-3, 5e-8));
  CHECK_THAT(euler.moment, WithinAbs(20.190e3, .5));
  CHECK_THAT(timoshenko.deflection, WithinAbs(1.0920e-3, 5e-8));
  CHECK_THAT(timoshenko.moment, WithinAbs(19.803e3, .5));
  CHECK_THAT(winkler(30e6, 1e9).deflection, WithinAbs(1.7354e-3, 5e-8));
  CHECK_THAT(winkler(30e6, 1e9).moment, WithinAbs(24.010e3, .5));
}

TEST_CASE("seats that get closer converge to Zimmermann's bed with second order", "[statics]") {
  // Seats are the trapezoidal rule of the bed's forces. It errs by h2/12 of the jump in the
  // integrand's slope under the load: always for a moment's influence line, only by shear for a
  // deflection's. Without shear the deflection converges faster.
  const double shear_factor = GENERATE(.4, 40.);
  const UnderLoad exact = winkler(60e6, shear_factor);
  double before[4] = {};
  for (const double spacing : {.3, .15, .075}) {
    const UnderLoad found = under_load(on_bed(60e6, spacing, shear_factor));
    const double error[4] = {
        found.moment / exact.moment - 1., found.moment_aside / exact.moment_aside - 1.,
        found.deflection / exact.deflection - 1., found.aside / exact.aside - 1.};
    for (int i = 0; i < 4; ++i) {
      const double order = before[i] != 0. ? std::log2(before[i] / error[i]) : 2.;
      CHECK(order > 1.9);
      if (i < 2 || shear_factor < 1.) CHECK(order < 2.1);
      before[i] = error[i];
    }
  }
  CHECK(std::abs(before[0]) < 2e-3);
  CHECK(std::abs(before[2]) < 2e-4);
}

TEST_CASE("set S1 has the reference's bending moments over a sleeper and at mid-bay", "[statics]") {
  // rail-data.md has 17.07 and 20.51 kN m under 100 kN, with four digits.
  Track t = r60(.4);
  t.bays = 40;
  t.elements_per_bay = 2;
  t.support.stiffness = {0., 0., 200e6};
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  const Statics statics(t);
  for (const auto& [x, moment] : {std::pair{12., 17.07e3}, {12.3, 20.51e3}}) {
    const auto u = statics.solve({{{0, x, 0., 0., 2}, -kLoad}});
    CHECK_THAT(bending_moment(t, statics.lines(), u, 0, x, From::behind), WithinAbs(moment, 5.));
    CHECK_THAT(bending_moment(t, statics.lines(), u, 0, x, From::ahead), WithinAbs(moment, 5.));
  }
  // Between two seats the moment is linear.
  const auto u = statics.solve({{{0, 12., 0., 0., 2}, -kLoad}});
  const auto at = [&](double x) { return bending_moment(t, statics.lines(), u, 0, x); };
  CHECK_THAT(at(12.15), WithinRel(.75 * at(12.) + .25 * at(12.6), 1e-9));
  CHECK_THROWS_WITH(at(24.1), Catch::Contains("E-TRACK-05"));
}

TEST_CASE("rails on common sleepers each have their own bending moment", "[statics]") {
  Track t = r60(.4);
  t.unknowns = Unknowns::full;
  t.rails = 2;
  t.bays = 12;
  t.support.stiffness = {50e6, 50e6, 200e6};
  t.support.roll_stiffness = 3e5;
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  const Statics statics(t);
  const double x = 3.6;
  const auto u = statics.solve({{{0, x, 0., 0., 2}, -kLoad}});
  const double loaded = bending_moment(t, statics.lines(), u, 0, x);
  const double other = bending_moment(t, statics.lines(), u, 1, x);
  // The rotations by differences: b_x is the x position of a point one metre above the axis.
  const double h = 1e-4;
  for (const auto& [rail, moment] : {std::pair{0, loaded}, {1, other}}) {
    const auto turn = [&, on = rail](double at) {
      return statics.at(u, {on, at, 0., 1., 0}) - statics.at(u, {on, at, 0., 0., 0});
    };
    const double slope = (3. * turn(x) - 4. * turn(x - h) + turn(x - 2. * h)) / (2. * h);
    CHECK_THAT(moment, WithinRel(-210e9 * kInertia * slope, 1e-6));
  }
  CHECK(loaded > 10e3);
  CHECK(std::abs(other) < .2 * loaded);
}
