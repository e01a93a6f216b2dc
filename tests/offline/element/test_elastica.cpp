// A cantilever with large deflections under an end force that keeps its direction.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/beams.h"
#include "support/rod.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;

namespace {

/// Deflection and shortening over the length of a cantilever without stretch and shear, for alpha =
/// F L^2/EI: Bisshopp and Drucker, Quart. Appl. Math. 3 (1945), 272-275. With the end's slope
/// theta, p^2 = (1 + sin theta)/2 and sin phi = 1/(p sqrt 2),
///   sqrt(alpha) = K(p) - F(p, phi), w/L = 1 - 2 (E(p) - E(p, phi))/sqrt(alpha),
///   u/L = 1 - sqrt(2 sin(theta)/alpha).
struct Elastica {
  double deflection, shortening;
};

Elastica elastica(double alpha) {
  double low = 0., high = .5 * std::numbers::pi, p = 0., phi = 0., theta = 0.;
  for (int i = 0; i < 100; ++i) {
    theta = .5 * (low + high);
    p = std::sqrt(.5 * (1. + std::sin(theta)));
    phi = std::asin(1. / (p * std::sqrt(2.)));
    (std::comp_ellint_1(p) - std::ellint_1(p, phi) < std::sqrt(alpha) ? low : high) = theta;
  }
  return {1. - 2. * (std::comp_ellint_2(p) - std::ellint_2(p, phi)) / std::sqrt(alpha),
          1. - std::sqrt(2. * std::sin(theta) / alpha)};
}

/// A square beam of length 1 and EI = 1.
struct Slender {
  BeamSection section;
  Material material;
  explicit Slender(double height, double poisson)
      : section(rectangle_section(height, height, kShear)),
        material{.young = 1. / section.inertia_y, .poisson = poisson} {}
  Structure clamped(int elements) const {
    Structure s = straight_chain(beam_law(section, material), 1., elements);
    clamp(s, 0);
    return s;
  }
  Rod rod() const {
    const double EA = material.young * section.area;
    const double GA = material.shear_modulus() * section.area * kShear;
    return {1., {EA, GA, GA}, {material.shear_modulus() * section.torsion, 1., 1.}};
  }
};

/// Ends under each load; each solution starts from the equilibrium before.
std::vector<Vector3d> ends(const Structure& s, const std::vector<double>& alphas) {
  std::vector<Vector3d> result;
  Eigen::VectorXd q = s.rest;
  for (const double alpha : alphas) {
    q = solved(s, end_force(s, alpha * Vector3d::UnitZ()), &q);
    result.push_back(end_position(s, q));
  }
  return result;
}

const std::vector<double> kAlphas = {1., 2., 4., 10.};

}  // namespace

TEST_CASE("the elliptic integrals give the elastica's printed values", "[elastica]") {
  // The five digits of reference.md, "Elastica, F L^2/EI = 4".
  const Elastica at = elastica(4.);
  CHECK_THAT(at.deflection, WithinAbs(.66996, 5e-6));
  CHECK_THAT(at.shortening, WithinAbs(.32894, 5e-6));
}

TEST_CASE("a rod rigid in shear and stretch is the elastica", "[elastica]") {
  // These are two ways to the reference itself; 400 Runge-Kutta steps of 2.5e-3 leave 1e-10.
  for (const double alpha : kAlphas) {
    const Elastica at = elastica(alpha);
    const Rod rod{1., {1e14, 1e14, 1e14}, {1., 1., 1.}};
    const RodPoint end = clamped_rod_end(rod, {0., 0., alpha}, {0., 0., 0.});
    CHECK_THAT(end.r[2], WithinAbs(at.deflection, 1e-9));
    CHECK_THAT(1. - end.r[0], WithinAbs(at.shortening, 1e-9));
  }
}

TEST_CASE("a slender cantilever bends into the elastica", "[elastica]") {
  // Length over height is 500. The elastica lacks shear, F L/(k G A) = alpha EI/(k G A L^2) =
  // 1.0e-6 alpha, and effects of the material law of that size (next test): together below 4e-6
  // alpha. The mesh's error is less than the change by its last halving.
  for (const double poisson : {0., .3}) {
    const Slender beam(2e-3, poisson);
    const std::vector<Vector3d> coarse = ends(beam.clamped(16), kAlphas);
    const std::vector<Vector3d> middle = ends(beam.clamped(32), kAlphas);
    const std::vector<Vector3d> fine = ends(beam.clamped(64), kAlphas);
    for (std::size_t i = 0; i < kAlphas.size(); ++i) {
      const Elastica at = elastica(kAlphas[i]);
      const Vector3d exact(1. - at.shortening, 0., at.deflection);
      const double change = (fine[i] - middle[i]).norm(), error = (fine[i] - exact).norm();
      CAPTURE(poisson, kAlphas[i], change, error);
      CHECK(error < change + 4e-6 * kAlphas[i]);
      // The order is at least 2; it is 4 where an element is shorter than about 15 heights.
      CHECK(change < (middle[i] - coarse[i]).norm() / 4.);
    }
  }
}

TEST_CASE("the difference from the exact rod falls with the square of the height", "[elastica]") {
  // Stress resultants of Green-Lagrange strain differ from Reissner's linear ones by (curvature
  // times height)^2. Shear and stretch are of the same size and are in both.
  for (const double poisson : {0., .3})
    for (const double alpha : {1., 4., 10.}) {
      const auto difference = [&](double height) -> Vector3d {
        const Slender beam(height, poisson);
        const Structure s = beam.clamped(64);
        const Eigen::VectorXd q = solved(s, end_force(s, alpha * Vector3d::UnitZ()));
        return end_position(s, q) - clamped_rod_end(beam.rod(), {0., 0., alpha}, {0., 0., 0.}).r;
      };
      const Vector3d thick = difference(.04), thin = difference(.02);
      CAPTURE(poisson, alpha, thick.transpose(), thin.transpose());
      // The next terms are a height over length smaller, .04, which is .06 of the order: the third
      // power at the clamp (which keeps the section from swelling), and the fourth.
      for (const int i : {0, 2}) CHECK_THAT(observed_order(thick[i], thin[i]), WithinAbs(2., .06));
      CHECK(thick.norm() < alpha * .04 * .04);
      CHECK(std::abs(thin[1]) < 1e-12);
    }
}
