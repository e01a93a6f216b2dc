#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "offline/pack/pack.h"

namespace railstep {

/// What the fixed ports of a condensed model take off the receptance of rails' points, those that
/// are closed at rest as springs and dampers: with G between points and ports of the lines, which
/// are open there, G_xp (1/(k + i omega c) + G_pp)^-1 G_px.
class ClosedPorts {
 public:
  ClosedPorts(const Track& track, const PackedModel& packed, const std::vector<RailPoint>& points);
  void subtract(double omega, Eigen::VectorXcd& receptances) const;

 private:
  std::vector<FixedPort> ports_;
  Eigen::VectorXcd rate_;           // of the modes of all lines, 1/s
  Eigen::MatrixXcd points_, rows_;  // [modes][points], [modes][ports]
};

/// Static flexibility of a track at rest, where what is closed is a spring, between the closings of
/// all its fixed ports and points of its rails, m/N.
struct PortStatics {
  Eigen::MatrixXd points;  // [ports][points]
  Eigen::MatrixXd ports;   // [ports][ports]
};
/// Of a model as it is stepped, but for residual flexibility, which ports do not know.
PortStatics port_statics(const Track& track, const PackedModel& packed,
                         const std::vector<RailPoint>& points);
/// Of a track as it stands, with the fixed ports of `track`.
PortStatics port_statics(const Track& track, const Track& at_rest,
                         const std::vector<RailPoint>& points);

/// How far each point goes down under a force of 1 N on it alone, where of the fixed ports those
/// are closed that it closes, and gaps count as nothing; m.
/// @param under  [points] the same of the track at rest
Eigen::VectorXd deflection_under(const std::vector<FixedPort>& ports, const PortStatics& statics,
                                 const Eigen::VectorXd& under);

}  // namespace railstep
