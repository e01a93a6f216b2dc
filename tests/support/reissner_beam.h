#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "offline/element/shape.h"
#include "offline/math/gauss.h"
#include "support/rotating_beam.h"

namespace railstep {

/// Another theory of the same beam, for reference: the planar geometrically exact beam of Reissner
/// (1972) and Simo and Vu-Quoc (1986), with 3-node elements and two Gauss points. Unknowns of a
/// node: x, z, and the section's angle, so the mass matrix is constant too. Strains: stretch r'.t1
/// - 1, shear r'.t2, curvature; t1 = (cos, sin), t2 = (-sin, cos) of the angle. It shares no code
/// with ANCF.
class ReissnerBody : public MovingBody {
 public:
  /// Clamped to a hub at its first node.
  ReissnerBody(const PlanarBeam& like, int elements, const SpinUp& hub)
      : hub_(hub), elements_(elements), part_(like.length / elements) {
    const BeamSection& s = like.section;
    const Material& m = like.material;
    law_ = {m.young * s.area, s.shear_factor_z * m.shear_modulus() * s.area, m.young * s.inertia_y};
    density_ = {m.density * s.area, m.density * s.area, m.density * s.inertia_y};
    const int n = 3 * (2 * elements + 1);
    free_.resize(index_of(n - 3));
    std::iota(free_.begin(), free_.end(), 3);
    mass_ = Eigen::MatrixXd::Zero(n, n);
    for (int e = 0; e < elements; ++e)
      for (const GaussPoint& g : gauss(3))
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
              mass_(6 * e + 3 * i + k, 6 * e + 3 * j + k) +=
                  g.weight * part_ / 2. * density_[k] * at(shape(g.xi), i) * at(shape(g.xi), j);
  }

  Moving at_rest() const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(mass_.rows());
    for (int i = 0; i < q.size(); i += 3) q[i] = part_ / 6. * i;
    return railstep::at_rest(q);
  }

  const std::vector<int>& free_unknowns() const override { return free_; }
  void prescribe(Moving& m) const override {
    m.q[2] = hub_.angle(m.time);
    m.v[2] = hub_.rate(m.time);
    m.a[2] = hub_.acceleration(m.time);
  }
  Eigen::VectorXd residual(const Moving& m) override {
    Eigen::VectorXd force = mass_ * m.a;
    stiffness_ = Eigen::MatrixXd::Zero(force.size(), force.size());
    for (int e = 0; e < elements_; ++e)
      for (const GaussPoint& g : gauss(2)) add_point(m.q, 6 * e, g, force);
    return picked(force, free_);
  }
  Eigen::VectorXd solve(const Moving&, double, double by_q,
                        const Eigen::VectorXd& residual) override {
    return picked_square(mass_ + by_q * stiffness_, free_).partialPivLu().solve(residual);
  }

 private:
  static double at(const std::array<double, 3>& n, int i) { return n[static_cast<std::size_t>(i)]; }

  /// Force and stiffness of one Gauss point of the element whose unknowns begin at `first`.
  void add_point(const Eigen::VectorXd& q, int first, const GaussPoint& g, Eigen::VectorXd& force) {
    const auto n = shape(g.xi), dn = shape_slope(g.xi);
    // Rows of x', z', angle, angle' over the nine unknowns.
    Eigen::Matrix<double, 4, 9> field = Eigen::Matrix<double, 4, 9>::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) field(k == 2 ? 3 : k, 3 * i + k) = at(dn, i) / (part_ / 2.);
      field(2, 3 * i + 2) = at(n, i);
    }
    const Eigen::Vector4d f = field * q.segment<9>(first);
    const double c = std::cos(f[2]), s = std::sin(f[2]);
    const double stretch = c * f[0] + s * f[1], shear = c * f[1] - s * f[0];
    Eigen::Matrix<double, 3, 4> B;  // strains by the fields
    B << c, s, shear, 0., -s, c, -stretch, 0., 0., 0., 0., 1.;
    const Eigen::Vector3d stress = law_.cwiseProduct(Eigen::Vector3d(stretch - 1., shear, f[3]));
    Eigen::Matrix4d K = B.transpose() * law_.asDiagonal() * B;
    K(0, 2) += -s * stress[0] - c * stress[1];
    K(1, 2) += c * stress[0] - s * stress[1];
    K(2, 0) += -s * stress[0] - c * stress[1];
    K(2, 1) += c * stress[0] - s * stress[1];
    K(2, 2) += -stretch * stress[0] - shear * stress[1];
    const double weight = g.weight * part_ / 2.;
    force.segment<9>(first) += weight * field.transpose() * (B.transpose() * stress);
    stiffness_.block<9, 9>(first, first) += weight * field.transpose() * K * field;
  }

  SpinUp hub_;
  int elements_;
  double part_;
  Eigen::Vector3d law_, density_;
  std::vector<int> free_;
  Eigen::MatrixXd mass_, stiffness_;
};

}  // namespace railstep
