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
    double stiffness, damping;  // N/m, N s/m; of a damper that is not linear its slope at rest
    double moved = 0.;          // by the poses of frames on a design line, m
  };
  Eigen::VectorXd mass;                // [n] kg, kg m2
  Eigen::MatrixXd damping, stiffness;  // [n][n] symmetric
  Eigen::VectorXd rest;                // [n] preloads less weights, N and N m
  std::vector<Series> series;
  /// An element that is not linear, with its force at rest and its poses as of Series.
  struct Element {
    Eigen::VectorXd row;        // [n]; 0 of a damper in series with a spring
    ForceElement law;           // without tables
    std::vector<double> curve;  // [points][3], see RisingCurve
    std::vector<double> value;  // RunnerForceElement::value
    int series = -1;            // the number of the spring that it is in series with
    Eigen::VectorXd load = {};  // [n] displacement of its load
    double moved = 0., load_moved = 0.;
  };
  std::vector<Element> force_elements;
  /// A displacement of a linear element that is published.
  struct Traced {
    Eigen::VectorXd row;    // [n]
    TracedElement element;  // its deflection: the number of its `series`
  };
  std::vector<Traced> traced;
  Eigen::MatrixXd rods;  // [n][rods] elongation of each; with `rods_moved` it stays 0
  /// [n][n] what frames that stand turned and aside add to the stiffness of small motions; empty
  /// without a design line.
  Eigen::MatrixXd turned = {};
  Eigen::VectorXd rods_moved = Eigen::VectorXd::Zero(rods.cols());  // as of Series
};

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
/// Displacement of body `a` against body `b` along or about an axis at a point, [n]. The spin of a
/// wheelset does not count: its axle boxes do not turn with it.
Eigen::VectorXd deflection(const Runner& runner, int a, int b, const std::array<double, 3>& point,
                           BodyMotion along);

/// Gives the elements whose preload is 0 in all entries the force that they carry where the vehicle
/// stands under its weight with its wheelsets held. Springs are linear, without geometric
/// stiffness; where springs alone do not decide, the energy is least.
/// Throws Refused where the preloads then do not carry the weight of a body.
void balance_preloads(Runner& runner, double gravity);

}  // namespace railstep
