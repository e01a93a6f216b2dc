#include "offline/element/energy.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <string>

#include "offline/element/polynomial.h"
#include "offline/element/shape.h"
#include "offline/math/gauss.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A strain as a linear form in the changes of the products, each coefficient over the section.
using StrainRow = std::array<Polynomial, kProducts>;
using ValueRow = std::array<double, kProducts>;

/// The axis at one point at rest.
struct RestPoint {
  Vector3d r, a_slope, b_slope, a, b;  // r', a', b', a, b

  const Vector3d& vector(int i) const {
    const Vector3d* const all[] = {&r, &a_slope, &b_slope, &a, &b};
    return *all[i];
  }
};

RestPoint rest_point(const BeamPoint& p, const Vector27& q) {
  const auto sum = [&](const double(&n)[3], int field) -> Vector3d {
    return (n[0] * q.segment<3>(3 * field) + n[1] * q.segment<3>(9 + 3 * field)) +
           n[2] * q.segment<3>(18 + 3 * field);
  };
  return {sum(p.slope, 0), sum(p.slope, 1), sum(p.slope, 2), sum(p.value, 1), sum(p.value, 2)};
}

/// Coefficients in j'j / 2 of each product: entry (m, n) of the symmetric 3 x 3.
struct ProductPlace {
  int m, n, y, z;  // entry and power of y and z
};
constexpr ProductPlace kPlace[kProducts] = {{0, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0, 0, 2, 0},
                                            {0, 0, 1, 1}, {0, 0, 0, 2}, {0, 1, 0, 0}, {0, 2, 0, 0},
                                            {0, 1, 1, 0}, {0, 2, 1, 0}, {0, 1, 0, 1}, {0, 2, 0, 1},
                                            {1, 1, 0, 0}, {1, 2, 0, 0}, {2, 2, 0, 0}};

/// The map from the reference cross-section to the shape at rest, over the section.
struct Metric {
  Polynomial inverse[3][3];  // J0^-1 times the frame of the section
  Polynomial determinant;
};

/// J0 = A (1 + c e1') with A = [r' a b] and c = y A^-1 a' + z A^-1 b', whose inverse is
/// (1 - c e1'/(1 + c_1)) A^-1.
Metric metric(const RestPoint& p) {
  Matrix3d A, frame;
  A << p.r, p.a, p.b;
  const double volume = A.determinant();
  const Vector3d normal = p.a.cross(p.b);
  if (!(volume > 1e-6 * p.r.norm() * p.a.norm() * p.b.norm()))
    refuse("E-ELEMENT-01",
           "the nodes of an element at rest do not form a section; expected r', r_y and r_z in "
           "three directions, right-handed");
  const Vector3d e1 = normal.normalized(), e2 = p.a.normalized();
  frame << e1, e2, e1.cross(e2);
  const Matrix3d inverse = A.inverse(), B = inverse * frame;
  const Vector3d by_y = inverse * p.a_slope, by_z = inverse * p.b_slope;

  Polynomial c1 = Polynomial::term(1, 0, by_y[0]);
  c1 += Polynomial::term(0, 1, by_z[0]);
  Polynomial reciprocal = Polynomial::term(0, 0, 1.), power = reciprocal;  // of 1 + c1
  for (int k = 1; k <= kMomentDegree; ++k) reciprocal += power = (-1. * power) * c1;

  Metric result;
  for (int m = 0; m < 3; ++m) {
    Polynomial c = Polynomial::term(1, 0, by_y[m]);
    c += Polynomial::term(0, 1, by_z[m]);
    const Polynomial factor = -1. * (c * reciprocal);
    for (int i = 0; i < 3; ++i) {
      result.inverse[m][i] = Polynomial::term(0, 0, B(m, i));
      result.inverse[m][i] += B(0, i) * factor;
    }
  }
  result.determinant = Polynomial::term(0, 0, volume);
  result.determinant += volume * c1;
  return result;
}

/// Voigt strains [E11 E22 E33 2E23 2E13 2E12] in the frame of the section.
std::array<StrainRow, 6> strain_rows(const Metric& metric) {
  constexpr int voigt[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  std::array<StrainRow, 6> rows;
  for (std::size_t v = 0; v < 6; ++v)
    for (std::size_t k = 0; k < kProducts; ++k) {
      const int i = voigt[v][0], j = voigt[v][1];
      const auto [m, n, y, z] = kPlace[k];
      Polynomial both = metric.inverse[m][i] * metric.inverse[n][j];
      if (m != n) both += metric.inverse[n][i] * metric.inverse[m][j];
      // Off the diagonal of j'j/2 the product counts a half in each of its two places.
      const double factor = (m != n ? .5 : 1.) * (i != j ? 2. : 1.);
      rows[v][k] = Polynomial::term(y, z, factor) * both;
    }
  return rows;
}

/// Adds energies, each a factor times the product of two linear forms, to C of one point.
struct Sum {
  const SectionMoments& moments;
  const Polynomial& determinant;
  double weight;
  double (&C)[kProducts][kProducts];

  /// factor int a b dA.
  void section(double factor, const StrainRow& a, const StrainRow& b) const {
    for (std::size_t i = 0; i < kProducts; ++i) {
      const Polynomial left = a[i] * determinant;
      for (std::size_t j = 0; j < kProducts; ++j)
        C[i][j] += weight * factor * (left * b[j]).over(moments);
    }
  }
  /// factor a^2, of forms that are numbers already.
  void square(double factor, const ValueRow& a) const {
    for (std::size_t i = 0; i < kProducts; ++i)
      for (std::size_t j = 0; j < kProducts; ++j) C[i][j] += weight * factor * (a[i] * a[j]);
  }
};

ValueRow at(const StrainRow& row, double z) {
  ValueRow values;
  for (std::size_t k = 0; k < kProducts; ++k) values[k] = row[k].value(0., z);
  return values;
}

ValueRow slope_at(const StrainRow& row, int axis, double z) {
  ValueRow values;
  for (std::size_t k = 0; k < kProducts; ++k) values[k] = row[k].slope(axis).value(0., z);
  return values;
}

ValueRow combine(double f, const ValueRow& a, double g, const ValueRow& b) {
  ValueRow values;
  for (std::size_t k = 0; k < kProducts; ++k) values[k] = f * a[k] + g * b[k];
  return values;
}

enum : std::size_t { kE11, kE22, kE33, kG23, kG13, kG12 };

void add_split_shear(const Sum& sum, const BeamLaw& law, const std::array<StrainRow, 6>& rows) {
  const double area = law.moments.area(), z_c = law.moments.centroid_z();
  const SectionMoments central = raised(law.moments, z_c);
  const double lever = law.shear_centre_z - z_c;
  const double Iz = central.of[2][0], Iy = central.of[0][2], Iys = Iy + area * lever * lever;
  const bool offset = law.rule.shear == Shear::offset;
  const double G = law.material.shear_modulus() * sum.determinant.value(0., z_c);
  const StrainRow& g12 = rows[kG12];
  const StrainRow& g13 = rows[kG13];
  const ValueRow across = slope_at(g13, 0, z_c), along = slope_at(g12, 1, z_c);
  sum.square(G * area * law.shear_factor_y, at(g12, law.shear_centre_z));
  sum.square(G * area * law.shear_factor_z, at(g13, offset ? law.shear_centre_z : z_c));
  sum.square(G * Iz, slope_at(g12, 0, z_c));
  sum.square(G * (offset ? Iys : Iy), slope_at(g13, 1, z_c));
  sum.square(G * (Iz + Iys), combine(.5, across, .5, along));
  sum.square(G * law.torsion, combine(.5, across, -.5, along));
}

void add_uncoupled(const Sum& sum, const BeamLaw& law, const std::array<StrainRow, 6>& rows) {
  const double E = law.material.young, G = law.material.shear_modulus();
  for (const std::size_t k : {kE11, kE22, kE33}) sum.section(E, rows[k], rows[k]);
  sum.section(G, rows[kG23], rows[kG23]);
  if (law.rule.shear == Shear::twist || law.rule.shear == Shear::offset) {
    add_split_shear(sum, law, rows);
    return;
  }
  const bool factors = law.rule.shear == Shear::factors;
  sum.section(G * (factors ? law.shear_factor_y : 1.), rows[kG12], rows[kG12]);
  sum.section(G * (factors ? law.shear_factor_z : 1.), rows[kG13], rows[kG13]);
}

/// Dv = c [2 nu 1 1; 1 2 nu 1; 1 1 2 nu].
void add_coupling(const Sum& sum, const BeamLaw& law, const std::array<StrainRow, 6>& rows) {
  if (law.rule.coupling == Coupling::none) return;
  const double nu = law.material.poisson;
  const double c = law.material.young * nu / ((1. + nu) * (1. - 2. * nu));
  if (law.rule.coupling == Coupling::section) {
    for (std::size_t k = kE11; k <= kE33; ++k)
      for (std::size_t l = kE11; l <= kE33; ++l)
        sum.section(k == l ? 2. * nu * c : c, rows[k], rows[l]);
    return;
  }
  const double z = law.rule.coupling == Coupling::centroid ? law.moments.centroid_z() : 0.;
  const double factor = c * law.moments.area() * sum.determinant.value(0., z);
  ValueRow volume{};
  for (std::size_t k = kE11; k <= kE33; ++k) {
    sum.square(factor * (2. * nu - 1.), at(rows[k], z));
    volume = combine(1., volume, 1., at(rows[k], z));
  }
  sum.square(factor, volume);
}

/// The stress N / A on E11.
void add_preload(BeamPoint& point, const BeamLaw& law, const StrainRow& e11,
                 const Polynomial& determinant, double weight) {
  const double stress = law.axial_force / law.moments.area();
  for (std::size_t k = 0; k < kProducts; ++k)
    point.preload[k] += weight * stress * (e11[k] * determinant).over(law.moments);
}

/// Beyond an extent of half the radius of curvature the truncated polynomials are not accurate.
void check_curvature(const RestPoint& p, const SectionMoments& m) {
  Matrix3d A;
  A << p.r, p.a, p.b;
  const Matrix3d inverse = A.inverse();
  // 1.5 times the fourth root of a rectangle's mean y^4 is its half width.
  const auto extent = [&](double fourth) { return 1.5 * std::pow(fourth / m.area(), .25); };
  const double bent = std::abs((inverse * p.a_slope)[0]) * extent(m.of[4][0]) +
                      std::abs((inverse * p.b_slope)[0]) * extent(m.of[0][4]);
  if (!(bent <= .5))
    refuse("E-ELEMENT-02", "an element at rest is curved too sharply: half its section is " +
                               std::to_string(bent) + " of the radius; expected at most 0.5");
}

enum class Part { both, uncoupled, coupling };

/// Contribution of a point to a part of the energy; `weight` holds that of its Gauss point.
void add_energy(BeamPoint& point, const BeamLaw& law, const RestPoint& p, double weight,
                Part part) {
  for (int k = 0; k < kProducts; ++k) {
    const int i = kProductOf[k][0], j = kProductOf[k][1];
    point.rest[k] = (i == j ? .5 : 1.) * p.vector(i).dot(p.vector(j));
  }
  const Metric over = metric(p);
  check_curvature(p, law.moments);
  const std::array<StrainRow, 6> rows = strain_rows(over);
  const Sum sum{law.moments, over.determinant, weight, point.stiffness};
  if (part != Part::coupling) add_uncoupled(sum, law, rows);
  if (part != Part::coupling) add_preload(point, law, rows[kE11], over.determinant, weight);
  if (part != Part::uncoupled) add_coupling(sum, law, rows);
  for (int i = 0; i < kProducts; ++i)  // removes the round-off in a symmetric form
    for (int j = 0; j < i; ++j) point.stiffness[i][j] = point.stiffness[j][i];
}

BeamPoint beam_point(const BeamLaw& law, const Vector27& rest, double length, const GaussPoint& g,
                     Part part) {
  BeamPoint point{};
  const auto value = shape(g.xi), slope = shape_slope(g.xi);
  for (std::size_t i = 0; i < 3; ++i) {
    point.value[i] = value[i];
    point.slope[i] = slope[i] / (length / 2.);
  }
  add_energy(point, law, rest_point(point, rest), g.weight * length / 2., part);
  return point;
}

}  // namespace

Vector27 straight_nodes(double length) {
  Vector27 q = Vector27::Zero();
  for (int i = 0; i < 3; ++i) {
    q[9 * i] = .5 * i * length;
    q[9 * i + 4] = q[9 * i + 8] = 1.;
  }
  return q;
}

BeamPoint straight_point(const BeamLaw& law, double weight) {
  BeamPoint point{};
  const Vector3d none = Vector3d::Zero();
  add_energy(point, law, {Vector3d::UnitX(), none, none, Vector3d::UnitY(), Vector3d::UnitZ()},
             weight, Part::both);
  return point;
}

Beam beam_element(const BeamLaw& law, const Vector27& rest) {
  const double length = (rest.segment<3>(18) - rest.segment<3>(0)).norm();
  if (!(length > 0.))
    refuse("E-ELEMENT-03",
           "the end nodes of an element lie in one place; expected a length above 0");
  const int coupling_points = law.rule.coupling_points;
  const bool together = coupling_points == 0 || coupling_points == law.rule.axial_points;
  Beam beam{};
  const auto add = [&](int points, Part part) {
    for (const GaussPoint& g : gauss(points))
      beam.point[beam.points++] = beam_point(law, rest, length, g, part);
  };
  add(law.rule.axial_points, together ? Part::both : Part::uncoupled);
  if (!together) add(coupling_points, Part::coupling);
  return beam;
}

}  // namespace railstep
