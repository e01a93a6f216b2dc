#pragma once
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/pack/pack.h"
#include "online/track/line.h"
#include "online/track/residual.h"

namespace railstep {

/// A force along the row of a contact in the step.
struct ContactForce {
  RailRow row;
  double force;  // N
};

/// Forces on the track at points and along rows, and those of them that have residual
/// displacements.
struct Acting {
  std::vector<PointForce> forces;
  std::vector<ContactForce> contacts;
  std::vector<RailForce> ports;
};

/// Row of a contact over the unknowns of a line.
/// @param strains  false: without the part of the section's own strain (a_y, b_z)
Eigen::VectorXd contact_row(const Line& line, const RailRow& row, bool strains);

/// Forces over the unknowns of each line of the model.
std::vector<Eigen::VectorXd> line_forces(const PackedModel& packed, const Track& track,
                                         const Acting& acting);

/// Static displacements of condensed lines, in their coordinates, with all one-sided springs open.
std::vector<Eigen::VectorXd> open_lines(const PackedModel& packed, const Track& track,
                                        const Acting& acting, double gravity);

/// Static displacements of each line of the model: its unknowns, or its coordinates if condensed.
/// They include the effect of the one-sided springs that are closed.
std::vector<Eigen::VectorXd> static_lines(const PackedModel& packed, const Statics& statics,
                                          const Acting& acting, double gravity);

/// Height of a point of a rail by the model's lines, m; without residual flexibility.
double height_of(const Track& track, const PackedModel& packed,
                 const std::vector<Eigen::VectorXd>& lines, const RailPoint& at);

/// Point at which a force at a load point acts, for a place along the rail.
RailPoint point_of(const PackedModel& packed, std::int32_t load_point, double x);

}  // namespace railstep
