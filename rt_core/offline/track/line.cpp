#include <cmath>
#include <stdexcept>

#include "offline/track/track.h"

namespace railstep {

Eigen::SparseVector<double> point_row(const Track& track, const Line& line,
                                      const RailPoint& point) {
  const auto [element, xi] = place_on(track, point.x);
  const Vector27 local = point_row(xi, point.y, point.z, point.direction);
  const double factor = line.rail_factor[static_cast<std::size_t>(point.rail)];
  Eigen::SparseVector<double> row(line.unknowns());
  for (int i = 0; i < 27; ++i) {
    const int k = i % 9;
    const int unknown = line.unknown(point.rail, 2 * element + i / 9, k);
    if (unknown < 0 || local[i] == 0. || factor == 0.) continue;
    row.coeffRef(unknown) += factor * (sign_of(line, point.rail, k) * local[i]);
  }
  return row;
}

double sign_of(const Line& line, int rail, int k) {
  const bool flips = line.mirrored && rail == 1 && (k == 1 || k == 3 || k == 5 || k == 7);
  return flips != (line.rigid_section && k == 7) ? -1. : 1.;
}

Eigen::SparseVector<double> sleeper_row(const Track& track, const Line& line, int rail, int seat,
                                        int direction) {
  Eigen::SparseVector<double> row(line.unknowns());
  const auto& motions = line.sleeper_unknown_of[static_cast<std::size_t>(seat)];
  const double share = track.rails == 2 ? std::sqrt(.5) : 1.;
  const auto add = [&](SleeperMotion motion, double factor) {
    if (motions[motion] >= 0) row.coeffRef(motions[motion]) += factor;
  };
  const double turned = rail == 0 ? share : -share;
  if (direction == 0) add(kAlongX, share);
  if (direction == 0) add(kYaw, turned);
  if (direction == 1) add(kAlongY, share);
  if (direction == 2) add(kAlongZ, share);
  if (direction == 2) add(kRoll, turned);
  if (direction == 3) add(kPitch, share);
  return row;
}

namespace {

/// The track's state over the unknowns of one line.
Eigen::VectorXd state_of(const Track& track, const Line& line, const TrackState& state) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(line.unknowns());
  for (int rail = 0; rail < track.rails; ++rail) {
    const auto side = static_cast<std::size_t>(rail);
    Eigen::Index i = 0;
    for (const auto& node : line.unknown_of[side])
      for (int k = 0; k < 9; ++k, ++i)
        if (const int unknown = node[static_cast<std::size_t>(k)]; unknown >= 0)
          u[unknown] += sign_of(line, rail, k) * line.rail_factor[side] * state.rail[side][i];
    if (state.sleeper[side].size() == 0) continue;
    for (int seat = 0; seat <= track.bays; ++seat)
      for (int d = 0; d < 4; ++d)
        u += state.sleeper[side][4 * seat + d] * sleeper_row(track, line, rail, seat, d);
  }
  return u;
}

/// Adds the weight of a rail, as often as `factor` says.
void add_rail_weight(const Track& track, const Line& line, int rail, double factor,
                     Eigen::VectorXd& force) {
  const RailBar bar = track.bar(rail);
  const ElementMatrices element =
      element_matrices(bar.section, track.law(rail), track.element_length());
  for (int e = 0; e < track.elements(); ++e)
    for (int i = 0; i < 27; ++i) {
      const int unknown = line.unknown(rail, 2 * e + i / 9, i % 9);
      if (unknown >= 0) force[unknown] -= factor * element.line_load[i];
    }
}

}  // namespace

Eigen::VectorXd weight(const Track& track, const Line& line, double gravity) {
  if (track.state) return line.stiffness * state_of(track, line, *track.state);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(line.unknowns());
  const auto per_metre = [&](int rail) {
    const RailBar bar = track.bar(rail);
    return bar.material.density * bar.section.area * gravity;
  };
  if (line.mirrored) {
    add_rail_weight(track, line, 0, (line.rail_factor[0] + line.rail_factor[1]) * per_metre(0),
                    force);
  } else {
    for (int rail = 0; rail < track.rails; ++rail)
      add_rail_weight(track, line, rail,
                      line.rail_factor[static_cast<std::size_t>(rail)] * per_metre(rail), force);
  }
  const double share = track.rails == 2 ? std::sqrt(2.) : 1.;
  for (int seat = 0; seat <= track.bays; ++seat) {
    const int height = line.sleeper_unknown_of[static_cast<std::size_t>(seat)][kAlongZ];
    if (height >= 0) force[height] -= share * track.seat(seat).sleeper->mass / 2. * gravity;
  }
  return force;
}

}  // namespace railstep
