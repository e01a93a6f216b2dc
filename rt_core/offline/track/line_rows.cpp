#include <cmath>
#include <stdexcept>

#include "offline/track/track.h"

namespace railstep {

Vector27 rail_row(const Cant& cant, double xi, double y, double z, int direction) {
  if (cant.sine == 0. || direction == 0) return point_row(xi, y, z, direction);
  const double of_track[3] = {0., direction == 1 ? 1. : 0., direction == 2 ? 1. : 0.};
  double own[3];
  to_rail(cant, of_track, own);
  return own[1] * point_row(xi, y, z, 1) + own[2] * point_row(xi, y, z, 2);
}

Eigen::SparseVector<double> point_row(const Track& track, const Line& line, const RailPoint& point,
                                      bool strains) {
  const auto [element, xi] = place_on(track, point.x);
  const Vector27 local = rail_row(track.lean(point.rail), xi, point.y, point.z, point.direction);
  const double factor = line.rail_factor[static_cast<std::size_t>(point.rail)];
  Eigen::SparseVector<double> row(line.unknowns());
  for (int i = 0; i < 27; ++i) {
    const int k = i % 9;
    if (!strains && (k == 4 || k == 8)) continue;
    const int unknown = line.element_unknown(point.rail, element, i / 9, k);
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
  const double signed_share = rail == 0 ? share : -share;
  if (direction == 0) add(kAlongX, share);
  if (direction == 0) add(kYaw, signed_share);
  if (direction == 1) add(kAlongY, share);
  if (direction == 2) add(kAlongZ, share);
  if (direction == 2) add(kRoll, signed_share);
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
  const Vector27 load = line_load(track, rail);
  for (int e = 0; e < track.elements(); ++e)
    for (int i = 0; i < 27; ++i) {
      const int unknown = line.element_unknown(rail, e, i / 9, i % 9);
      if (unknown >= 0) force[unknown] -= factor * (sign_of(line, rail, i % 9) * load[i]);
    }
}

}  // namespace

Vector27 line_load(const Track& track, int rail) {
  const RailBar bar = track.bar(rail);
  const Vector27 upright =
      element_matrices(bar.section, track.law(rail), track.element_length()).line_load;
  const Cant cant = track.lean(rail);
  Vector27 load;
  for (int i = 0; i < 27; i += 3) to_rail(cant, upright.data() + i, load.data() + i);
  return load;
}

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
  for (int seat = 0; seat < track.seats(); ++seat) {
    const int height = line.sleeper_unknown_of[static_cast<std::size_t>(seat)][kAlongZ];
    if (height >= 0) force[height] -= share * track.seat(seat).sleeper->mass / 2. * gravity;
  }
  return force;
}

}  // namespace railstep
