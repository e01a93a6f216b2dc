#include "offline/section/saint_venant.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "offline/math/refuse.h"
#include "offline/section/half_polygon.h"
#include "offline/section/quadratic_elements.h"
#include "offline/section/section_mesh.h"

namespace railstep {
namespace {

using Eigen::VectorXd;

constexpr double kCoarsest = 0.1;     // first triangle size over sqrt(A)
constexpr int kRefinements = 4;       // halvings of it at most
constexpr double kClosestGap = 1e-4;  // relative gap of the bounds of J that ends them

/// The half section about the whole's centroid, in units of sqrt(A) so that A = 1: thresholds and
/// pivots then do not depend on the unit of length.
struct ScaledHalf {
  HalfPolygon outline;     // 1
  double unit;             // sqrt(A), m
  double centroid_height;  // above the foot, m
};

ScaledHalf scale(const std::vector<std::array<double, 2>>& polygon) {
  HalfPolygon half = right_half(polygon);
  double area = 0.0, moment = 0.0, foot = half[0][1];
  for (std::size_t i = 0; i < half.size(); ++i) {
    const auto& a = half[i];
    const auto& b = half[(i + 1) % half.size()];
    const double part = a[0] * b[1] - b[0] * a[1];  // the two halves together
    area += part;
    moment += part * (a[1] + b[1]) / 3.0;
    foot = std::min(foot, a[1]);
  }
  const double unit = std::sqrt(area);
  const double centroid = moment / area;
  for (auto& p : half) p = {p[0] / unit, (p[1] - centroid) / unit};
  return {half, unit, centroid - foot};
}

/// The discrete problem, in units of sqrt(A); integrals over what is meshed, the half section or
/// the whole of a lopsided one.
struct Discrete {
  QuadraticElements mesh;
  Eigen::SparseMatrix<double> K;
  double area = 0.0, inertia_y = 0.0, inertia_z = 0.0, fourth = 0.0;  // 1, z^2, y^2, y^2 z^2
  double product = 0.0;                                               // y z
  VectorXd warping_load, stress_load;                                 // int z N,y - y N,z; int 2 N
  VectorXd first_y, first_z;                                          // int y N; int z N
};

template <typename Integrand>  // adds QuadraturePoint's share to six numbers
VectorXd assemble(const QuadraticElements& mesh, Integrand integrand) {
  VectorXd sum = VectorXd::Zero(mesh.nodes.cols());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const QuadraturePoint& q : quadrature(mesh, e)) {
      const Eigen::Matrix<double, 6, 1> share = q.area * integrand(q);
      for (int i = 0; i < 6; ++i) sum[mesh.elements[e][static_cast<std::size_t>(i)]] += share[i];
    }
  return sum;
}

Discrete discretise(const SectionMesh& triangles) {
  using Q = QuadraturePoint;
  using Six = Eigen::Matrix<double, 6, 1>;
  Discrete d;
  d.mesh = make_quadratic(triangles);
  d.K = laplacian(d.mesh);
  for (std::size_t e = 0; e < d.mesh.elements.size(); ++e)
    for (const Q& q : quadrature(d.mesh, e)) {
      d.area += q.area;
      d.inertia_y += q.area * q.z * q.z;
      d.inertia_z += q.area * q.y * q.y;
      d.fourth += q.area * q.y * q.y * q.z * q.z;
      d.product += q.area * q.y * q.z;
    }
  d.warping_load = assemble(
      d.mesh, [](const Q& q) -> Six { return q.z * q.slope.col(0) - q.y * q.slope.col(1); });
  d.stress_load = assemble(d.mesh, [](const Q& q) -> Six { return 2.0 * q.shape; });
  d.first_y = assemble(d.mesh, [](const Q& q) -> Six { return q.y * q.shape; });
  d.first_z = assemble(d.mesh, [](const Q& q) -> Six { return q.z * q.shape; });
  return d;
}

/// int of F . grad N + div F N: the boundary values of Cowper's chi brought inside by Gauss'
/// theorem, F = -(nu/2 p^2 + (1 - nu/2) q^2, (2 + nu) p q), div F = -2 (1 + nu) p.
/// @param p  the force's direction, 0 for y and 1 for z
VectorXd flexure_load(const QuadraticElements& mesh, int p, double nu) {
  return assemble(mesh, [p, nu](const QuadraturePoint& at) -> Eigen::Matrix<double, 6, 1> {
    const double along = p == 0 ? at.y : at.z;
    const double across = p == 0 ? at.z : at.y;
    const double F_p = -(0.5 * nu * along * along + (1.0 - 0.5 * nu) * across * across);
    const double F_q = -(2.0 + nu) * along * across;
    return F_p * at.slope.col(p) + F_q * at.slope.col(1 - p) - 2.0 * (1.0 + nu) * along * at.shape;
  });
}

/// A function that is odd in y vanishes on the axis; nothing else is fixed.
Eigen::MatrixXd solve_odd(const Discrete& d, const Eigen::MatrixXd& loads) {
  return solve_fixed(d.K, d.mesh.on_axis, loads);
}

/// A function that is even in y is free on the axis; one node is fixed to remove the constant that
/// remains.
VectorXd solve_even(const Discrete& d, const VectorXd& load) {
  std::vector<bool> fixed(d.mesh.on_axis.size(), false);
  fixed[0] = true;
  return solve_fixed(d.K, fixed, load);
}

/// Lower and upper bound of the torsion constant: Prandtl's stress function can only be too soft,
/// the warping function only too stiff.
struct TorsionBounds {
  double lower, upper;  // J of the scaled section
};

/// Bounds of the whole section from its half: the mirror image adds the same again.
TorsionBounds bounds(const Discrete& d, const VectorXd& warping) {
  const VectorXd stress = solve_fixed(d.K, d.mesh.on_outline, d.stress_load);
  return {2.0 * d.stress_load.dot(stress),
          2.0 * (d.inertia_y + d.inertia_z - d.warping_load.dot(warping))};
}

bool are_close(const TorsionBounds& J) { return J.upper - J.lower <= kClosestGap * J.lower; }

/// Cowper's factor from the whole section's integrals. Its denominator may vanish when the force is
/// not along the axis of symmetry, and the result is then not a stiffness.
double shear_factor(double nu, double area, double inertia_p, double inertia_q, double flexure) {
  const double k = 2.0 * (1.0 + nu) * inertia_p /
                   (0.5 * nu * (inertia_q - inertia_p) - area / inertia_p * flexure);
  if (!(k > 0.0 && k <= 1.0)) throw NoShearFactor();
  return k;
}

/// @return nothing when the bounds of J are still too far apart
std::optional<SaintVenant> solve(const ScaledHalf& half, double size, double nu) {
  const Discrete d = discretise(mesh_half(half.outline, size));
  Eigen::MatrixXd odd_loads(d.mesh.nodes.cols(), 2);
  odd_loads << d.warping_load, flexure_load(d.mesh, 0, nu);
  const Eigen::MatrixXd odd = solve_odd(d, odd_loads);  // warping, lateral chi
  const TorsionBounds J = bounds(d, odd.col(0));
  if (!are_close(J)) return std::nullopt;
  const VectorXd chi_z = solve_even(d, flexure_load(d.mesh, 1, nu));
  const double unit2 = half.unit * half.unit;
  const double flexure_y = 2.0 * (d.first_y.dot(odd.col(1)) + d.fourth);
  const double flexure_z = 2.0 * (d.first_z.dot(chi_z) + d.fourth);
  const double I_y = 2.0 * d.inertia_y, I_z = 2.0 * d.inertia_z, area = 2.0 * d.area;
  return SaintVenant{.torsion = 0.5 * (J.lower + J.upper) * unit2 * unit2,
                     .shear_factor_y = shear_factor(nu, area, I_z, I_y, flexure_y),
                     .shear_factor_z = shear_factor(nu, area, I_y, I_z, flexure_z),
                     .shear_centre_height = half.centroid_height +
                                            half.unit * d.first_y.dot(odd.col(0)) / d.inertia_z};
}

/// A whole section about its centroid, in units of sqrt(A).
struct ScaledWhole {
  std::vector<std::array<double, 2>> outline;  // 1
  double unit;                                 // sqrt(A), m
  double centroid_y, centroid_height;          // of the coordinates given; above the foot, m
};

ScaledWhole scale_whole(std::vector<std::array<double, 2>> outline) {
  check_polygon(outline);
  const std::array<double, 2> origin = outline[0];
  double twice = 0.0, moment_y = 0.0, moment_z = 0.0, foot = origin[1];
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& next = outline[(i + 1) % outline.size()];
    const double ay = outline[i][0] - origin[0], az = outline[i][1] - origin[1];
    const double by = next[0] - origin[0], bz = next[1] - origin[1];
    const double part = ay * bz - by * az;
    twice += part;
    moment_y += part * (ay + by) / 3.0;
    moment_z += part * (az + bz) / 3.0;
    foot = std::min(foot, outline[i][1]);
  }
  const double unit = std::sqrt(0.5 * twice);
  const double y = origin[0] + moment_y / twice, z = origin[1] + moment_z / twice;
  for (auto& p : outline) p = {(p[0] - y) / unit, (p[1] - z) / unit};
  return {outline, unit, y, z - foot};
}

/// @return nothing when the bounds of J are still too far apart
std::optional<Twist> solve_whole(const ScaledWhole& whole, double size) {
  const Discrete d = discretise(mesh_whole(whole.outline, size));
  const VectorXd warping = solve_even(d, d.warping_load);
  // A side that lies on y = 0 is a free one here.
  std::vector<bool> border = d.mesh.on_outline;
  for (std::size_t i = 0; i < border.size(); ++i) border[i] = border[i] || d.mesh.on_axis[i];
  const VectorXd stress = solve_fixed(d.K, border, d.stress_load);
  const TorsionBounds J{d.stress_load.dot(stress),
                        d.inertia_y + d.inertia_z - d.warping_load.dot(warping)};
  if (!are_close(J)) return std::nullopt;
  Eigen::Matrix2d rows;
  rows << d.inertia_z, -d.product, d.product, -d.inertia_y;
  const Eigen::Vector2d zy =
      rows.inverse() * Eigen::Vector2d(d.first_y.dot(warping), d.first_z.dot(warping));
  const double unit2 = whole.unit * whole.unit;
  return Twist{0.5 * (J.lower + J.upper) * unit2 * unit2, whole.centroid_y + whole.unit * zy[1],
               whole.centroid_height + whole.unit * zy[0]};
}

/// Halves the triangles until the bounds of J are close.
template <typename Solve>
auto refined(Solve solve) {
  double size = kCoarsest;
  for (int i = 0; i <= kRefinements; ++i, size *= 0.5)
    if (const auto found = solve(size)) return *found;
  refuse("E-SECTION-24",
         "the section is too thin or ragged for its Saint-Venant solution; use fewer points and "
         "remove slivers");
}

}  // namespace

SaintVenant saint_venant(const std::vector<std::array<double, 2>>& polygon, double poisson) {
  if (!(poisson > -1.0 && poisson <= 0.5))
    refuse("E-SECTION-25",
           "Poisson's ratio is " + std::to_string(poisson) + "; expected above -1, at most 0.5");
  const ScaledHalf half = scale(polygon);
  return refined([&](double size) { return solve(half, size, poisson); });
}

Twist twist(const std::vector<std::array<double, 2>>& polygon) {
  const ScaledWhole whole = scale_whole(polygon);
  return refined([&](double size) { return solve_whole(whole, size); });
}

}  // namespace railstep
