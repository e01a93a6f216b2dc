#pragma once
#include <vector>

#include "offline/beam/structure.h"

namespace railstep {

/// Forces on a structure: those that keep their direction, and moments on nodes about fixed axes.
struct StructureLoad {
  Eigen::VectorXd force;  // [unknowns], N, and N m on slopes
  struct Moment {
    int node;
    Eigen::Vector3d moment;  // N m
  };
  std::vector<Moment> moments = {};
};

struct NewtonOptions {
  double tolerance = 1e-10;  // of the residual over the load
  int most_iterations = 30;  // of one load step
  int most_halvings = 10;    // of a load step that does not converge
};

/// One Newton iteration, for the history of a solution that was not found.
struct NewtonStep {
  double load_factor;  // 0 to 1
  int iteration;       // from 0
  double residual;     // over the whole load
};

struct Equilibrium {
  bool converged;
  Eigen::VectorXd q;  // of the last load that was reached
  double residual;    // of q, over the load
  int iterations;     // in all
  int load_steps;     // that converged
  std::vector<NewtonStep> history;
};

/// Equilibrium by Newton's method with the analytic tangent. The load is applied in one step. A
/// step that does not converge is halved; one that converges is followed by one of twice its size.
///
/// Sizes are compared with forces on slopes divided by `slope_length`. A step has converged when
/// the residual is below the tolerance times the load, or when no entry of it is above what
/// round-off leaves, 8 eps |K| |q|. It has also converged when two iterations did not halve the
/// residual and its norm is below that of 34 eps |K| |q|: some 34 roundings lie between a position
/// and a nodal force. Along the axis of a slender beam (length over height 1e4) this may be a
/// thousand times a small load across it, and no iteration gets below it. The deflection is still
/// right to 1e-7 with 4 elements and to 1e-5 with 32. Slender beams that bend far take hundreds of
/// iterations. An equilibrium need not be stable: is_stable() tells.
/// @param start  where to begin, in place of the shape at rest
Equilibrium equilibrium(const Structure& structure, const StructureLoad& load,
                        const NewtonOptions& options = {}, const Eigen::VectorXd* start = nullptr);

/// Whether the tangent at q is positive definite over the free unknowns (no pivot is negative):
/// else the structure buckles out of this shape. Moments that rotate with the structure are left
/// out.
bool is_stable(const Structure& structure, const Eigen::VectorXd& q);

}  // namespace railstep
