#pragma once
#include <Eigen/Dense>

#include "support/pendulum_reference.h"

namespace railstep {

/// The links as rigid rods; y is their angles from x to z and these angles' rates. With m a link's
/// mass, L its length and I = m L^2/3 + rho I_y L its inertia about an end,
///   T = (I + m L^2) th1'^2/2 + I th2'^2/2 + m L^2/2 cos(th2 - th1) th1' th2'.
class RigidPendulum {
 public:
  explicit RigidPendulum(const DoublePendulum& scene)
      : length_(scene.link), weight_(-scene.link_mass() * scene.gravity[1]) {
    const double square = scene.link_mass() * length_ * length_;
    const double own = square / 3. + scene.material.density * scene.section().inertia_y * length_;
    inertia_ = {own + square, own, square / 2.};
  }

  Eigen::VectorXd start() const { return Eigen::VectorXd::Zero(4); }

  void slope(const Eigen::VectorXd& y, Eigen::VectorXd& dy) const {
    const double c = std::cos(y[1] - y[0]), s = std::sin(y[1] - y[0]), J = inertia_[2];
    Eigen::Matrix2d M;
    M << inertia_[0], J * c, J * c, inertia_[1];
    const Eigen::Vector2d turn(J * s * y[3] * y[3] - 1.5 * weight_ * length_ * std::cos(y[0]),
                               -J * s * y[2] * y[2] - .5 * weight_ * length_ * std::cos(y[1]));
    dy.head<2>() = y.tail<2>();
    dy.tail<2>() = M.inverse() * turn;
  }

  double energy(const Eigen::VectorXd& y) const {
    return .5 * inertia_[0] * y[2] * y[2] + .5 * inertia_[1] * y[3] * y[3] +
           inertia_[2] * std::cos(y[1] - y[0]) * y[2] * y[3] +
           weight_ * length_ * (1.5 * std::sin(y[0]) + .5 * std::sin(y[1]));
  }

  HingeAndEnd seen(const Eigen::VectorXd& y) const {
    const Eigen::Vector2d B(length_ * std::cos(y[0]), length_ * std::sin(y[0]));
    const Eigen::Vector2d C = B + length_ * Eigen::Vector2d(std::cos(y[1]), std::sin(y[1]));
    return {B[0], B[1], C[0], C[1]};
  }

 private:
  double length_, weight_;   // m, N
  Eigen::Vector3d inertia_;  // of th1, of th2, of both, kg m2
};

}  // namespace railstep
