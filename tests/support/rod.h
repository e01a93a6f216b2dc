#pragma once
#include <Eigen/Dense>

namespace railstep {

/// Shearable, extensible rod of Simo and Reissner: the geometrically exact beam, whose stress
/// resultants are linear in its strains. A second way to the nonlinear element's equilibria, which
/// shares no code with it. Simo, Comput. Meth. Appl. Mech. Eng. 49 (1985), 55-70.
struct Rod {
  double length;
  Eigen::Vector3d force_stiffness;                           // EA, G A k_y, G A k_z; N
  Eigen::Vector3d moment_stiffness;                          // GJ, EIy, EIz; N m2
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();        // columns: normal, y and z directions
  Eigen::Vector3d rest_curvature = Eigen::Vector3d::Zero();  // in the section's frame, 1/m
};

/// Quantities that are integrated along the rod.
struct RodPoint {
  Eigen::Vector3d r, moment;  // position; moment of the part beyond, N m
  Eigen::Matrix3d frame;
};

inline RodPoint rod_slope(const Rod& rod, const RodPoint& at, const Eigen::Vector3d& force) {
  const Eigen::Matrix3d& R = at.frame;
  const Eigen::Vector3d strain =
      (R.transpose() * force).cwiseQuotient(rod.force_stiffness) + Eigen::Vector3d::UnitX();
  const Eigen::Vector3d k =
      (R.transpose() * at.moment).cwiseQuotient(rod.moment_stiffness) + rod.rest_curvature;
  RodPoint slope;
  slope.r = R * strain;
  slope.moment = -slope.r.cross(force);
  for (int j = 0; j < 3; ++j)  // R [k]x
    slope.frame.col(j) = R * k.cross(Eigen::Vector3d::Unit(j));
  return slope;
}

inline RodPoint moved(const RodPoint& at, const RodPoint& slope, double by) {
  return {at.r + by * slope.r, at.moment + by * slope.moment, at.frame + by * slope.frame};
}

/// The rod's end if its root carries this moment, by the classical Runge-Kutta method.
inline RodPoint rod_end(const Rod& rod, const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                        int steps) {
  RodPoint at{Eigen::Vector3d::Zero(), moment, rod.root};
  const double h = rod.length / steps;
  for (int i = 0; i < steps; ++i) {
    const RodPoint k1 = rod_slope(rod, at, force);
    const RodPoint k2 = rod_slope(rod, moved(at, k1, h / 2.), force);
    const RodPoint k3 = rod_slope(rod, moved(at, k2, h / 2.), force);
    const RodPoint k4 = rod_slope(rod, moved(at, k3, h), force);
    at = moved(moved(moved(moved(at, k1, h / 6.), k2, h / 3.), k3, h / 3.), k4, h / 6.);
  }
  return at;
}

/// End of a rod clamped at its root, under an end force and an end moment that keep their
/// directions. It shoots for the root's moment with the load in 20 steps, by Newton with
/// differences.
inline RodPoint clamped_rod_end(const Rod& rod, const Eigen::Vector3d& force,
                                const Eigen::Vector3d& moment, int steps = 400) {
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  const double scale = force.norm() * rod.length + moment.norm();
  for (int load = 1; load <= 20; ++load) {
    const double part = load / 20.;
    const auto miss = [&](const Eigen::Vector3d& m) -> Eigen::Vector3d {
      return rod_end(rod, part * force, m, steps).moment - part * moment;
    };
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d at = miss(root);
      Eigen::Matrix3d slope;
      for (int j = 0; j < 3; ++j) {
        const double h = 1e-6 * scale;
        slope.col(j) = (miss(root + h * Eigen::Vector3d::Unit(j)) - at) / h;
      }
      root -= slope.partialPivLu().solve(at);
      if (at.norm() < 1e-12 * scale) break;
    }
  }
  return rod_end(rod, force, root, steps);
}

}  // namespace railstep
