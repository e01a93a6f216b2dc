#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// Reduction of the receptance of points of the rails by the fixed ports of a condensed model.
/// Ports that are closed at rest act as springs and dampers. With G of the lines, in which all
/// ports are open, between points x and ports p: G_xp (1/(k + i omega c) + G_pp)^-1 G_px.
class ClosedPorts {
 public:
  ClosedPorts(const Track& track, const PackedModel& packed, const std::vector<RailPoint>& points);
  void subtract(double omega, Eigen::VectorXcd& receptances) const;

 private:
  std::vector<FixedPort> ports_;
  Eigen::VectorXcd rate_;           // of the modes of all lines, 1/s
  Eigen::MatrixXcd points_, rows_;  // [modes][points], [modes][ports]
};

/// Static flexibility of a track at rest, whose closed ports are springs, between the closings of
/// all its fixed ports and points of its rails, m/N.
struct PortStatics {
  Eigen::MatrixXd points;  // [ports][points]
  Eigen::MatrixXd ports;   // [ports][ports]
};
/// For a model as it is stepped, without residual flexibility, which does not act at ports.
PortStatics port_statics(const Track& track, const PackedModel& packed,
                         const std::vector<RailPoint>& points);
/// For the track `at_rest`, with the fixed ports of `track`.
PortStatics port_statics(const Track& track, const Track& at_rest,
                         const std::vector<RailPoint>& points);

/// Deflection of each point under a force of 1 N on it alone, m. The fixed ports that this force
/// closes are closed, without their gaps.
/// @param under  [points] the same for the track at rest
Eigen::VectorXd deflection_under(const std::vector<FixedPort>& ports, const PortStatics& statics,
                                 const Eigen::VectorXd& under);

}  // namespace railstep
