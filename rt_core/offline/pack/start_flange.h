#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "offline/track/statics.h"
#include "online/step/wheel.h"

namespace railstep {

/// Force aside on a wheelset's centre at t = 0, N; over 0 to the left.
double side_force(const WheelsetModel& wheelset);

/// Throws std::invalid_argument, in one sentence, where a force pushes a wheelset aside at t = 0
/// and no flange holds it, and where one that leans on its flange is not alone on the track.
void check_sides(const Model& model);

/// A wheelset that a force aside leans on a flange: left and right tread, and that flange.
struct Leaning {
  std::array<WheelContact, 3> contact;
  Eigen::Vector3d force;  // N
  int side;               // of the flange: 0 left, 1 right
};

/// The contacts of the model's wheelset where it is, and the forces in them that balance its weight
/// and what pushes it, in y, z and roll: sum of force row = -applied.
/// Throws std::invalid_argument where a tread would have to pull.
Leaning lean(const Model& model, const Configuration& at);

/// What of y, z and roll takes each contact to the depth that its force wants.
/// @param missed  residual displacement of each contact's rail along its normal, m
Eigen::Vector3d way_to_depths(const Model& model, const Leaning& leaning,
                              const std::array<double, 3>& missed);

/// Forces of a leaning wheelset on the rails, each upright and aside at its contact's point.
std::vector<PointForce> forces_on_rails(const Leaning& leaning);

}  // namespace railstep
