// Cantilevers under end moments, whose strain is the same in every section, against closed forms
// of the element's own law: Green-Lagrange strain, E on each normal strain over the section and the
// Poisson coupling Dv at the centroid.
#include <catch2/catch.hpp>
#include <cmath>

#include "online/math/pi.h"
#include "support/beams.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Square section of side `height`, EI = 1, length 1; the sections can swell at the clamp.
struct Square {
  BeamSection section;
  Material material;
  Square(double height, double poisson)
      : section(rectangle_section(height, height, 5. / 6.)),
        material{.young = 1. / section.inertia_y, .poisson = poisson} {}
  Structure clamped(int elements) const {
    Structure s = straight_chain(beam_law(section, material), 1., elements);
    clamp_directions(s, 0);
    return s;
  }
};

/// Pure bending at the curvature kappa (per length at rest). With |r'| = l, |b| = beta and c =
/// kappa beta, E11 = ((l - c z)^2 - 1)/2. There is no axial force if the coupling balances (l^2 -
/// 1)/2 + 3 c^2 I/(2A). There is no force on |b| if E33's stress carries beta's share of the
/// bending energy U(l, c): A sigma33 beta^2 = -c dU/dc. So the centroid's strains are those of the
/// stresses -1.5 E c^2 I/A and sigma33, and M = beta dU/dc, where
///   dU/dc = E (3 l^2 c I + c^3 I4 - c I)/2, I4 = int z^4 dA.
struct PureBending {
  double moment, stretch, slope;  // N m, l, beta
};

PureBending pure_bending(const Square& of, double kappa) {
  const double A = of.section.area, I = of.section.inertia_y, E = of.material.young;
  const double I4 = of.section.moments->of[0][4], nu = of.material.poisson;
  double l2 = 1., beta2 = 1., by_c = 0.;
  for (int i = 0; i < 200; ++i) {  // the map contracts by (kappa height)^2
    const double c = kappa * std::sqrt(beta2);
    by_c = .5 * E * (3. * l2 * c * I + c * c * c * I4 - c * I);
    const double stress11 = -1.5 * c * c * I / A, stress33 = -by_c * c / (beta2 * A * E);
    l2 = 1. + 2. * (stress11 - nu * stress33);
    beta2 = 1. + 2. * (stress33 - nu * stress11);
  }
  return {by_c * std::sqrt(beta2), std::sqrt(l2), std::sqrt(beta2)};
}

/// Uniform twist tau about x of a bar that is free to shorten. E11 = e1 + tau^2 (y^2 (1 + 2 e2) +
/// z^2 (1 + 2 e3))/2 with the strains e of the axis, and t = tau sqrt((1 + 2 e2)(1 + 2 e3)). At a
/// given tau the energy is a quadratic form in e, stationary at free ends, and T = dU/dtau.
struct Twisting {
  double torque, stretch;
};

Twisting twisting(const Square& of, double tau) {
  const double A = of.section.area, I = of.section.inertia_y, E = of.material.young;
  const double I40 = of.section.moments->of[4][0], I22 = of.section.moments->of[2][2];
  const double nu = of.material.poisson, GJ = of.material.shear_modulus() * of.section.torsion;
  const double t2 = tau * tau, c = E * nu / ((1. + nu) * (1. - 2. * nu)) * A;
  Eigen::Matrix3d H, coupling;
  H << A, t2 * I, t2 * I, t2 * I, t2 * t2 * I40, t2 * t2 * I22, t2 * I, t2 * t2 * I22,
      t2 * t2 * I40;
  coupling << 2. * nu, 1., 1., 1., 2. * nu, 1., 1., 1., 2. * nu;
  H = E * H + c * coupling;
  H(1, 1) += E * A;
  H(2, 2) += E * A;
  H(1, 2) += 2. * GJ * t2;
  H(2, 1) += 2. * GJ * t2;
  const double each = .5 * E * t2 * t2 * (I40 + I22) + GJ * t2;
  const Eigen::Vector3d e = -H.ldlt().solve(Eigen::Vector3d(E * t2 * I, each, each));
  const double a2 = 1. + 2. * e[1], b2 = 1. + 2. * e[2];
  const double fibres =
      e[0] * I * (a2 + b2) + .5 * t2 * (I40 * (a2 * a2 + b2 * b2) + 2. * I22 * a2 * b2);
  return {E * tau * fibres + GJ * a2 * b2 * tau, std::sqrt(1. + 2. * e[0])};
}

Eigen::VectorXd under_moment(const Structure& s, const Vector3d& moment) {
  return solved(s, end_moment(s, moment));
}

}  // namespace

TEST_CASE("an end moment bends a cantilever into half and whole circles", "[bending]") {
  // Length over height is 10: strains reach 0.3, and the law's moment is 3 to 16 % below EI kappa.
  for (const double poisson : {0., .3})
    for (const double turn : {kPi, 2. * kPi}) {
      const Square beam(.1, poisson);
      const PureBending exact = pure_bending(beam, turn);
      const double radius = exact.stretch / turn;
      const Vector3d end(radius * std::sin(turn), 0., radius * (1. - std::cos(turn)));
      double error[2];
      for (int i = 0; i < 2; ++i) {
        const Structure s = beam.clamped(16 << i);
        const Eigen::VectorXd q = under_moment(s, {0., -exact.moment, 0.});
        error[i] = (end_position(s, q) - end).norm();
        const double slope = q.segment<3>(9 * last_node(s) + 6).norm();
        CHECK_THAT(slope, WithinAbs(exact.slope, error[i]));
      }
      CAPTURE(poisson, turn, exact.moment / turn, error[0], error[1]);
      // Nodal values of quadratic elements with two Gauss points are of order 4. It is reached to
      // 0.1 once the next term, (rotation per element)^2 = 0.15, is below 1.
      CHECK_THAT(observed_order(error[0], error[1]), WithinAbs(4., .1));
      CHECK(error[1] < 1e-4);
    }
}

TEST_CASE("2 pi EI/L rolls a slender cantilever up", "[bending]") {
  // Length over height is 1000. The law's moment is 1.3e-5 below EI kappa, which leaves the end
  // 1.3e-5 L from its root. The mesh's error is of order 4, and extrapolation takes it out.
  const Square beam(1e-3, .3);
  const double law = 1. - pure_bending(beam, 2. * kPi).moment / (2. * kPi);
  CHECK_THAT(law, WithinAbs(1.3e-5, 5e-7));
  Vector3d end[2];
  for (int i = 0; i < 2; ++i) {
    const Structure s = beam.clamped(8 << i);
    end[i] = end_position(s, under_moment(s, {0., -2. * kPi, 0.}));
  }
  CAPTURE(end[0].transpose(), end[1].transpose());
  CHECK_THAT(observed_order(end[0].norm(), end[1].norm()), WithinAbs(4., .2));
  CHECK(((16. * end[1] - end[0]) / 15.).norm() < law);
}

TEST_CASE("a bar twists by TL/GJ", "[torsion]") {
  for (const double poisson : {0., .3}) {
    const Square bar(.1, poisson);
    const double GJ = bar.material.shear_modulus() * bar.section.torsion, turn = 1e-4;
    const Structure s = bar.clamped(1);
    const Eigen::VectorXd q = under_moment(s, {GJ * turn, 0., 0.});
    const Vector3d b = q.segment<3>(9 * last_node(s) + 6);
    // Terms of (twist times height)^2 are 1e-10, and those of the rotation squared 1e-8.
    CHECK_THAT(std::atan2(-b[1], b[2]), WithinRel(turn, 1e-8));
  }
}

TEST_CASE("a bar twisted by 3 rad carries the torque of its law", "[torsion]") {
  // Fibres off the axis stretch and shorten (the E terms), slopes shrink: the torque is 1.8 % below
  // GJ tau at nu = 0 and 1.4 % above at 0.3, and the bar is 0.7 and 0.5 % shorter.
  for (const double poisson : {0., .3}) {
    const Square bar(.1, poisson);
    const double turn = 3.;
    const Twisting exact = twisting(bar, turn);
    double error[2], shortening[2];
    for (int i = 0; i < 2; ++i) {
      const Structure s = bar.clamped(8 << i);
      const Eigen::VectorXd q = under_moment(s, {exact.torque, 0., 0.});
      const Vector3d b = q.segment<3>(9 * last_node(s) + 6);
      error[i] = std::atan2(-b[1], b[2]) - turn;
      shortening[i] = end_position(s, q)[0] - exact.stretch;
    }
    CAPTURE(poisson, exact.torque, exact.stretch, error[0], error[1], shortening[1]);
    CHECK_THAT(observed_order(error[0], error[1]), WithinAbs(4., .1));
    CHECK_THAT(observed_order(shortening[0], shortening[1]), WithinAbs(4., .1));
    CHECK(std::abs(error[1]) < 1e-4);
  }
}
