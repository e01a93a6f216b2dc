// Critical loads: the tangent at equilibrium loses its first positive pivot there.
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/math/sparse.h"
#include "online/math/pi.h"
#include "support/beams.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Negative pivots of L D L' in the nodes' order; as many eigenvalues are negative (Sylvester).
int negative_pivots(const Structure& s, const Eigen::VectorXd& q) {
  const Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(
      free_part(s, tangent(s, q)));
  REQUIRE(factor.info() == Eigen::Success);
  return static_cast<int>((factor.vectorD().array() < 0.).count());
}

/// Load factor at which stability is lost, by bisection to 1e-9 along the symmetric path.
double critical_factor(const Structure& s, const StructureLoad& load, double low, double high) {
  Eigen::VectorXd q = s.rest;
  const auto at = [&](double factor) {
    StructureLoad part = load;
    part.force *= factor;
    return solved(s, part, &q);
  };
  q = at(low);
  REQUIRE(negative_pivots(s, q) == 0);
  REQUIRE(negative_pivots(s, at(high)) > 0);
  while (high - low > 1e-9 * high) {
    const double middle = .5 * (low + high);
    const Eigen::VectorXd there = at(middle);
    if (negative_pivots(s, there) > 0) {
      high = middle;
    } else {
      low = middle;
      q = there;
    }
  }
  return .5 * (low + high);
}

/// A column of length 1 that buckles upwards, twice as wide as high.
struct Column {
  double height, poisson;
  BeamSection section = rectangle_section(height, 2. * height, kShear);
  Material material = {.poisson = poisson};

  double euler(double length) const {
    return kPi * kPi * material.young * section.inertia_y / (length * length);
  }
  double critical(bool pinned, int elements) const {
    Structure s = straight_chain(beam_law(section, material), 1., elements);
    if (pinned) {
      hold(s, 0, {0, 1, 2, 3, 5});  // 3 and 5 are rotations about z and x
      hold(s, last_node(s), {1, 2, 5});
    } else {
      clamp_directions(s, 0);
    }
    const double first = euler(pinned ? 1. : 2.);
    return critical_factor(s, end_force(s, {-first, 0., 0.}), .5, 1.5) * first;
  }
};

/// Critical load of the element's law; points of zero moment are the length l apart. With the axis'
/// Green-Lagrange strain -e, stretch^2 = 1 - 2 e and slopes^2 = 1 + 2 nu e, the homogeneous
/// equations of deflection and rotation give
///   e (1 - 2 e)/(1 - e E/(k G (1 + 2 nu e))) = (pi/l)^2 I/A (1 - 3 e) (1 + 2 nu e),
///   P = E A e stretch.
/// To first order P is Euler's load less the part (2 - 2 nu + E/(k G)) (pi/l)^2 I/A of it.
double law_critical(const Column& c, double length) {
  const double E = c.material.young, kG = kShear * c.material.shear_modulus();
  const double slender = std::pow(kPi / length, 2) * c.section.inertia_y / c.section.area;
  double e = slender;
  for (int i = 0; i < 100; ++i) {
    const double slopes2 = 1. + 2. * c.poisson * e;
    e = slender * (1. - 3. * e) * slopes2 * (1. - e * E / (kG * slopes2)) / (1. - 2. * e);
  }
  return E * c.section.area * e * std::sqrt(1. - 2. * e);
}

}  // namespace

TEST_CASE("slender columns buckle at Euler's load", "[buckling]") {
  // Length over height is 100, with 16 elements. The law reduces the load by 0.9e-4 when clamped
  // and free, by 3.6e-4 when pinned; the demand is 1e-3.
  for (const double poisson : {0., .3})
    for (const bool pinned : {false, true}) {
      const Column column{.01, poisson};
      const double found = column.critical(pinned, 16), euler = column.euler(pinned ? 1. : 2.);
      CAPTURE(poisson, pinned, found / euler - 1.);
      CHECK_THAT(found, WithinRel(euler, 1e-3));
    }
}

TEST_CASE("thick columns buckle at the critical load of their law, from above", "[buckling]") {
  // Length over height is 10: the critical loads are 0.9 and 3.5 % below Euler's.
  for (const double poisson : {0., .3})
    for (const bool pinned : {false, true}) {
      const Column column{.1, poisson};
      const double exact = law_critical(column, pinned ? 1. : 2.);
      double error[3];
      for (int i = 0; i < 3; ++i) error[i] = column.critical(pinned, 4 << i) / exact - 1.;
      CAPTURE(poisson, pinned, exact / column.euler(pinned ? 1. : 2.), error[0], error[1],
              error[2]);
      // The order is 4, down to the tolerance of the bisection.
      CHECK(error[2] > -1e-8);
      CHECK_THAT(observed_order(error[0], error[1]), WithinAbs(4., .15));
      CHECK_THAT(observed_order(error[1], error[2]), WithinAbs(4., .15));
    }
}

TEST_CASE("a narrow strip under an end force tips over at Timoshenko's load", "[buckling]") {
  // Timoshenko and Gere, Theory of Elastic Stability, section 6.4: P L^2 = 4.013 sqrt(EIz GJ),
  // twice the first root of J_-1/4, 2.00629967, for a strip rigid in its plane. Bending in its
  // plane adds a term of (width over height)^2, which extrapolation takes out.
  const auto bessel = [](double x) {  // J_-1/4 (x), up to a positive factor
    double sum = 0., term = 1.;
    for (int k = 0; k < 40; ++k) {
      sum += term;
      term *= -(x * x / 4.) / ((k + 1) * (k + .75));
    }
    return sum;
  };
  double low = 1.5, high = 2.5;
  for (int i = 0; i < 60; ++i) (bessel(.5 * (low + high)) > 0. ? low : high) = .5 * (low + high);
  const double exact = low + high;
  CHECK_THAT(exact, WithinAbs(4.013, 5e-4));

  for (const double poisson : {0., .3}) {
    const auto factor = [&](double width, int elements) {
      const BeamSection section = rectangle_section(.1, width, kShear);
      const Material material{.poisson = poisson};
      Structure s = straight_chain(beam_law(section, material), 1., elements);
      clamp(s, 0);
      const double unit = std::sqrt(material.young * section.inertia_z * material.shear_modulus() *
                                    section.torsion);
      return critical_factor(s, end_force(s, {0., 0., -unit}), 2., 6.);
    };
    const double coarse = factor(.001, 4), middle = factor(.001, 8), fine = factor(.001, 16);
    const double wide = factor(.002, 16);
    CAPTURE(poisson, coarse, middle, fine, wide);
    CHECK_THAT(fine, WithinRel(exact, 1e-3));
    CHECK(middle < coarse);  // from above
    CHECK(fine < middle);
    CHECK(fine > exact);
    CHECK_THAT(observed_order(coarse - middle, middle - fine), WithinAbs(4., .3));
    // The mesh leaves a fifteenth of its last change, 3e-6 of the load; the fourth power of the
    // strip's width leaves 2e-7.
    const double limit = (4. * fine - wide) / 3. - (middle - fine) / 15.;
    CHECK_THAT(limit, WithinRel(exact, 3e-6));
  }
}
