#include "offline/start/start_wheelset.h"

#include <Eigen/LU>

#include "offline/contact/hertz.h"
#include "offline/math/refuse.h"
#include "online/runner/body_force.h"

namespace railstep {

namespace {

/// Sum of the forces along an axis at t = 0, N.
double force_along(const WheelsetModel& w, int direction) {
  double sum = 0.;
  for (std::int32_t i = 0; i < w.forces; ++i)
    if (w.force[i].direction == direction) sum += force_at(w.force[i], 0., nullptr);
  return sum;
}

/// Rows of the dependent coordinates, one column for each contact.
Eigen::MatrixXd rows_of(const Stance& stance) {
  Eigen::MatrixXd rows(stance.count, stance.count);
  for (int i = 0; i < stance.count; ++i)
    rows.col(i) = Eigen::Map<const Eigen::VectorXd>(
        stance.contact[static_cast<std::size_t>(i)].body_row + stance.first_coordinate(),
        stance.count);
  return rows;
}

}  // namespace

double wheel_load(const WheelsetModel& w) {
  double vertical = -w.rest[index_of(BodyMotion::z)];
  for (std::int32_t i = 0; i < w.forces; ++i) {
    const double force = force_at(w.force[i], 0., nullptr);
    if (w.force[i].direction == 2) vertical -= force;
  }
  if (!(vertical > 0.))
    refuse("E-START-02",
           "no equilibrium: nothing presses a wheelset onto its rails; expected gravity, a force "
           "downwards, or step.start = \"released\"");
  return vertical / 2.;
}

namespace {

/// Lateral place at which a level wheel touches a rail at rest, from the middle of the track, m.
double contact_y(const Model& model, int rail) {
  const Cant& cant = model.cant[rail];
  const CrownTop top = crown_top(cant, model.head_z[rail], model.crown_radius[rail]);
  return model.rail_y[rail] + (cant.cosine * top.y - cant.sine * top.z);
}

}  // namespace

std::array<double, 6> standing_wheelset(const Model& model, std::int32_t b,
                                        const std::array<double, 2>& height) {
  const WheelsetModel& w = model.wheelset[b];
  const double into[2] = {contact_depth(model.contact[tread_of(b, 0)].law, wheel_load(w)),
                          contact_depth(model.contact[tread_of(b, 1)].law, wheel_load(w))};
  const double roll =
      ((height[0] - height[1]) - (into[0] - into[1])) / (contact_y(model, 0) - contact_y(model, 1));
  // A rolled axle is (r + crown) / cos(roll) above the centres of the crowns.
  const double crown = .5 * (model.crown_radius[0] + model.crown_radius[1]);
  const double lifted = .5 * roll * roll * (w.radius + crown);
  const double z = .5 * (height[0] + height[1]) - .5 * (into[0] + into[1]) + lifted;
  return {0., 0., z, roll, 0., 0.};
}

double side_force(const WheelsetModel& wheelset) { return force_along(wheelset, 1); }

void check_sides(const Model& model) {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    if (side_force(model.wheelset[b]) == 0.) continue;
    if (contacts_of(model, b).pair < 0)
      refuse("E-START-12",
             "no equilibrium: a lateral force acts on a wheelset at the start and nothing holds "
             "it; expected a flange, or a lateral force of 0 N at t = 0");
  }
}

Stance stance_of(const Model& model, std::int32_t b, const Configuration& at) {
  const WheelsetModel& w = model.wheelset[b];
  const double aside = side_force(w);
  Stance stance{2, {tread_of(b, 0), tread_of(b, 1), {-1}}, {}, {}};
  find_contacts(model, b, at, stance.contact.data());
  if (aside != 0.) {
    const int side = aside > 0. ? 0 : 1;
    WheelContact face[2];
    const std::int32_t pair = contacts_of(model, b).pair;
    find_flanges(model, model.flange[pair], at, face);
    stance.count = 3;
    stance.number[2] = flange_contact(model, flange_number(pair, side));
    stance.contact[2] = face[side];
  }
  const Eigen::Vector3d applied(aside, force_along(w, 2) + w.rest[2], 0.);
  stance.force = rows_of(stance).partialPivLu().solve(-applied.tail(stance.count));
  for (int i = 0; i < stance.count; ++i) {
    if (stance.contact[static_cast<std::size_t>(i)].on_rail && stance.force[i] > 0.) continue;
    if (aside != 0.)
      refuse("E-START-14",
             "no equilibrium: the lateral force lifts a wheel over its flange; expected a smaller "
             "lateral force at t = 0");
    refuse("E-START-15",
           "no equilibrium: a wheelset does not stand on both railheads; expected a place where "
           "it does, or step.start = \"released\"");
  }
  return stance;
}

double way_off_flanges(const Model& model, std::int32_t b, const Configuration& at) {
  const WheelsetContacts own = contacts_of(model, b);
  if (own.pair < 0 || side_force(model.wheelset[b]) != 0.) return 0.;
  WheelContact face[2];
  find_flanges(model, model.flange[own.pair], at, face);
  double way = 0.;
  for (const WheelContact& touched : face)
    if (touched.on_rail && touched.penetration > 0.)
      way += touched.penetration / touched.body_row[1];
  return way;
}

Eigen::VectorXd way_to_depths(const Model& model, const Stance& stance,
                              const Eigen::VectorXd& missed) {
  Eigen::VectorXd too_deep(stance.count);
  for (int i = 0; i < stance.count; ++i) {
    const auto c = static_cast<std::size_t>(i);
    too_deep[i] = stance.contact[c].penetration + missed[i] -
                  contact_depth(model.contact[stance.number[c]].law, stance.force[i]);
  }
  return rows_of(stance).transpose().partialPivLu().solve(too_deep);
}

void add_forces(const Model& model, const Stance& stance, Acting& acting) {
  for (int i = 0; i < stance.count; ++i) {
    const auto c = static_cast<std::size_t>(i);
    acting.contacts.push_back({stance.contact[c].row, -stance.force[i]});
    acting.ports.push_back(rail_force(model, model.contact[stance.number[c]].load_point,
                                      stance.contact[c].x, -stance.force[i]));
  }
}

Eigen::VectorXd missed_under(const Model& model, const Stance& stance, const Acting& acting,
                             std::size_t first) {
  Eigen::VectorXd missed(stance.count);
  for (int i = 0; i < stance.count; ++i)
    missed[i] =
        residual_displacement(model, acting.ports.data(), static_cast<int>(acting.ports.size()),
                              static_cast<int>(first) + i);
  return missed;
}

}  // namespace railstep
