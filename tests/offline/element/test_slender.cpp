// A beam so slender that its axial stiffness is 1e8 times its bending stiffness.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/beams.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;

namespace {

/// End deflection, over P L^3/3EI, of a cantilever with length over height 1e4, under the load that
/// gives it `deflection` (over the length).
double slender_ratio(double poisson, double deflection, int elements) {
  const double length = 2., height = length / 1e4;
  const BeamSection section = rectangle_section(height, height, 5. / 6.);
  const Material material{.poisson = poisson};
  const double load = 3. * material.young * section.inertia_y / (length * length) * deflection;
  Structure s = straight_chain(beam_law(section, material), length, elements);
  clamp(s, 0);
  const Eigen::VectorXd q = solved(s, end_force(s, {0., 0., load}));
  return end_position(s, q)[2] / (deflection * length);
}

}  // namespace

TEST_CASE("a cantilever of length over height 1e4 bends by PL^3/3EI", "[slender]") {
  // This is H12 of hard-cases.md. The formula leaves out shear, below (h/L)^2 = 1e-8, and the end's
  // shorter lever, which is of the slope squared, 1e-8 and less.
  for (const double poisson : {0., .3})
    for (const double deflection : {1e-6, 1e-4}) {
      for (const int elements : {1, 2, 4}) {
        CAPTURE(poisson, deflection, elements);
        CHECK_THAT(slender_ratio(poisson, deflection, elements), WithinAbs(1., 1e-6));
      }
      // K's condition grows with the number of elements and with the square of length over an
      // element's height. H12 allows rounding to lose 1e-4 with 64 elements; it loses 1.6e-7.
      const double many = slender_ratio(poisson, deflection, 64);
      CAPTURE(poisson, deflection, many - 1.);
      CHECK_THAT(many, WithinAbs(1., 1e-5));
    }
}
