#pragma once
#include <Eigen/Core>
#include <cmath>

#include "offline/element/shape.h"

namespace railstep {

/// Nodes on an arc of radius R in the plane of x and z (bent up) or x and y; sections are normal to
/// it.
inline Vector27 arc_nodes(double length, double R, bool vertical) {
  Vector27 q;
  for (int i = 0; i < 3; ++i) {
    const double t = .5 * i * length / R, s = R * std::sin(t), c = R * (1. - std::cos(t));
    const Eigen::Vector3d across = vertical ? Eigen::Vector3d(-std::sin(t), 0., std::cos(t))
                                            : Eigen::Vector3d(-std::sin(t), std::cos(t), 0.);
    q.segment<3>(9 * i) = vertical ? Eigen::Vector3d(s, 0., c) : Eigen::Vector3d(s, c, 0.);
    q.segment<3>(9 * i + 3) = vertical ? Eigen::Vector3d::UnitY() : across;
    q.segment<3>(9 * i + 6) = vertical ? across : Eigen::Vector3d::UnitZ();
  }
  return q;
}

}  // namespace railstep
