#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/element/matrices.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Displacements of the three nodes, at x = 0, L/2 and L, under a small rigid rotation about an
/// axis through x = 0; the slopes turn with it.
Vector27 rigid_rotation(int axis, double length) {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  w[axis] = 1.;
  Vector27 u;
  for (int i = 0; i < 3; ++i) {
    u.segment<3>(9 * i) = w.cross(Eigen::Vector3d(.5 * i * length, 0., 0.));
    u.segment<3>(9 * i + 3) = w.cross(Eigen::Vector3d::UnitY());
    u.segment<3>(9 * i + 6) = w.cross(Eigen::Vector3d::UnitZ());
  }
  return u;
}

Vector27 translation(int axis) {
  Vector27 u = Vector27::Zero();
  for (int i = 0; i < 3; ++i) u[9 * i + axis] = 1.;
  return u;
}

}  // namespace

TEST_CASE("shape functions are 1 at their node, sum to 1 and have the stated slopes") {
  const double nodes[3] = {-1., 0., 1.};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) CHECK(shape(nodes[j])[i] == (i == j ? 1. : 0.));
  for (const double xi : {-.9, -.3, .2, .77}) {
    const auto n = shape(xi), above = shape(xi + 1e-6), below = shape(xi - 1e-6);
    CHECK_THAT(n[0] + n[1] + n[2], WithinAbs(1., 1e-15));
    for (std::size_t i = 0; i < 3; ++i)  // quadratic: the central difference is exact to rounding
      CHECK_THAT((above[i] - below[i]) / 2e-6, WithinAbs(shape_slope(xi)[i], 1e-9));
  }
}

TEST_CASE("rigid motion strains nothing and carries the whole mass and inertia") {
  const double L = .6, pi2 = L * L / 3.;
  const Material steel;
  const BeamSection s = section_f();
  for (const Shear shear : {Shear::twist, Shear::factors, Shear::published})
    for (const int points : {2, 3, 5}) {
      const ElementRule rule{.axial_points = points, .shear = shear};
      const ElementMatrices e = element_matrices(s, beam_law(s, steel, rule), L);
      const double scale = e.stiffness.cwiseAbs().maxCoeff();
      for (int axis = 0; axis < 3; ++axis) {
        // 27 products with the rounding error eps each: 1e-14 of the largest entry is ample
        CHECK((e.stiffness * translation(axis)).norm() < 1e-14 * scale);
        CHECK((e.stiffness * rigid_rotation(axis, L)).norm() < 1e-14 * scale);
        CHECK_THAT(translation(axis).dot(e.mass * translation(axis)),
                   WithinRel(steel.density * s.area * L, 1e-13));
      }
      const double rho = steel.density;
      const auto inertia = [&](int axis) {
        const Vector27 u = rigid_rotation(axis, L);
        return u.dot(e.mass * u);
      };
      CHECK_THAT(inertia(0), WithinRel(rho * L * (s.inertia_y + s.inertia_z), 1e-13));
      CHECK_THAT(inertia(1), WithinRel(rho * L * (s.area * pi2 + s.inertia_y), 1e-13));
      CHECK_THAT(inertia(2), WithinRel(rho * L * (s.area * pi2 + s.inertia_z), 1e-13));
    }
}

TEST_CASE("the stiffness is symmetric with six zero modes, and with more for one axial point") {
  const auto zero_modes = [](int points, Shear shear) {
    const ElementRule rule{.axial_points = points, .shear = shear};
    const ElementMatrices e = element_matrices(section_f(), beam_law(section_f(), {}, rule), .6);
    CHECK((e.stiffness - e.stiffness.transpose()).norm() == 0.);
    // The rank is taken against the mass matrix, which scales positions and slopes alike.
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::MatrixXd(e.stiffness), Eigen::MatrixXd(e.mass));
    const Eigen::VectorXd& values = solver.eigenvalues();
    CHECK(values[0] > -1e-10 * values[26]);
    return (values.array() < 1e-10 * values[26]).count();
  };
  for (const Shear shear : {Shear::twist, Shear::published})
    for (const int points : {2, 3, 4, 5}) CHECK(zero_modes(points, shear) == 6);
  CHECK(zero_modes(1, Shear::twist) > 6);
}

TEST_CASE("Poisson coupling contracts the stretched section by nu times the strain") {
  const BeamSection s = section_f();
  const Material steel;
  const ElementMatrices e = element_matrices(s, beam_law(s, steel), 1.);
  Vector27 u = Vector27::Zero();
  for (int i = 0; i < 3; ++i) {
    u[9 * i] = .5 * i * 1e-3;  // e = 1e-3
    u[9 * i + 4] = u[9 * i + 8] = -steel.poisson * 1e-3;
  }
  const Vector27 force = e.stiffness * u;
  for (int i = 0; i < 3; ++i) {  // no force is needed to hold the section's width and height
    CHECK_THAT(force[9 * i + 4], WithinAbs(0., 1e-9 * steel.young * s.area * 1e-3));
    CHECK_THAT(force[9 * i + 8], WithinAbs(0., 1e-9 * steel.young * s.area * 1e-3));
  }
  CHECK_THAT(force[18], WithinRel(steel.young * s.area * 1e-3, 1e-12));  // N = E A e
}

TEST_CASE("the element refuses a number of axial points it does not have") {
  CHECK_THROWS_WITH(
      element_matrices(section_f(), beam_law(section_f(), {}, {.axial_points = 6}), 1.),
      Catch::Contains("E-MATH-01"));
}
