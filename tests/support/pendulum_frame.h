#pragma once
#include "support/floating_frame.h"
#include "support/pendulum_reference.h"
#include "support/planar_beam.h"

namespace railstep {

/// Modes that a link keeps of a beam, and whether a slope shortens it.
struct LinkModes {
  int bending = 3, axial = 1;
  bool stiffening = false;
  bool tangent = false;  // modes of a cantilever: the frame is tangent at the link's first end
};

/// The links as linear modal bodies in floating frames (floating_frame.h), y their unknowns and the
/// rates of these. Modes are those of the free link, whose frame is its mean axes, or a
/// cantilever's. A and the hinge hold the ends of the axis; their forces follow from accelerations:
///   [M J^T; J 0] (q'', lambda) = (Q, -dJ/dt q').
/// The drift of positions that this allows is the time scheme's error: joint_gap().
class FramePendulum {
 public:
  FramePendulum(const DoublePendulum& scene, const LinkModes& kept, int elements = 8)
      : gravity_(scene.gravity) {
    const PlanarBeam link = planar_beam(scene.section(), scene.material, scene.link, elements);
    const Eigen::MatrixXd modes =
        planar_modes(kept.tangent ? hubbed(link, true) : link, kept.bending, kept.axial);
    frame_ = floating_frame(link.structure, link.mass, modes, kept.stiffening);
    first_ = frame_point(link.structure, modes, 0, kept.stiffening);
    last_ = frame_point(link.structure, modes, 2 * elements, kept.stiffening);
    length_ = scene.link;
  }

  int unknowns() const { return 2 * own(); }
  Eigen::VectorXd start() const { return length_ * Eigen::VectorXd::Unit(2 * unknowns(), own()); }

  void slope(const Eigen::VectorXd& y, Eigen::VectorXd& dy) const {
    const int n = own(), all = unknowns();
    Eigen::VectorXd b(all + 4);
    for (int k = 0; k < 2; ++k)
      b.segment(k * n, n) =
          frame_force(frame_, y.segment(k * n, n), y.segment(all + k * n, n), gravity_);
    Eigen::MatrixXd J;
    b.tail<4>() = -joints(y, J);
    dy.head(all) = y.tail(all);
    dy.tail(all) = jointed(y, J).partialPivLu().solve(b).head(all);
  }

  /// Highest frequency about rest, rad/s. It is above that of the modes, as joints and rotations
  /// take part.
  double highest_frequency() const {
    const int n = own(), all = unknowns();
    Eigen::MatrixXd J, K = Eigen::MatrixXd::Zero(all, all);
    for (int k = 0; k < 2; ++k) K.block(k * n + 3, k * n + 3, n - 3, n - 3) = frame_.stiffness;
    const Eigen::VectorXd y = start();
    joints(y, J);
    const Eigen::MatrixXd soft = jointed(y, J).inverse().topLeftCorner(all, all);
    return std::sqrt(Eigen::MatrixXd(soft * K).eigenvalues().real().maxCoeff());
  }

  /// Distance of A from the origin and of the hinge's two ends from each other, m.
  double joint_gap(const Eigen::VectorXd& y) const {
    const int n = own();
    const Eigen::Vector2d hinge = position(first_, y.segment(n, n)) - position(last_, y.head(n));
    return std::max(position(first_, y.head(n)).norm(), hinge.norm());
  }

  double energy(const Eigen::VectorXd& y) const {
    const int n = own(), all = unknowns();
    return railstep::energy(frame_, y.head(n), y.segment(all, n), gravity_) +
           railstep::energy(frame_, y.segment(n, n), y.segment(all + n, n), gravity_);
  }

  /// B in the first link's frame, m.
  Eigen::Vector2d hinge_in_frame(const Eigen::VectorXd& y) const {
    return turned(y[2]).transpose() * (position(last_, y.head(own())) - y.head<2>());
  }

  HingeAndEnd seen(const Eigen::VectorXd& y) const {
    const int n = own();
    HingeAndEnd at;
    at << position(last_, y.head(n)), position(last_, y.segment(n, n));
    return at;
  }

 private:
  int own() const { return 3 + frame_.modes(); }

  /// [M J^T; J 0].
  Eigen::MatrixXd jointed(const Eigen::VectorXd& y, const Eigen::MatrixXd& J) const {
    const int n = own(), all = unknowns();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(all + 4, all + 4);
    for (int k = 0; k < 2; ++k)
      A.block(k * n, k * n, n, n) = mass_matrix(frame_, y.segment(k * n, n));
    A.block(all, 0, 4, all) = J;
    A.block(0, all, all, 4) = J.transpose();
    return A;
  }

  /// J, [4][unknowns]: A, then the hinge. @return dJ/dt q'
  Eigen::Vector4d joints(const Eigen::VectorXd& y, Eigen::MatrixXd& J) const {
    const int n = own(), all = unknowns();
    const Eigen::VectorXd q1 = y.head(n), q2 = y.segment(n, n), v1 = y.segment(all, n),
                          v2 = y.tail(n);
    J = Eigen::MatrixXd::Zero(4, all);
    J.topLeftCorner(2, n) = jacobian(first_, q1);
    J.bottomLeftCorner(2, n) = -jacobian(last_, q1);
    J.bottomRightCorner(2, n) = jacobian(first_, q2);
    Eigen::Vector4d turning;
    turning << convective(first_, q1, v1), convective(first_, q2, v2) - convective(last_, q1, v1);
    return turning;
  }

  FloatingFrame frame_;
  FramePoint first_, last_;
  double length_ = 0.;
  Eigen::Vector2d gravity_;
};

}  // namespace railstep
