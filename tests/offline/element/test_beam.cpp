#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/element/matrices.h"
#include "offline/section/moments.h"
#include "support/beam_energy.h"
#include "support/rest_shapes.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Eigen::Vector3d;

namespace {

BeamSection with_moments(BeamSection section, const SectionMoments& m) {
  section.moments = m;
  return section;
}

/// A straight element twisted about x by `turn` over its length.
Vector27 twisted_nodes(double length, double turn) {
  Vector27 q = straight_nodes(length);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d R(Eigen::AngleAxisd(.5 * i * turn, Vector3d::UnitX()));
    q.segment<3>(9 * i + 3) = R.col(1);
    q.segment<3>(9 * i + 6) = R.col(2);
  }
  return q;
}

struct Case {
  std::string name;
  Beam beam;
  Vector27 rest;
};

/// Elements with every rule and every kind of shape at rest.
std::vector<Case> cases() {
  const BeamSection f = with_moments(section_f(), moments(kSectionF));
  const BeamSection b = with_moments(peers_rectangle(), rectangle_moments(.2319, .0375));
  const Vector27 straight = straight_nodes(.6);
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const BeamSection& s, const ElementRule& rule,
                       const Vector27& rest, double axis_z = 0., double force = 0.) {
    all.push_back({name, beam_element(beam_law(s, {}, rule, axis_z, force), rest), rest});
  };
  add("rectangle", b, {}, straight);
  add("section F", f, {}, straight);
  add("section F, axis at the foot", f, {}, straight, -.085);
  add("section F, preload", f, {}, straight, 0., -1e6);
  add("as published", f, {.coupling = Coupling::axis, .shear = Shear::published}, straight);
  add("unsplit", f, {.coupling = Coupling::section, .shear = Shear::factors}, straight);
  add("offset", f, {.shear = Shear::offset}, straight);
  add("five points, coupling at one", f, {.axial_points = 5, .coupling_points = 1}, straight);
  add("arc upwards", f, {}, arc_nodes(.6, 3., true));
  add("arc sideways", f, {}, arc_nodes(.6, 3., false));
  add("twisted", f, {}, twisted_nodes(.6, .4));
  return all;
}

/// The shape at rest, rotated and moved as a rigid body; then every unknown is shaken.
Vector27 bent(const Vector27& rest, unsigned seed, double shake) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1., 1.);
  const Eigen::Matrix3d R(
      Eigen::AngleAxisd(2., Vector3d(.3, -.5, .8).normalized()).toRotationMatrix());
  Vector27 q;
  for (int i = 0; i < 9; ++i) q.segment<3>(3 * i) = R * rest.segment<3>(3 * i);
  for (int i = 0; i < 27; ++i) q[i] += shake * number(random);
  return q;
}

Vector27 force_of(const Beam& beam, const Vector27& q) {
  Vector27 force;
  beam_force(beam, q.data(), force.data());
  return force;
}

}  // namespace

TEST_CASE("the force is the gradient of the energy and the tangent is that of the force",
          "[beam]") {
  for (const Case& c : cases()) {
    INFO(c.name);
    const Vector27 q = bent(c.rest, 7, .02);
    const Vector27 force = force_of(c.beam, q);
    Vector27 same;
    Matrix27 K;
    beam_tangent(c.beam, q.data(), same.data(), K.data());
    CHECK((same - force).norm() == 0.);
    CHECK((K - K.transpose()).cwiseAbs().maxCoeff() == 0.);
    Vector27 slope;
    Matrix27 numeric;
    for (int i = 0; i < 27; ++i) {
      // U is of degree 4 in q, so the 5-point difference is exact to round-off; that of the force
      // is too.
      const double h = 1e-2;
      const auto shifted = [&](double by) {
        Vector27 to = q;
        to[i] += by;
        return to;
      };
      const auto energy = [&](double by) { return beam_energy(c.beam, shifted(by).data()); };
      slope[i] = (8. * (energy(h) - energy(-h)) - (energy(2. * h) - energy(-2. * h))) / (12. * h);
      numeric.col(i) = (8. * (force_of(c.beam, shifted(h)) - force_of(c.beam, shifted(-h))) -
                        (force_of(c.beam, shifted(2. * h)) - force_of(c.beam, shifted(-2. * h)))) /
                       (12. * h);
    }
    CHECK((slope - force).norm() < 1e-8 * force.norm());
    CHECK((numeric - K).norm() < 1e-7 * K.norm());
  }
}

TEST_CASE("a rigid motion by any angle strains nothing", "[beam]") {
  for (const Case& c : cases()) {
    INFO(c.name);
    Matrix27 K;
    Vector27 force;
    beam_tangent(c.beam, c.rest.data(), force.data(), K.data());
    const double scale = K.cwiseAbs().maxCoeff();
    const Vector27 at_rest = force;
    for (const double angle : {1e-3, .5, 1.7, 3.1}) {
      const Eigen::Matrix3d R(
          Eigen::AngleAxisd(angle, Vector3d(1., 2., -1.5).normalized()).toRotationMatrix());
      Vector27 q, turned;
      for (int i = 0; i < 9; ++i) {
        q.segment<3>(3 * i) = R * c.rest.segment<3>(3 * i);
        turned.segment<3>(3 * i) = R * at_rest.segment<3>(3 * i);
        if (i % 3 == 0) q.segment<3>(3 * i) += Vector3d(1., -2., .5);
      }
      // Round-off of positions of size 2 in elements of 0.6 m is 1e-14 of the stiffness.
      CHECK((force_of(c.beam, q) - turned).norm() < 1e-14 * scale);
    }
  }
}

TEST_CASE("a uniform Green-Lagrange strain gives its closed-form energy", "[beam]") {
  // The element stretches by 1 + e along x and the section contracts freely to E22 = E33 = -nu E11:
  // U = E A L E11^2 / 2. The section has all its moments, and the shape at rest is straight.
  const BeamSection f = with_moments(section_f(), moments(kSectionF));
  for (const double axis_z : {0., -.085, .1}) {
    const Beam beam = beam_element(beam_law(f, {}, {}, axis_z), straight_nodes(.6));
    const double e = .1, E11 = e + e * e / 2., across = std::sqrt(1. - 2. * .3 * E11);
    Vector27 q = straight_nodes(.6);
    for (int i = 0; i < 3; ++i) {
      q[9 * i] *= 1. + e;
      q[9 * i + 4] = q[9 * i + 8] = across;
    }
    CHECK_THAT(beam_energy(beam, q.data()), WithinRel(.5 * 210e9 * f.area * .6 * E11 * E11, 1e-8));
  }
}

TEST_CASE("the section's moments are exact", "[section]") {
  const SectionMoments m = moments(kSectionF);
  // Closed forms are int y^4 = sum h w^5/80, int y^2 z^2 = sum w^3/12 int z^2; others are by hand.
  double bottom = -.085, y4 = 0., z4 = 0., yyzz = 0., z3 = 0., yyz = 0.;
  for (std::size_t i = 0; i < 3; ++i) {
    const double w = kSectionF.width[i], top = bottom + kSectionF.height[i];
    const auto over = [&](int n) {
      return (std::pow(top, n + 1) - std::pow(bottom, n + 1)) / (n + 1);
    };
    y4 += std::pow(w, 5) / 80. * over(0);
    z4 += w * over(4);
    z3 += w * over(3);
    yyz += w * w * w / 12. * over(1);
    yyzz += w * w * w / 12. * over(2);
    bottom = top;
  }
  // The printed digits of the rectangles give the centroid's 85 mm to 1e-9 m.
  CHECK_THAT(m.of[4][0], WithinRel(y4, 1e-12));
  CHECK_THAT(m.of[0][4], WithinRel(z4, 1e-6));
  CHECK_THAT(m.of[0][3], WithinRel(z3, 1e-6));
  CHECK_THAT(m.of[2][1], WithinRel(yyz, 1e-6));
  CHECK_THAT(m.of[2][2], WithinRel(yyzz, 1e-6));
  CHECK_THAT(m.of[0][2], WithinRel(39.0e-6, 1e-7));
  CHECK_THAT(m.of[2][0], WithinRel(6.0e-6, 1e-7));
}

TEST_CASE("an outline's moments are those of its rectangles, and of a disc", "[section]") {
  std::vector<OutlineRow> rows;
  int number = 0;
  for (const auto& p : polygon(kSectionF)) rows.push_back({p, 0., ++number});
  const SectionMoments by_outline = moments(point_outline(rows)), by_parts = moments(kSectionF);
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t j = 0; i + j <= 4; ++j) {
      const double scale = by_parts.area() * std::pow(.1, static_cast<double>(i + j));
      CHECK_THAT(by_outline.of[i][j], WithinAbs(by_parts.of[i][j], 1e-13 * scale));
    }
  // A disc of radius R as a half outline of two arcs: int y^4 = pi R^6/8, int y^2 z^2 = pi R^6/24.
  const double R = .05, q = R * std::sqrt(.5);
  const std::vector<OutlineRow> half = {{{0., 0.}, 0., 1},
                                        {{q, R - q}, R, 2},
                                        {{R, R}, R, 3},
                                        {{q, R + q}, R, 4},
                                        {{0., 2. * R}, R, 5}};
  const SectionMoments disc = moments(mirrored_outline(half));
  const double r6 = std::pow(R, 6) * std::acos(-1.);
  CHECK_THAT(disc.area(), WithinRel(std::acos(-1.) * R * R, 1e-13));
  CHECK_THAT(disc.of[4][0], WithinRel(r6 / 8., 1e-12));
  CHECK_THAT(disc.of[0][4], WithinRel(r6 / 8., 1e-12));
  CHECK_THAT(disc.of[2][2], WithinRel(r6 / 24., 1e-12));
}

TEST_CASE("nodes that cannot form an element are refused", "[beam]") {
  const BeamLaw law = beam_law(section_f(), {});
  Vector27 flat = straight_nodes(.6);
  flat.segment<3>(6) = flat.segment<3>(3);
  flat.segment<3>(15) = flat.segment<3>(12);
  flat.segment<3>(24) = flat.segment<3>(21);
  CHECK_THROWS_WITH(beam_element(law, flat), Catch::Contains("E-ELEMENT-01"));
  CHECK_THROWS_WITH(beam_element(law, Vector27::Zero()), Catch::Contains("E-ELEMENT-03"));
  const BeamSection f = with_moments(section_f(), moments(kSectionF));
  CHECK_THROWS_WITH(beam_element(beam_law(f, {}), arc_nodes(.1, .2, true)),
                    Catch::Contains("E-ELEMENT-02"));
  CHECK_THROWS_WITH(moments(kSectionF, 4), Catch::Contains("E-SECTION-08"));
}
