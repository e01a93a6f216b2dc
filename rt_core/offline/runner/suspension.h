#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/runner/runner.h"

namespace railstep {

/// M q'' + C q' + K q + sum of row' force of `series` + rods' tension = rest + forces of the rails,
/// about the loaded vehicle at rest. The preloads of rods are part of their tension. q are the six
/// motions of each body, in their order.
struct RunnerMatrices {
  /// A damper in series with a spring: force' = stiffness (row q' - force / damping).
  struct Series {
    Eigen::VectorXd row;        // [n]
    double stiffness, damping;  // N/m, N s/m
    double moved = 0.;          // by the poses of frames on a design line, m
  };
  Eigen::VectorXd mass;                // [n] kg, kg m2
  Eigen::MatrixXd damping, stiffness;  // [n][n] symmetric
  Eigen::VectorXd rest;                // [n] preloads less weights, N and N m
  std::vector<Series> series;
  struct Stop {
    Eigen::VectorXd row;  // [n]
    StopModel law;
    std::vector<double> limit;  // RunnerStop::limit
    double moved = 0.;          // as of Series
  };
  std::vector<Stop> stops;  // at rest brakes have no moment
  Eigen::MatrixXd rods;     // [n][rods] elongation of each; with `rods_moved` it stays 0
  Eigen::VectorXd rods_moved = Eigen::VectorXd::Zero(rods.cols());  // as of Series
};

/// Forces of the bump stops over the coordinates at a displacement.
Eigen::VectorXd stop_forces(const RunnerMatrices& matrices, const Eigen::VectorXd& u);
/// The stiffness with that of the stops that press at a displacement.
Eigen::MatrixXd stiffness_at(const RunnerMatrices& matrices, const Eigen::VectorXd& u);

/// The stiffness is the second derivative of the elements' energy and includes what their preloads
/// make of it: the geometric stiffness. With s1 and s2 the parts of first and second order of a
/// point's displacement, d = s(a) - s(b), p the preload and t the mean rotation of both bodies,
/// the energy of a mid-frame element is d1' k d1 / 2 - p . (d1 + d2 - t x d1), and that of a line
/// with tension T and length L has T |d across|^2 / (2 L) in place of the last term. Preloads that
/// are moments make no geometric stiffness.
/// Throws Refused on bodies that are not there, and on masses, stiffness or damping out of range.
RunnerMatrices runner_matrices(const Runner& runner, double gravity);

/// Elongation of an element along a line over the coordinates of its vehicle, [n].
Eigen::VectorXd elongation(const Runner& runner, const RunnerElement& element);

/// Gives the elements whose preload is 0 in all entries the force that they carry where the vehicle
/// stands under its weight with its wheelsets held. Springs are linear, without geometric
/// stiffness; where springs alone do not decide, the energy is least.
/// Throws Refused where the preloads then do not carry the weight of a body.
void balance_preloads(Runner& runner, double gravity);

}  // namespace railstep
