#pragma once
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "offline/element/straight_beam.h"
#include "offline/math/gauss.h"
#include "offline/section/moments.h"
#include "support/random_scene.h"
#include "support/sections.h"

// Doubles enter long double arithmetic here on purpose.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

namespace railstep {

using Real = long double;
using Wide = std::complex<Real>;

/// A vector of complex numbers, multiplied without a conjugate.
struct Vector3c {
  Wide x[3] = {};
  Vector3c& add(const Vector3c& other, Real factor) {
    for (int i = 0; i < 3; ++i) x[i] += factor * other.x[i];
    return *this;
  }
};
inline Wide dot(const Vector3c& a, const Vector3c& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

using Nodes = std::array<Wide, 27>;

/// Energy of the straight element of section F as energy.h defines it, point by point: strains from
/// the vectors of the axis, Gauss points over each rectangle. It uses no inner products, and no
/// moments except those in the definition of the split shear.
class NaiveElement {
 public:
  /// @param section_points  Gauss points in each rectangle and direction, 1 to 3; 3 are exact
  NaiveElement(const BeamLaw& law, double length, int section_points)
      : law_(law), length_(length), points_(section_points) {}

  Wide energy(const Nodes& q) const {
    const int apart =
        law_.rule.coupling_points == 0 ? law_.rule.axial_points : law_.rule.coupling_points;
    Wide sum = 0.L;
    for (const GaussPoint& g : gauss(law_.rule.axial_points))
      sum += .5L * length_ * g.weight * uncoupled(axis(q, g.xi));
    for (const GaussPoint& g : gauss(apart))
      sum += .5L * length_ * g.weight * coupling(axis(q, g.xi));
    return sum;
  }

  /// dU/dq by the complex step: without a difference it is exact to round-off.
  std::array<Real, 27> force(const Nodes& q) const {
    std::array<Real, 27> found{};
    for (std::size_t i = 0; i < 27; ++i) {
      Nodes shifted = q;
      shifted[i] += Wide(0.L, kStep);
      found[i] = energy(shifted).imag() / kStep;
    }
    return found;
  }

 private:
  static constexpr Real kStep = 1e-30L;

  /// r', a', b', a, b of a point of the axis.
  struct Axis {
    Vector3c r, a_slope, b_slope, a, b;
  };
  struct Strain {
    Wide e11, e22, e33, g23, g13, g12;
  };

  Axis axis(const Nodes& q, Real xi) const {
    const Real value[3] = {-.5L * xi * (1.L - xi), 1.L - xi * xi, .5L * xi * (1.L + xi)};
    const Real slope[3] = {xi - .5L, -2.L * xi, xi + .5L};
    Axis at;
    for (std::size_t n = 0; n < 3; ++n) {
      Vector3c part[3];
      for (std::size_t k = 0; k < 9; ++k) part[k / 3].x[k % 3] = q[9 * n + k];
      const Real d = slope[n] * 2.L / length_;
      at.r.add(part[0], d);
      at.a_slope.add(part[1], d);
      at.b_slope.add(part[2], d);
      at.a.add(part[1], value[n]);
      at.b.add(part[2], value[n]);
    }
    return at;
  }

  /// Green-Lagrange strain of the vectors j = [r' + y a' + z b', a, b], which are the identity at
  /// rest.
  static Strain strain(const Axis& at, Real y, Real z) {
    Vector3c along = at.r;
    along.add(at.a_slope, y).add(at.b_slope, z);
    return {.5L * (dot(along, along) - 1.L),
            .5L * (dot(at.a, at.a) - 1.L),
            .5L * (dot(at.b, at.b) - 1.L),
            dot(at.a, at.b),
            dot(along, at.b),
            dot(along, at.a)};
  }

  /// Integral of a function of (y, z) over the section.
  template <typename Function>
  Wide over_section(const Function& of) const {
    const Real far = points_ == 3 ? std::sqrt(.6L) : 1.L / std::sqrt(3.L);
    const Real node[3][3] = {{0.L}, {-far, far}, {-far, 0.L, far}};
    const Real weight[3][3] = {{1.L}, {.5L, .5L}, {5.L / 18.L, 8.L / 18.L, 5.L / 18.L}};
    const Real *const n = node[points_ - 1], *const share = weight[points_ - 1];
    Real bottom = law_.moments.centroid_z() - properties(kSectionF).centroid_height;
    Wide sum = 0.L;
    for (std::size_t part = 0; part < 3; ++part) {
      const Real w = kSectionF.width[part], h = kSectionF.height[part];
      for (int i = 0; i < points_; ++i)
        for (int j = 0; j < points_; ++j)
          sum += w * h * share[i] * share[j] * of(.5L * w * n[i], bottom + .5L * h * (1.L + n[j]));
      bottom += h;
    }
    return sum;
  }

  Wide uncoupled(const Axis& at) const {
    const Real E = law_.material.young, G = law_.material.shear_modulus();
    const Real stress = law_.axial_force / law_.moments.area();
    const Shear shear = law_.rule.shear;
    const bool whole = shear == Shear::factors || shear == Shear::published;
    const Real ky = shear == Shear::factors ? law_.shear_factor_y : 1.L;
    const Real kz = shear == Shear::factors ? law_.shear_factor_z : 1.L;
    const Wide sum = over_section([&](Real y, Real z) {
      const Strain e = strain(at, y, z);
      Wide twice = E * (e.e11 * e.e11 + e.e22 * e.e22 + e.e33 * e.e33) + G * e.g23 * e.g23;
      if (whole) twice += G * (ky * e.g12 * e.g12 + kz * e.g13 * e.g13);
      return .5L * twice + stress * e.e11;
    });
    return whole ? sum : sum + split_shear(at, shear == Shear::offset);
  }

  Wide split_shear(const Axis& at, bool offset) const {
    const Real A = law_.moments.area(), z_c = law_.moments.centroid_z();
    const SectionMoments central = raised(law_.moments, law_.moments.centroid_z());
    const Real ky = law_.shear_factor_y, kz = law_.shear_factor_z, J = law_.torsion;
    const Real lever = law_.shear_centre_z - z_c;
    const Real Iz = central.of[2][0], Iy = central.of[0][2], Iys = Iy + A * lever * lever;
    const Strain c = strain(at, 0.L, z_c), s = strain(at, 0.L, law_.shear_centre_z);
    const Wide g13 = offset ? s.g13 : c.g13;
    const Wide y12 = dot(at.a_slope, at.a), z12 = dot(at.b_slope, at.a);
    const Wide y13 = dot(at.a_slope, at.b), z13 = dot(at.b_slope, at.b);
    const Wide twist = .5L * (y13 - z12), warp = .5L * (y13 + z12);
    return .5L * Real(law_.material.shear_modulus()) *
           (A * (ky * s.g12 * s.g12 + kz * g13 * g13) + Iz * y12 * y12 +
            (offset ? Iys : Iy) * z13 * z13 + (Iz + Iys) * warp * warp + J * twist * twist);
  }

  Wide coupling(const Axis& at) const {
    if (law_.rule.coupling == Coupling::none) return 0.L;
    const Real nu = law_.material.poisson;
    const Real c = law_.material.young * nu / ((1.L + nu) * (1.L - 2.L * nu));
    const auto at_point = [&](Real y, Real z) -> Wide {
      const Strain e = strain(at, y, z);
      const Wide squares = e.e11 * e.e11 + e.e22 * e.e22 + e.e33 * e.e33;
      return c * (nu * squares + e.e11 * e.e22 + e.e22 * e.e33 + e.e33 * e.e11);
    };
    if (law_.rule.coupling == Coupling::section) return over_section(at_point);
    const Real z = law_.rule.coupling == Coupling::centroid ? law_.moments.centroid_z() : 0.;
    return Real(law_.moments.area()) * at_point(0.L, z);
  }

  BeamLaw law_;
  Real length_;
  int points_;
};

/// Nodes of a straight element that is rotated by any angle, and bent and twisted by up to half a
/// radian from end to end. Its unknowns are then changed by up to `shake`. Strains reach some 10 %.
inline Vector27 random_state(Draw& draw, double length, double shake, bool planar) {
  const auto axis = [&]() -> Eigen::Vector3d {
    if (planar) return Eigen::Vector3d::UnitY();
    return Eigen::Vector3d(draw.between(-1., 1.), draw.between(-1., 1.), draw.between(-1., 1.))
        .normalized();
  };
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(draw.between(-3.1, 3.1), axis()));
  const Eigen::Vector3d about = axis();
  const double by = draw.between(-.5, .5);
  Vector27 q;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto section = [&](double part) -> Eigen::Matrix3d {
      return turn * Eigen::AngleAxisd(part * by, about).toRotationMatrix();
    };
    const Eigen::Matrix3d R = section(.5 * i);
    if (i > 0) place += .5 * length * section(.5 * i - .25).col(0);
    q.segment<3>(9 * i) = place;
    q.segment<3>(9 * i + 3) = R.col(1);
    q.segment<3>(9 * i + 6) = R.col(2);
  }
  for (int i = 0; i < 27; ++i) {
    const bool out = i % 3 == 1 ? i % 9 != 4 : i % 9 / 3 == 1;  // out of the plane x-z
    if (!(planar && out)) q[i] += (i % 9 < 3 ? .25 * length : 1.) * shake * draw.between(-1., 1.);
  }
  return q;
}

}  // namespace railstep
