#pragma once
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/pack/pack.h"
#include "online/track/line.h"
#include "online/track/residual.h"

namespace railstep {

/// A force along the row that a step has of a contact.
struct ContactForce {
  RailRow row;
  double force;  // N
};

/// Forces that act on the track at points and along rows, and those of them that the residual
/// flexibility knows.
struct Acting {
  std::vector<PointForce> forces;
  std::vector<ContactForce> contacts;
  std::vector<RailForce> ports;
};

/// Static displacements of each line of the model, its unknowns or its coordinates if condensed,
/// with those of the track's one-sided springs that are closed.
std::vector<Eigen::VectorXd> static_lines(const PackedModel& packed, const Statics& statics,
                                          const Acting& acting, double gravity);

/// Height of a rail's point as the model's lines have it, m; the rest is residual.
double height_of(const Track& track, const PackedModel& packed,
                 const std::vector<Eigen::VectorXd>& lines, const RailPoint& at);

/// Where the force at a load point acts at a place along the rail.
RailPoint point_of(const PackedModel& packed, std::int32_t load_point, double x);

}  // namespace railstep
