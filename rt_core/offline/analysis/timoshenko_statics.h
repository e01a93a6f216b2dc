#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

#include "offline/analysis/statics.h"

namespace railstep {

/// Statics of one rail as a chain of exact Timoshenko elements on the centroid, between its ends
/// and on pads that stand on the ground: an independent check of the linear ANCF rail.
class TimoshenkoStatics {
 public:
  /// @param places  m along the rail, where nodes are needed beside the track's element borders:
  ///        under loads and wherever displacements are asked for
  /// Throws Refused on two rails, sleepers, axial force, a reference line off the
  /// centroid, a rule that is not the default and a free rigid mode.
  TimoshenkoStatics(const Track& track, const std::vector<double>& places);

  /// Displacements [6 nodes] under the forces, and the rail's weight if gravity is not 0.
  Eigen::VectorXd solve(const std::vector<PointForce>& forces, double gravity = 0.) const;
  /// Displacement of a point, m. Throws Refused if no node is there.
  double at(const Eigen::VectorXd& displacement, const RailPoint& point) const;
  /// Norm of load less stiffness times displacement, over the load's; moments over `lever`, m.
  double residual(const Eigen::VectorXd& displacement, const std::vector<PointForce>& forces,
                  double gravity, double lever) const;

 private:
  Track track_;
  std::vector<double> x_;    // of the nodes, m
  std::vector<int> number_;  // [6 nodes] among the free unknowns, -1 where held
  Eigen::SparseMatrix<double> stiffness_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;

  Eigen::SparseVector<double> row(const RailPoint& point) const;
  Eigen::VectorXd load(const std::vector<PointForce>& forces, double gravity) const;
  int number_unknowns();
  void assemble(int unknowns);
  void factorise();
};

}  // namespace railstep
