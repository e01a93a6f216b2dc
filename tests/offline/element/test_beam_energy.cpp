#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "offline/element/matrices.h"
#include "offline/math/gauss.h"
#include "offline/section/moments.h"
#include "support/beam_energy.h"
#include "support/rest_shapes.h"
#include "support/sections.h"

using namespace railstep;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

const double kFoot = -properties(kSectionF).centroid_height;  // from the centroid, m

/// The element by its equations: F = j J0^-1 point by point, no inner products, no moments.
struct NaiveBeam {
  BeamLaw law;
  double foot;  // height of the section's lowest line over the reference line, m
  Vector27 rest;

  static Matrix3d lines(const Vector27& q, double xi, double y, double z) {
    Matrix3d j = Matrix3d::Zero();
    const auto n = shape(xi), d = shape_slope(xi);
    for (int i = 0; i < 3; ++i) {
      const auto r = q.segment<3>(9 * i), a = q.segment<3>(9 * i + 3), b = q.segment<3>(9 * i + 6);
      const std::size_t k = static_cast<std::size_t>(i);
      j.col(0) += d[k] * (r + y * a + z * b);
      j.col(1) += n[k] * a;
      j.col(2) += n[k] * b;
    }
    return j;
  }
  double volume(double xi, double y, double z) const { return lines(rest, xi, y, z).determinant(); }

  /// [E11 E22 E33 2E23 2E13 2E12] in axes along the section's normal, along a0 and across both.
  Vector6 strain(const Vector27& q, double xi, double y, double z) const {
    const Matrix3d J0 = lines(rest, xi, y, z), F = lines(q, xi, y, z) * J0.inverse();
    Matrix3d frame;
    const Vector3d normal = J0.col(1).cross(J0.col(2)).normalized();
    frame << normal, J0.col(1).normalized(), normal.cross(J0.col(1).normalized());
    const Matrix3d E =
        frame.transpose() * (.5 * (F.transpose() * F - Matrix3d::Identity())) * frame;
    return (Vector6() << E(0, 0), E(1, 1), E(2, 2), 2. * E(1, 2), 2. * E(0, 2), 2. * E(0, 1))
        .finished();
  }

  /// Energies per unit of xi, integrated over the section at one xi.
  double over_section(const Vector27& q, double xi) const {
    const Material& m = law.material;
    const double G = m.shear_modulus();
    double sum = 0., bottom = foot;
    for (std::size_t part = 0; part < 3; ++part) {
      const double w = kSectionF.width[part], h = kSectionF.height[part];
      for (const GaussPoint& u : gauss(5))
        for (const GaussPoint& v : gauss(5)) {
          const double y = .5 * w * u.xi, z = bottom + .5 * h * (1. + v.xi);
          const Vector6 e = strain(q, xi, y, z);
          const double dV = .25 * w * h * u.weight * v.weight * volume(xi, y, z);
          sum += dV * (.5 * m.young * e.head<3>().squaredNorm() + .5 * G * e[3] * e[3]);
          sum += dV * law.axial_force / law.moments.area() * e[0];
        }
      bottom += h;
    }
    return sum;
  }
  double on_axis(const Vector27& q, double xi) const {
    const Material& m = law.material;
    const double A = law.moments.area(), z_c = law.moments.centroid_z(), nu = m.poisson;
    const SectionMoments central = raised(law.moments, z_c);
    const double Iz = central.of[2][0], Iy = central.of[0][2],
                 Iys = Iy + A * std::pow(law.shear_centre_z - z_c, 2);
    // The field is linear over a straight element's section: the difference is exact there.
    const double h = 1e-3;
    const Vector6 e = strain(q, xi, 0., z_c), s = strain(q, xi, 0., law.shear_centre_z);
    const Vector6 by_y = (strain(q, xi, h, z_c) - strain(q, xi, -h, z_c)) / (2. * h);
    const Vector6 by_z = (strain(q, xi, 0., z_c + h) - strain(q, xi, 0., z_c - h)) / (2. * h);
    const double t = .5 * (by_y[4] - by_z[5]), warp = .5 * (by_y[4] + by_z[5]);
    const double shear = A * (law.shear_factor_y * s[5] * s[5] + law.shear_factor_z * e[4] * e[4]) +
                         Iz * by_y[5] * by_y[5] + Iy * by_z[4] * by_z[4] +
                         (Iz + Iys) * warp * warp + law.torsion * t * t;
    const double c = m.young * nu / ((1. + nu) * (1. - 2. * nu)), trace = e.head<3>().sum();
    const double coupling =
        .5 * c * A * (trace * trace + (2. * nu - 1.) * e.head<3>().squaredNorm());
    return volume(xi, 0., z_c) * (.5 * m.shear_modulus() * shear + coupling);
  }
  double energy(const Vector27& q) const {
    double sum = 0.;
    for (const GaussPoint& g : gauss(2))
      sum += g.weight * (over_section(q, g.xi) + on_axis(q, g.xi));
    return sum;
  }
};

}  // namespace

TEST_CASE("the element's energy is the pointwise integral of its strains", "[beam]") {
  BeamSection f = section_f();
  f.moments = moments(kSectionF);
  struct Case {
    const char* name;
    double axis_z, force;
    Vector27 rest;
    double shake, tolerance;
  };
  // Straight: both sum the same polynomial, with strains of 0.1 on unit slopes, so 1e-12. R = 30 m:
  // the stiffness is cut at degree 4, so a section that is not symmetric about the reference line
  // loses 13 (h/R)^3 at most, h being half its height: 4e-7. The nodes are shaken little because
  // terms of second degree in the displacement are cut earlier.
  const double cut = 13. * std::pow(.0929 / 30., 3);
  const Vector27 straight = straight_nodes(.6);
  for (const Case& c :
       {Case{"centroid", 0., 0., straight, .05, 1e-12},
        Case{"foot", kFoot, 0., straight, .05, 1e-12},
        Case{"preload", .05, -1e8, straight, .05, 1e-12},
        Case{"arc upwards", 0., 0., arc_nodes(.6, 30., true), 1e-3, cut},
        Case{"arc downwards, foot", kFoot, 0., arc_nodes(.6, -30., true), 1e-3, cut},
        Case{"arc sideways", 0., 0., arc_nodes(.6, 30., false), 1e-3, cut}}) {
    INFO(c.name);
    const BeamLaw law = beam_law(f, {}, {}, c.axis_z, c.force);
    const Beam beam = beam_element(law, c.rest);
    const NaiveBeam naive{law, law.moments.centroid_z() + kFoot, c.rest};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1., 1.);
    for (int k = 0; k < 10; ++k) {
      Vector27 q = c.rest;
      for (int i = 0; i < 27; ++i) q[i] += c.shake * number(random);
      CHECK_THAT(beam_energy(beam, q.data()),
                 Catch::Matchers::WithinRel(naive.energy(q), c.tolerance));
    }
  }
}
