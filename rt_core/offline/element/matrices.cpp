#include "offline/element/matrices.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace railstep {

namespace {

struct GaussPoint {
  double xi, weight;
};

/// Gauss-Legendre rules on [-1, 1] (Abramowitz and Stegun, table 25.4).
std::vector<GaussPoint> gauss(int points) {
  switch (points) {
    case 1:
      return {{0., 2.}};
    case 2: {
      const double x = 1. / std::sqrt(3.);
      return {{-x, 1.}, {x, 1.}};
    }
    case 3: {
      const double x = std::sqrt(.6);
      return {{-x, 5. / 9.}, {0., 8. / 9.}, {x, 5. / 9.}};
    }
    case 4: {
      const double root = 2. / 7. * std::sqrt(1.2);
      const double x1 = std::sqrt(3. / 7. - root), x2 = std::sqrt(3. / 7. + root);
      const double w1 = (18. + std::sqrt(30.)) / 36., w2 = (18. - std::sqrt(30.)) / 36.;
      return {{-x2, w2}, {-x1, w1}, {x1, w1}, {x2, w2}};
    }
    case 5: {
      const double root = 2. * std::sqrt(10. / 7.);
      const double x1 = std::sqrt(5. - root) / 3., x2 = std::sqrt(5. + root) / 3.;
      const double w1 = (322. + 13. * std::sqrt(70.)) / 900.;
      const double w2 = (322. - 13. * std::sqrt(70.)) / 900.;
      return {{-x2, w2}, {-x1, w1}, {0., 128. / 225.}, {x1, w1}, {x2, w2}};
    }
    default:
      throw std::invalid_argument("axial points: " + std::to_string(points) + "; accepted 1 to 5");
  }
}

// Places of the nine unknowns of a node.
enum : int { rx, ry, rz, ax, ay, az, bx, by, bz };

/// Values and x-derivatives of the nodal fields at one point of the axis, as rows over the 27.
struct Fields {
  std::array<double, 3> value, slope;  // of N1..N3; slope by x, 1/m
  Vector27 of(int unknown) const { return row(unknown, value); }
  Vector27 x_of(int unknown) const { return row(unknown, slope); }

 private:
  static Vector27 row(int unknown, const std::array<double, 3>& n) {
    Vector27 result = Vector27::Zero();
    for (int i = 0; i < 3; ++i) result[9 * i + unknown] = n[static_cast<std::size_t>(i)];
    return result;
  }
};

/// K += w * row row', plain loops: Eigen's blocked products change bits with the processor.
void add_square(Matrix27& K, const Vector27& row, double w) {
  for (int j = 0; j < 27; ++j)
    if (row[j] != 0.)
      for (int i = 0; i < 27; ++i) K(i, j) += w * (row[i] * row[j]);  // exactly symmetric
}

void add_normal_strains(Matrix27& K, const Fields& f, const BeamSection& s, const Material& m,
                        double w) {
  const double E = m.young, G = m.shear_modulus(), nu = m.poisson;
  const Vector27 e = f.x_of(rx), lateral = f.of(ay), vertical = f.of(bz);
  add_square(K, e, w * E * s.area);
  add_square(K, f.x_of(ax), w * E * s.inertia_z);
  add_square(K, f.x_of(bx), w * E * s.inertia_y);
  add_square(K, lateral, w * E * s.area);
  add_square(K, vertical, w * E * s.area);
  add_square(K, f.of(az) + f.of(by), w * G * s.area);
  // Dv = c [2 nu 1 1; 1 2 nu 1; 1 1 2 nu] = c [(2 nu - 1) I + ones].
  const double c = w * s.area * E * nu / ((1. + nu) * (1. - 2. * nu));
  for (const Vector27& strain : {e, lateral, vertical}) add_square(K, strain, c * (2. * nu - 1.));
  add_square(K, e + lateral + vertical, c);
}

void add_shear_strains(Matrix27& K, const Fields& f, const BeamSection& s, double G, double w) {
  const double z_s = s.shear_centre_z, Iys = s.inertia_y + s.area * z_s * z_s;
  const Vector27 g12 = f.x_of(ry) + f.of(ax), g13 = f.x_of(rz) + f.of(bx);
  const Vector27 twist = .5 * (f.x_of(az) - f.x_of(by)), warp = .5 * (f.x_of(az) + f.x_of(by));
  add_square(K, g12 + z_s * f.x_of(by), w * G * s.area * s.shear_factor_y);
  add_square(K, g13 + z_s * f.x_of(bz), w * G * s.area * s.shear_factor_z);
  add_square(K, f.x_of(ay), w * G * s.inertia_z);
  add_square(K, f.x_of(bz), w * G * Iys);
  add_square(K, warp, w * G * (s.inertia_z + Iys));
  add_square(K, twist, w * G * s.torsion);
}

void add_published_shear(Matrix27& K, const Fields& f, const BeamSection& s, double G, double w) {
  add_square(K, f.x_of(ry) + f.of(ax), w * G * s.area);
  add_square(K, f.x_of(rz) + f.of(bx), w * G * s.area);
  for (const int unknown : {ay, az}) add_square(K, f.x_of(unknown), w * G * s.inertia_z);
  for (const int unknown : {by, bz}) add_square(K, f.x_of(unknown), w * G * s.inertia_y);
}

}  // namespace

std::array<double, 3> shape(double xi) {
  return {-.5 * xi * (1. - xi), 1. - xi * xi, .5 * xi * (1. + xi)};
}

std::array<double, 3> shape_slope(double xi) { return {xi - .5, -2. * xi, xi + .5}; }

ElementMatrices element_matrices(const BeamSection& section, const Material& material,
                                 double length, ElasticLaw law, int axial_points) {
  ElementMatrices result{Matrix27::Zero(), Matrix27::Zero(), Vector27::Zero()};
  const double half = length / 2.;  // det J
  for (const GaussPoint& p : gauss(axial_points)) {
    Fields f{shape(p.xi), shape_slope(p.xi)};
    for (double& slope : f.slope) slope /= half;
    const double w = p.weight * half, G = material.shear_modulus();
    add_normal_strains(result.stiffness, f, section, material, w);
    if (law == ElasticLaw::paper)
      add_published_shear(result.stiffness, f, section, G, w);
    else
      add_shear_strains(result.stiffness, f, section, G, w);
  }
  for (const GaussPoint& p : gauss(3)) {  // degree 4: exact
    const Fields f{shape(p.xi), shape_slope(p.xi)};
    const double w = p.weight * half * material.density;
    for (int k = 0; k < 3; ++k) {
      add_square(result.mass, f.of(rx + k), w * section.area);
      add_square(result.mass, f.of(ax + k), w * section.inertia_z);
      add_square(result.mass, f.of(bx + k), w * section.inertia_y);
    }
    result.line_load += p.weight * half * f.of(rz);
  }
  return result;
}

Vector27 point_row(double xi, double y, double z, int direction) {
  const std::array<double, 3> n = shape(xi);
  Vector27 row = Vector27::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = n[static_cast<std::size_t>(i)];
    row[9 * i + direction] = value;
    row[9 * i + 3 + direction] = y * value;
    row[9 * i + 6 + direction] = z * value;
  }
  return row;
}

}  // namespace railstep
