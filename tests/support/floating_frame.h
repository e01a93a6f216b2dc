#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "offline/beam/structure.h"
#include "offline/element/shape.h"
#include "offline/math/gauss.h"
#include "support/time_integration.h"

namespace railstep {

/// A linear modal beam in a floating frame that moves in the x-z plane (Shabana, Dynamics of
/// Multibody Systems, ch. 5). Unknowns: origin R (m), angle theta from x to z, modal eta:
///   r = R + A(theta) (x + Phi(x) eta - e_x eta' H(x) eta / 2),  H(x) = int_0^x w' w'^T ds,
/// where w is the lateral part of Phi. H is the shortening of an inextensible line by its slope.
/// Kinetic energy keeps it to the second order in eta, which gives the centrifugal stiffening
/// (Kane, Ryan and Banerjee 1987). H = 0 is the formulation without stiffening.
///
/// All integrals over the body are constants, and the kinetic energy is
///   T = m R'^2/2 + R'.(th' A' S + A S_eta eta') + th'^2 I/2 + th' c.eta' + eta' Mf eta'/2,
///   S = S1 + Sf eta - e_x eta'Ha eta/2, I = I0 + 2 J.eta + eta'(Mf - Hx) eta, c = b + B' eta.
struct FloatingFrame {
  double mass;                   // kg
  Eigen::Vector2d first;         // S1 = int rho x, kg m
  Eigen::Matrix2Xd mode_first;   // Sf = int rho Phi, [2][modes]
  double inertia;                // I0, kg m2
  Eigen::VectorXd radial;        // J = int rho x.Phi
  Eigen::VectorXd circular;      // b = int rho x cross Phi
  Eigen::MatrixXd coriolis;      // B = int rho Phi_i cross Phi_j, skew
  Eigen::MatrixXd mode_mass;     // Mf
  Eigen::MatrixXd stiffness;     // of eta
  Eigen::MatrixXd shortening;    // Ha = int rho A H dx, [modes][modes]; 0 without
  Eigen::MatrixXd shortening_x;  // Hx = int rho A x H dx

  int modes() const { return static_cast<int>(radial.size()); }
};

/// A material point of the axis.
struct FramePoint {
  Eigen::Vector2d at;          // x, m
  Eigen::Matrix2Xd shape;      // Phi(x)
  Eigen::MatrixXd shortening;  // H(x); 0 without
};

/// [cos, -sin; sin, cos] and its derivative by the angle.
inline Eigen::Matrix2d turned(double angle) { return Eigen::Rotation2Dd(angle).matrix(); }
inline Eigen::Matrix2d turned_slope(double angle) { return turned(angle + 2. * std::atan(1.)); }

/// S at these modal coordinates, and its derivative [2][modes]. With Phi and H of a point for Sf
/// and Ha it is the point's place in the frame.
inline Eigen::Vector2d moved(const Eigen::Vector2d& at, const Eigen::Matrix2Xd& shape,
                             const Eigen::MatrixXd& shortening, const Eigen::VectorXd& eta) {
  return at + shape * eta - .5 * eta.dot(shortening * eta) * Eigen::Vector2d::UnitX();
}
inline Eigen::Matrix2Xd moved_slope(const Eigen::Matrix2Xd& shape,
                                    const Eigen::MatrixXd& shortening, const Eigen::VectorXd& eta) {
  return shape - Eigen::Vector2d::UnitX() * (shortening * eta).transpose();
}

/// M(q), [3 + modes] square.
inline Eigen::MatrixXd mass_matrix(const FloatingFrame& f, const Eigen::VectorXd& q) {
  const int n = f.modes();
  const Eigen::VectorXd eta = q.tail(n);
  const Eigen::Matrix2d A = turned(q[2]);
  Eigen::MatrixXd M(3 + n, 3 + n);
  M.topLeftCorner<2, 2>() = f.mass * Eigen::Matrix2d::Identity();
  M.block<2, 1>(0, 2) = turned_slope(q[2]) * moved(f.first, f.mode_first, f.shortening, eta);
  M.topRightCorner(2, n) = A * moved_slope(f.mode_first, f.shortening, eta);
  M(2, 2) = f.inertia + 2. * f.radial.dot(eta) + eta.dot((f.mode_mass - f.shortening_x) * eta);
  M.block(2, 3, 1, n) = (f.circular + f.coriolis.transpose() * eta).transpose();
  M.bottomRightCorner(n, n) = f.mode_mass;
  M.triangularView<Eigen::StrictlyLower>() = M.transpose();
  return M;
}

/// Generalised forces Q of M q'' = Q: quadratic velocity forces, gravity (m/s2) and -K eta.
inline Eigen::VectorXd frame_force(const FloatingFrame& f, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& v, const Eigen::Vector2d& gravity) {
  const int n = f.modes();
  const Eigen::VectorXd eta = q.tail(n), rate = v.tail(n);
  const double spin = v[2];
  const Eigen::Matrix2d A = turned(q[2]), slope = turned_slope(q[2]);
  const Eigen::Vector2d S = moved(f.first, f.mode_first, f.shortening, eta);
  const Eigen::Matrix2Xd S_eta = moved_slope(f.mode_first, f.shortening, eta);
  const Eigen::VectorXd half_I_eta = f.radial + (f.mode_mass - f.shortening_x) * eta;
  Eigen::VectorXd Q(3 + n);
  Q.head<2>() = f.mass * gravity + spin * spin * A * S - 2. * spin * slope * (S_eta * rate) +
                rate.dot(f.shortening * rate) * A.col(0);
  Q[2] = gravity.dot(slope * S) - 2. * spin * half_I_eta.dot(rate);
  Q.tail(n) = S_eta.transpose() * (A.transpose() * gravity) + spin * spin * half_I_eta +
              2. * spin * (f.coriolis * rate) - f.stiffness * eta;
  return Q;
}

/// Kinetic, gravity's and strain energy, J.
inline double energy(const FloatingFrame& f, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                     const Eigen::Vector2d& gravity) {
  const Eigen::VectorXd eta = q.tail(f.modes());
  const Eigen::Vector2d S = moved(f.first, f.mode_first, f.shortening, eta);
  return .5 * v.dot(mass_matrix(f, q) * v) + .5 * eta.dot(f.stiffness * eta) -
         gravity.dot(f.mass * q.head<2>() + turned(q[2]) * S);
}

/// Position of a point, and its derivative by the unknowns, [2][3 + modes].
inline Eigen::Vector2d position(const FramePoint& p, const Eigen::VectorXd& q) {
  const Eigen::VectorXd eta = q.tail(p.shape.cols());
  return q.head<2>() + turned(q[2]) * moved(p.at, p.shape, p.shortening, eta);
}
inline Eigen::Matrix2Xd jacobian(const FramePoint& p, const Eigen::VectorXd& q) {
  const Eigen::VectorXd eta = q.tail(p.shape.cols());
  Eigen::Matrix2Xd J(2, 3 + eta.size());
  J.leftCols<2>().setIdentity();
  J.col(2) = turned_slope(q[2]) * moved(p.at, p.shape, p.shortening, eta);
  J.rightCols(eta.size()) = turned(q[2]) * moved_slope(p.shape, p.shortening, eta);
  return J;
}

/// A point's acceleration where the unknowns have none, J' v with J' the Jacobian's rate:
///   -th'^2 A s + 2 th' A' s_eta eta' - A e_x eta' H eta'.
inline Eigen::Vector2d convective(const FramePoint& p, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& v) {
  const auto n = p.shape.cols();
  const Eigen::VectorXd eta = q.tail(n), rate = v.tail(n);
  const Eigen::Matrix2d A = turned(q[2]), slope = turned_slope(q[2]);
  return -v[2] * v[2] * A * moved(p.at, p.shape, p.shortening, eta) +
         2. * v[2] * slope * (moved_slope(p.shape, p.shortening, eta) * rate) -
         rate.dot(p.shortening * rate) * A.col(0);
}

/// The in-plane part of nodal vectors, and the same rotated by a right angle: (x, z) to (-z, x).
inline Eigen::MatrixXd in_plane(Eigen::MatrixXd nodal) {
  for (int i = 1; i < nodal.rows(); i += 3) nodal.row(i).setZero();
  return nodal;
}
inline Eigen::MatrixXd right_angle(const Eigen::MatrixXd& nodal) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(nodal.rows(), nodal.cols());
  for (int i = 0; i < nodal.rows(); i += 3) {
    result.row(i) = -nodal.row(i + 2);
    result.row(i + 2) = nodal.row(i);
  }
  return result;
}

/// Lateral slopes w' of the modes at a point of an element, [modes].
inline Eigen::VectorXd lateral_slope(const Structure::Element& e, const Eigen::MatrixXd& modes,
                                     double xi, double length) {
  const auto slope = shape_slope(xi);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(modes.cols());
  for (std::size_t i = 0; i < 3; ++i)
    w += slope[i] / (length / 2.) * modes.row(9 * e.node[i] + 2).transpose();
  return w;
}

/// Calls add(weight m, x m, w') at the Gauss points of a beam along x; polynomials of degree 5.
template <typename Add>
void along_axis(const Structure& s, const Eigen::MatrixXd& modes, Add add) {
  for (const Structure::Element& e : s.elements) {
    const double start = s.rest[9 * e.node[0]], length = s.rest[9 * e.node[2]] - start;
    for (const GaussPoint& g : gauss(3))
      add(g.weight * length / 2., start + (1. + g.xi) * length / 2.,
          lateral_slope(e, modes, g.xi, length));
  }
}

/// The frame of a uniform straight beam that lies along x from x = 0. Modes are nodal:
/// displacements and slopes, [unknowns][modes]; those of a cantilever make the frame tangent at x =
/// 0 and those of a free beam make it the mean axes of Buckens, with the shortening still measured
/// from x = 0. The nodal unknowns turn like vectors, so every integral over the body is a product
/// with `mass`.
/// @param mass        of the structure, [unknowns] square, of nodal displacements
/// @param stiffening  false drops H
inline FloatingFrame floating_frame(const Structure& s, const Eigen::SparseMatrix<double>& mass,
                                    const Eigen::MatrixXd& modes, bool stiffening) {
  const int n = static_cast<int>(modes.cols());
  const Eigen::MatrixXd rest = in_plane(s.rest), shape = in_plane(modes);
  const Eigen::MatrixXd around = right_angle(rest);
  Eigen::MatrixXd translation = Eigen::MatrixXd::Zero(s.unknowns(), 2);
  for (int i = 0; i < s.unknowns(); i += 9) translation(i, 0) = translation(i + 2, 1) = 1.;
  const Eigen::MatrixXd moving = mass * shape, along = mass * translation;
  FloatingFrame f;
  f.mass = along.col(0).dot(translation.col(0));
  f.first = along.transpose() * rest;
  f.mode_first = along.transpose() * shape;
  f.inertia = around.col(0).dot(mass * around.col(0));
  f.radial = moving.transpose() * rest;
  f.circular = moving.transpose() * around;
  f.coriolis = right_angle(shape).transpose() * moving;
  f.mode_mass = modes.transpose() * (mass * modes);
  f.stiffness = modes.transpose() * (tangent(s, s.rest) * modes);
  f.shortening = f.shortening_x = Eigen::MatrixXd::Zero(n, n);
  if (!stiffening) return f;
  double end = 0.;
  along_axis(s, modes, [&](double weight, double, const Eigen::VectorXd&) { end += weight; });
  along_axis(s, modes, [&](double weight, double x, const Eigen::VectorXd& w) {
    const Eigen::MatrixXd square = weight * f.mass / end * w * w.transpose();
    f.shortening += (end - x) * square;
    f.shortening_x += .5 * (end * end - x * x) * square;
  });
  return f;
}

/// A node at an element's end as a point of the frame.
inline FramePoint frame_point(const Structure& s, const Eigen::MatrixXd& modes, int node,
                              bool stiffening) {
  const auto n = modes.cols();
  FramePoint p{{s.rest[9 * node], s.rest[9 * node + 2]},
               Eigen::Matrix2Xd(2, n),
               Eigen::MatrixXd::Zero(n, n)};
  p.shape << modes.row(9 * node), modes.row(9 * node + 2);
  if (!stiffening) return p;
  along_axis(s, modes, [&](double weight, double x, const Eigen::VectorXd& w) {
    if (x < p.at[0]) p.shortening += weight * w * w.transpose();
  });
  return p;
}

/// A floating frame as the time scheme sees it. `drive` sets the unknowns that are not free.
class FloatingBody : public MovingBody {
 public:
  FloatingBody(FloatingFrame frame, std::vector<int> free, std::function<void(Moving&)> drive,
               const Eigen::Vector2d& gravity = Eigen::Vector2d::Zero())
      : frame_(std::move(frame)),
        free_(std::move(free)),
        drive_(std::move(drive)),
        gravity_(gravity) {}

  const FloatingFrame& frame() const { return frame_; }
  const std::vector<int>& free_unknowns() const override { return free_; }
  void prescribe(Moving& m) const override { drive_(m); }
  /// If the frame's motion is prescribed, the equations are linear in eta.
  bool linear() const override { return free_.front() == 3; }

  Eigen::VectorXd residual(const Moving& m) override {
    mass_ = mass_matrix(frame_, m.q);
    return picked(mass_ * m.a - frame_force(frame_, m.q, m.v, gravity_), free_);
  }

  /// Exact in eta. For the frame's own motion it has the mass and the terms of the spin.
  Eigen::VectorXd solve(const Moving& m, double by_v, double by_q,
                        const Eigen::VectorXd& residual) override {
    const FloatingFrame& f = frame_;
    const int n = f.modes();
    const double spin = m.v[2],
                 along = (turned(m.q[2]).transpose() * (m.a.head<2>() - gravity_))[0];
    const Eigen::MatrixXd second = f.mode_mass - f.shortening_x;
    const Eigen::VectorXd half_I_eta = f.radial + second * m.q.tail(n), rate = m.v.tail(n);
    Eigen::MatrixXd J = mass_;
    J.bottomRightCorner(n, n) += -2. * by_v * spin * f.coriolis +
                                 by_q * (f.stiffness - spin * spin * second +
                                         m.a[2] * f.coriolis.transpose() - along * f.shortening);
    J(2, 2) += 2. * by_v * half_I_eta.dot(rate);
    J.block(2, 3, 1, n) += 2. * by_v * spin * half_I_eta.transpose();
    J.block(3, 2, n, 1) -= 2. * by_v * (spin * half_I_eta + f.coriolis * rate);
    return picked_square(J, free_).partialPivLu().solve(residual);
  }

 private:
  FloatingFrame frame_;
  std::vector<int> free_;
  std::function<void(Moving&)> drive_;
  Eigen::Vector2d gravity_;
  Eigen::MatrixXd mass_;
};

}  // namespace railstep
