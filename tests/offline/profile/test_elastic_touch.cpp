// Contact patches by strips: against Hertz, CONTACT and their own energy.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/profile/elastic_touch.h"
#include "support/wheel_pair.h"

using namespace railstep;

namespace {

constexpr double kPlain = kSteelModulus / kOfModulus;  // without the calibrated factor

/// A wheel of 0.46 m on a crown, by strips over its patch.
struct OnCrown {
  double crown;  // m
  int strips = 64;
  double modulus = kPlain;
  PatchForce under(double approach) const {
    const double half = std::sqrt(2. * crown * kVirtualPart * approach);
    const double width = 2. * half / strips;
    std::vector<double> gap;
    const int middle = strips / 2;
    for (int i = 0; i <= strips; ++i) {
      const double y = (i - middle) * width;
      gap.push_back(y * y / (2. * crown));
    }
    StripPatch patch{gap.data(), strips + 1, 1. * middle, {}, width, .46, modulus};
    patch.collocation = collocation_of(patch, approach);
    return patch_force(patch, approach);
  }
};

// The material of the CONTACT rows: G 82 GPa, nu 0.28.
const Elastic kContact{2. * 82e9 * 1.28, .28};

}  // namespace

TEST_CASE("a wheel on a crown of 300 mm is near Hertz", "[profile]") {
  // Hertz at 100 kN: 0.10412 mm, a 7.162 mm, 1237.6 MPa. The law's own integrals by another program
  // with adaptive quadrature: 0.1018708 mm, a 7.179597 mm, 1146.990 MPa.
  double low = 1e-6, high = 1e-3;
  const OnCrown wheel{.3};
  for (int i = 0; i < 60; ++i) {
    const double middle = .5 * (low + high);
    (wheel.under(middle).normal < 1e5 ? low : high) = middle;
  }
  const PatchForce found = wheel.under(low);
  CHECK(1e3 * low == Approx(.1018708).epsilon(1e-3));
  CHECK(OnCrown{.3, 64, kSteelModulus}.under(.10412e-3).normal == Approx(1e5).epsilon(.015));
  CHECK(1e3 * found.half_length == Approx(7.179597).epsilon(1e-3));
  CHECK(1e-6 * found.pressure == Approx(1146.990).epsilon(1e-3));
  CHECK(found.centre == Approx(0.).margin(1e-9));
}

TEST_CASE("forces of bodies of constant curvature rise with the power of 1.5", "[profile]") {
  // Shapes at all approaches are like each other, so that the law has Hertz's exponent.
  for (const double crown : {.013, .08, .3, 2.}) {
    const OnCrown wheel{crown};
    CHECK(wheel.under(2e-4).normal / wheel.under(1e-4).normal ==
          Approx(std::pow(2., 1.5)).epsilon(1e-9));
  }
}

TEST_CASE("the stiffness of a patch is the slope of its force", "[profile]") {
  // Strips stand, as in a step; the gap is not a parabola and has two valleys.
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> part(.3, 1.);
  for (int trial = 0; trial < 200; ++trial) {
    double gap[40];
    const double a = part(engine), b = part(engine), c = part(engine);
    for (int i = 0; i < 40; ++i) {
      const double y = (i - 20) / 20.;
      gap[i] = 1e-4 * (a * y * y + b * y * y * y * y + .2 * c * (1. - std::cos(6. * y)));
    }
    StripPatch patch{gap, 40, 20., {}, .5e-3, .46, kSteelModulus};
    const double approach = 1.2e-4 * part(engine), h = 1e-11;
    patch.collocation = collocation_of(patch, 1.2 * part(engine) * approach);
    const PatchForce at = patch_force(patch, approach);
    const double slope =
        (patch_force(patch, approach + h).normal - patch_force(patch, approach - h).normal) /
        (2. * h);
    CAPTURE(trial);
    // A strip that begins to touch within h is left out of the slope, not of the force.
    CHECK(at.stiffness == Approx(slope).epsilon(1e-5));
    CHECK(at.stiffness * approach > 1.2 * at.normal);
  }
}

TEST_CASE("strips converge", "[profile]") {
  const double fine = OnCrown{.08, 128}.under(1e-4).normal;
  CHECK(OnCrown{.08, 16}.under(1e-4).normal == Approx(fine).epsilon(2e-3));
  CHECK(OnCrown{.08, 32}.under(1e-4).normal == Approx(fine).epsilon(5e-4));
  CHECK(OnCrown{.08, 64}.under(1e-4).normal == Approx(fine).epsilon(1e-4));
}

TEST_CASE("no approach has no force", "[profile]") {
  const double gap[] = {0., 1e-5};
  const StripPatch patch{gap, 2, 0, {}, 1e-3, .46, kSteelModulus};
  for (const double approach : {0., -1e-5, std::nan("")}) {
    const PatchForce none = patch_force(patch, approach);
    CHECK(none.normal == 0.);
    CHECK(none.stiffness == 0.);
  }
}

TEST_CASE("rolling radii under 60 kN are within 8 % of those of CONTACT", "[profile]") {
  // Differences in mm at shifts of 1 to 4.5 mm by CONTACT, on a measured rail up to 0.023 mm off
  // 60E1.
  const double contact[] = {.419, .602, .748, .870, .987, 1.110, 1.251, 1.438};
  const WheelRail pair = s1002_on_60e1();
  for (int i = 0; i < 8; ++i) {
    const double shift = 1e-3 + .5e-3 * i;
    const WheelsetLoaded w = loaded(pair, kContact, shift, 60e3);
    const double found = 1e3 * w.radius_difference();
    CAPTURE(shift);
    CHECK(found == Approx(contact[i]).epsilon(.08));
    double sum = 0.;
    for (const WheelPatch& p : w.right.patches) sum += p.upright;
    CHECK(sum == Approx(60e3).epsilon(1e-6));
  }
}

TEST_CASE("approaches and centres under 60 kN are near those of CONTACT", "[profile]") {
  // Wheel, shift mm, CONTACT's approach mm, centre mm. Its rail is up to 0.023 mm off 60E1, which
  // moves the contact within 1 mm of the middle and near the jump at 5 mm.
  struct Known {
    bool right;
    double shift, approach, centre;
  };
  const Known known[] = {{true, 2., .08062, -10.53}, {true, 3., .08154, -13.08},
                         {true, 4., .07936, -15.56}, {true, 5.5, .10220, -29.56},
                         {true, 6., .09748, -31.35}, {false, 1., .06302, 5.44},
                         {false, 3., .06984, 9.98},  {false, 6., .07491, 14.12}};
  const WheelRail pair = s1002_on_60e1();
  for (const Known& k : known) {
    const WheelsetLoaded w = loaded(pair, kContact, 1e-3 * k.shift, 60e3);
    const WheelPatch* most = nullptr;
    for (const WheelPatch& p : (k.right ? w.right : w.left).patches)
      if (most == nullptr || p.force.normal > most->force.normal) most = &p;
    REQUIRE(most != nullptr);
    CAPTURE(k.right, k.shift);
    CHECK(1e3 * most->approach == Approx(k.approach).epsilon(.03));
    CHECK(1e3 * most->centre.on_wheel == Approx(k.centre).margin(.8));
  }
}

TEST_CASE("the rails carry the load that is asked for, beside jumps of the contact too",
          "[profile]") {
  const WheelRail pair = s1002_on_60e1();
  for (const double force : {5e3, 30e3, 60e3, 120e3})
    for (double shift = 0.; shift < 7.05e-3; shift += 2.5e-4) {
      const WheelsetLoaded w = loaded(pair, kContact, shift, force);
      CAPTURE(force, shift);
      for (const WheelLoaded& wheel : {w.right, w.left}) {
        double sum = 0.;
        for (const WheelPatch& p : wheel.patches) sum += p.upright;
        CHECK(sum == Approx(force).epsilon(1e-5));
      }
      // Where two patches become one as the wheelset rolls, heights step.
      CHECK(w.right.height == Approx(w.left.height).margin(1e-5));
    }
}
