#pragma once
#include <Eigen/Core>
#include <array>

#include "offline/start/static_lines.h"
#include "online/contact/wheel.h"

namespace railstep {

/// Force aside on a wheelset's centre at t = 0, N; over 0 to the left.
double side_force(const WheelsetModel& wheelset);

/// Throws Refused, in one sentence, where a force pushes a wheelset aside at t = 0
/// and no flange holds it, and where one that leans on its flange is not alone on the track.
void check_sides(const Model& model);

/// How a wheelset stands: on both treads, where z and roll follow, and where a force aside leans it
/// on a flange on that too, and y follows.
struct Stance {
  int count;                                          // of contacts: 2 or 3
  std::array<std::int32_t, 3> number;                 // among the model's contacts
  std::array<WheelContact, 3> contact;                // as the step finds them
  Eigen::VectorXd force;                              // [count] N
  int first_coordinate() const { return 4 - count; }  // that follows, up to roll
};

/// The contacts of wheelset b where it is, and the forces in them that balance its weight and what
/// pushes it: sum of force row = -applied over the coordinates that follow.
/// Throws Refused where a wheel is off its rail or would have to pull.
Stance stance_of(const Model& model, std::int32_t b, const Configuration& at);

/// How far along y takes a wheelset that no force pushes aside off a flange that its lean brings
/// into the rail, m; 0 where none touches. Its treads carry nothing sideways, so neither may a
/// flange.
double way_off_flanges(const Model& model, std::int32_t b, const Configuration& at);

/// What of the coordinates that follow takes each contact to the depth that its force wants,
/// [count].
/// @param missed  [count] residual displacement of each contact's rail along its normal, m
Eigen::VectorXd way_to_depths(const Model& model, const Stance& stance,
                              const Eigen::VectorXd& missed);

/// Adds the forces of a wheelset on the rails.
void add_forces(const Model& model, const Stance& stance, Acting& acting);

/// Residual displacement of each contact's rail, [count]; a flange knows none.
/// @param first  of the wheelset's forces among the acting ports
Eigen::VectorXd missed_under(const Model& model, const Stance& stance, const Acting& acting,
                             std::size_t first);

}  // namespace railstep
