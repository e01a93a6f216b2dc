#pragma once
#include <Eigen/Core>
#include <array>

#include "offline/start/static_lines.h"
#include "online/contact/wheel.h"

namespace railstep {

/// Lateral force on a wheelset's centre at t = 0, N; above 0 to the left.
double side_force(const WheelsetModel& wheelset);

/// Throws Refused if a lateral force acts on a wheelset at t = 0 and no flange holds it.
void check_sides(const Model& model);

/// Vertical force at t = 0 on a wheel of a wheelset on its rails, N. No moment acts on roll, so
/// that each wheel carries half. Throws Refused if the force is not above 0.
double wheel_load(const WheelsetModel& wheelset);

/// Coordinates of a wheelset that stands on its rails under its wheel_load().
/// @param height  of the railheads' tops above rest under the left and the right wheel, m
std::array<double, 6> standing_wheelset(const Model& model, std::int32_t wheelset,
                                        const std::array<double, 2>& height);

/// Contacts of a wheelset at rest. On both treads, z and roll depend on the contacts; if a lateral
/// force leans it on a flange, this is a third contact, and y depends on it too.
struct Stance {
  int count;                                          // of contacts: 2 or 3
  std::array<ContactId, 3> number;                    // among the model's contacts
  std::array<WheelContact, 3> contact;                // as the step finds them
  Eigen::VectorXd force;                              // [count] N
  int first_coordinate() const { return 4 - count; }  // of the dependent ones, up to roll
};

/// Contacts of wheelset b at its present place, and the forces in them that balance its weight and
/// the applied forces: sum of force row = -applied over the dependent coordinates.
/// Throws Refused if a wheel is off its rail or would have to pull.
Stance stance_of(const Model& model, std::int32_t b, const Configuration& at);

/// Shift along y that takes a wheelset without lateral force off a flange that its roll pressed
/// into the rail, m; 0 if no flange touches. Treads carry no lateral force, so that the flange must
/// not either.
double way_off_flanges(const Model& model, std::int32_t b, const Configuration& at);

/// Change of the dependent coordinates that brings each contact to the depth of its force, [count].
/// @param missed  [count] residual displacement of each contact's rail along its normal, m
Eigen::VectorXd way_to_depths(const Model& model, const Stance& stance,
                              const Eigen::VectorXd& missed);

/// Adds the forces of a wheelset on the rails.
void add_forces(const Model& model, const Stance& stance, Acting& acting);

/// Residual displacement of each contact's rail, [count]; 0 for a flange.
/// @param first  index of the wheelset's first force among the acting ports
Eigen::VectorXd missed_under(const Model& model, const Stance& stance, const Acting& acting,
                             std::size_t first);

}  // namespace railstep
