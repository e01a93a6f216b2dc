#pragma once
#include <Eigen/Dense>
#include <array>

#include "support/high_order.h"
#include "support/system_run.h"

namespace railstep {

/// Bricard's mechanism, IFToMM benchmark A04: five square rods of 1 m and 1 kg along edges of a
/// cube, the ground as the sixth, six hinges each normal to both its rods. A count of constraints
/// allows no motion; it has one. Gravity is along -z.
struct Bricard {
  static constexpr double kGravity = 9.81, kSide = .1;
  std::array<Eigen::Vector3d, 6> point = {
      Eigen::Vector3d{0., 0., 0.},   Eigen::Vector3d{1., 0., 0.},   Eigen::Vector3d{1., 0., -1.},
      Eigen::Vector3d{1., -1., -1.}, Eigen::Vector3d{0., -1., -1.}, Eigen::Vector3d{0., -1., 0.}};
  std::array<Eigen::Vector3d, 6> axis = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(),
                                         Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                         Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()};

  Eigen::Matrix3d inertia(std::size_t i) const {
    const Eigen::Vector3d d = point[i + 1] - point[i];
    const double along = kSide * kSide / 6., across = (1. + kSide * kSide) / 12.;
    return across * Eigen::Matrix3d::Identity() + (along - across) * d * d.transpose();
  }
  System scene() const {
    System s;
    for (std::size_t i = 0; i < 5; ++i) {
      RigidBody b;
      b.mass = 1.;
      b.inertia = inertia(i);
      b.position = .5 * (point[i] + point[i + 1]);
      s.bodies.push_back(b);
    }
    for (int i = 0; i < 6; ++i)
      s.joints.push_back({.kind = JointKind::revolute,
                          .a = i == 0 ? ground() : body(i - 1),
                          .b = i == 5 ? ground() : body(i),
                          .point = point[static_cast<std::size_t>(i)],
                          .axis = axis[static_cast<std::size_t>(i)]});
    return s;
  }

  /// The open chain of five hinges in motion.
  struct Chain5 {
    std::array<Eigen::Matrix3d, 5> turn;
    std::array<Eigen::Vector3d, 6> point, axis;
    std::array<Eigen::Vector3d, 5> spin, spin_change;  // with hinge accelerations 0
    std::array<Eigen::Vector3d, 6> velocity, change;   // of the points, also with hinge
                                                       // accelerations 0
  };
  Chain5 chain(const Eigen::VectorXd& y) const {
    Chain5 c;
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d w = Eigen::Vector3d::Zero(), dw = w;
    c.point[0] = point[0];
    c.velocity[0] = c.change[0] = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 5; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      c.axis[i] = R * axis[i];
      dw += w.cross(c.axis[i]) * y[5 + k];
      w += c.axis[i] * y[5 + k];
      R = R * Eigen::AngleAxisd(y[k], axis[i]);
      const Eigen::Vector3d d = R * (point[i + 1] - point[i]);
      c.turn[i] = R;
      c.spin[i] = w;
      c.spin_change[i] = dw;
      c.point[i + 1] = c.point[i] + d;
      c.velocity[i + 1] = c.velocity[i] + w.cross(d);
      c.change[i + 1] = c.change[i] + dw.cross(d) + w.cross(w.cross(d));
    }
    c.axis[5] = R * axis[5];
    return c;
  }

  /// y' of y = five angles and their rates. The accelerations are the least ones that close the
  /// loop (point and axis at the last hinge), plus the one motion that it leaves, by virtual power.
  Eigen::VectorXd slope(const Eigen::VectorXd& y) const {
    using Vector5 = Eigen::Matrix<double, 5, 1>;
    const Chain5 c = chain(y);
    Eigen::Matrix<double, 6, 5> J;
    for (std::size_t i = 0; i < 5; ++i)
      J.col(static_cast<Eigen::Index>(i)) << c.axis[i].cross(c.point[5] - c.point[i]),
          c.axis[i].cross(c.axis[5]);
    Eigen::Matrix<double, 6, 1> bias;
    bias << c.change[5],
        c.spin_change[4].cross(c.axis[5]) + c.spin[4].cross(c.spin[4].cross(c.axis[5]));
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeFullV);
    svd.setThreshold(1e-6);  // the fifth singular value is 0 where the loop is closed
    const Vector5 closing = svd.solve(-bias), left = svd.matrixV().col(4);

    Eigen::Matrix<double, 5, 5> M = Eigen::Matrix<double, 5, 5>::Zero();
    Vector5 force = Vector5::Zero();
    for (std::size_t i = 0; i < 5; ++i) {
      const Eigen::Vector3d centre = .5 * (c.point[i] + c.point[i + 1]);
      const Eigen::Matrix3d I = c.turn[i] * inertia(i) * c.turn[i].transpose();
      Eigen::Matrix<double, 3, 5> v = Eigen::Matrix<double, 3, 5>::Zero(), w = v;
      for (std::size_t k = 0; k <= i; ++k) {
        v.col(static_cast<Eigen::Index>(k)) = c.axis[k].cross(centre - c.point[k]);
        w.col(static_cast<Eigen::Index>(k)) = c.axis[k];
      }
      const Eigen::Vector3d bare = .5 * (c.change[i] + c.change[i + 1]);
      M += v.transpose() * v + w.transpose() * I * w;
      force +=
          v.transpose() * (Eigen::Vector3d(0., 0., -kGravity) - bare) -
          w.transpose() * (I * c.spin_change[i] + c.spin[i].cross(Eigen::Vector3d(I * c.spin[i])));
    }
    const double along = left.dot(force - M * closing) / left.dot(M * left);
    Eigen::VectorXd d(10);
    d << y.tail<5>(), closing + along * left;
    return d;
  }
};

}  // namespace railstep
