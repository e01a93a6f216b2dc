#pragma once
#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "offline/analysis/one_sided.h"
#include "offline/track/track.h"

namespace railstep {

/// A point force on a rail; newton along the point's direction.
struct PointForce {
  RailPoint at;
  double force;  // N
};

/// Factored stiffness of every line of a track, for many right-hand sides. If the track has
/// one-sided supports (fixed_port.h), each solution finds which of them are closed.
class Statics {
 public:
  /// Throws Refused, as refuse_free_modes (free_motion.h) does, when a line has a
  /// free rigid mode; of a track with one-sided supports, when it has one with all of them closed.
  explicit Statics(const Track& track);

  /// Displacements of each line's unknowns under the forces, and the track's weight if asked.
  /// Throws Refused if one-sided supports leave no equilibrium.
  std::vector<Eigen::VectorXd> solve(const std::vector<PointForce>& forces,
                                     double gravity = 0.) const;
  /// The same under loads over each line's unknowns, as loads() gives them.
  std::vector<Eigen::VectorXd> under(std::vector<Eigen::VectorXd> load) const;
  /// Displacement of a point, m, given the lines' displacements.
  double at(const std::vector<Eigen::VectorXd>& displacement, const RailPoint& point) const;
  /// Flexibility G(a, b): displacement at a under a unit force at b, m/N. Symmetric. For a track
  /// without one-sided supports.
  double flexibility(const RailPoint& a, const RailPoint& b) const;
  /// Force of seat `seat` on its rail along z, N, up positive.
  double support_force(const std::vector<Eigen::VectorXd>& displacement, int rail, int seat) const;
  /// The forces and the weight over each line's unknowns.
  std::vector<Eigen::VectorXd> loads(const std::vector<PointForce>& forces, double gravity) const;
  /// Residual of the load in each line: f - K u, and the forces of one-sided supports.
  std::vector<Eigen::VectorXd> unbalanced(const std::vector<Eigen::VectorXd>& displacement,
                                          const std::vector<PointForce>& forces,
                                          double gravity) const;

  /// The one-sided springs, and their forces, N.
  const std::vector<FixedPort>& ports() const { return ports_; }
  std::vector<double> port_forces(const std::vector<Eigen::VectorXd>& displacement) const;

  const Track& track() const { return track_; }
  const std::vector<Line>& lines() const { return lines_; }

 private:
  Track track_;
  std::vector<Line> lines_;
  std::vector<FixedPort> ports_;
  std::unique_ptr<OneSided> one_sided_;  // where there are ports, in place of the factors
  std::vector<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factors_;
};

}  // namespace railstep
