#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

#include "offline/analysis/free_motion.h"
#include "offline/math/sparse.h"

namespace railstep {

/// Equilibrium of a track with one-sided springs: the u that makes
///   E(u) = u' K u / 2 + sum stiffness max(0, d)^2 / 2 - f' u,   d = closing - gap,
/// least over all lines together. E is convex and piecewise quadratic: Newton's method with the
/// set of closed springs, and the exact minimum on each of its lines, ends in finitely many
/// steps.
class OneSided {
 public:
  /// Throws Refused if the track has a free rigid mode with all springs closed.
  OneSided(const Track& track, const std::vector<Line>& lines, std::vector<FixedPort> ports);

  /// Displacements of each line's unknowns under a load of each, N. Throws Refused if there is no
  /// equilibrium.
  std::vector<Eigen::VectorXd> solve(const std::vector<Eigen::VectorXd>& load) const;
  /// stiffness max(0, d) of each port, N.
  std::vector<double> forces(const std::vector<Eigen::VectorXd>& displacement) const;

 private:
  using Closed = std::vector<bool>;

  Sparse stiffness(const Closed& closed, double open_fraction) const;
  Eigen::VectorXd depth(const Eigen::VectorXd& u) const;
  Closed closed_at(const Eigen::VectorXd& u) const;
  Eigen::VectorXd gradient(const Eigen::VectorXd& u, const Eigen::VectorXd& load) const;
  Eigen::VectorXd newton_step(const Closed& closed, const Eigen::VectorXd& gradient) const;
  double minimum_along(const Eigen::VectorXd& u, const Eigen::VectorXd& step,
                       const Eigen::VectorXd& load) const;

  std::vector<FixedPort> ports_;
  JoinedLines joined_;
  Eigen::SimplicialLDLT<Sparse> all_closed_;
};

}  // namespace railstep
