#include "offline/pack/start_flange.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "online/step/input.h"

namespace railstep {

namespace {

/// Sum of the forces along an axis at t = 0, N.
double force_along(const WheelsetModel& w, int direction) {
  double sum = 0.;
  for (std::int32_t i = 0; i < w.forces; ++i)
    if (w.force[i].direction == direction) sum += force_at(w.force[i], 0., nullptr);
  return sum;
}

/// Rows of y, z and roll, one column for each contact.
Eigen::Matrix3d rows_of(const Leaning& leaning) {
  Eigen::Matrix3d rows;
  for (int i = 0; i < 3; ++i)
    rows.col(i) = Eigen::Map<const Eigen::Vector3d>(
        leaning.contact[static_cast<std::size_t>(i)].body_row + 1);
  return rows;
}

double depth_of(const ContactModel& law, double force) {
  return law.hertz > 0. ? std::pow(force / law.hertz, 2. / 3.) : force / law.stiffness;
}

}  // namespace

double side_force(const WheelsetModel& wheelset) { return force_along(wheelset, 1); }

void check_sides(const Model& model) {
  for (std::int32_t b = 0; b < model.wheelsets; ++b) {
    if (side_force(model.wheelset[b]) == 0.) continue;
    if (contacts_of(model, b).count == 2)
      throw std::invalid_argument(
          "no equilibrium: a lateral force acts on a wheelset at the start and nothing holds it");
    if (model.wheelsets + model.vehicles > 1)
      throw std::invalid_argument(
          "no equilibrium is sought of a wheelset that leans on its flange beside other wheelsets "
          "and vehicles; accepted is step.start = \"released\"");
  }
}

Leaning lean(const Model& model, const Configuration& at) {
  const WheelsetModel& w = model.wheelset[0];
  Leaning leaning{};
  leaning.side = side_force(w) > 0. ? 0 : 1;
  WheelContact contact[4];
  find_contacts(model, w, at, contact);
  find_flanges(model, model.flange[0], at, contact + 2);
  leaning.contact = {contact[0], contact[1], contact[2 + leaning.side]};
  const Eigen::Vector3d applied(side_force(w), force_along(w, 2) - w.weight, 0.);
  leaning.force = rows_of(leaning).partialPivLu().solve(-applied);
  for (int i = 0; i < 3; ++i)
    if (!leaning.contact[static_cast<std::size_t>(i)].on_rail || !(leaning.force[i] > 0.))
      throw std::invalid_argument(
          "no equilibrium in contact: the lateral force lifts a wheel over its flange");
  return leaning;
}

Eigen::Vector3d way_to_depths(const Model& model, const Leaning& leaning,
                              const std::array<double, 3>& missed) {
  const WheelsetModel& w = model.wheelset[0];
  const ContactModel law[3] = {{w.hertz[0], 0., 0.}, {w.hertz[1], 0., 0.}, model.flange[0].contact};
  Eigen::Vector3d too_deep;
  for (int i = 0; i < 3; ++i) {
    const auto c = static_cast<std::size_t>(i);
    too_deep[i] = leaning.contact[c].penetration + missed[c] - depth_of(law[i], leaning.force[i]);
  }
  return rows_of(leaning).transpose().partialPivLu().solve(too_deep);
}

std::vector<PointForce> forces_on_rails(const Leaning& leaning) {
  std::vector<PointForce> forces;
  for (int i = 0; i < 3; ++i) {
    const WheelContact& c = leaning.contact[static_cast<std::size_t>(i)];
    for (const int direction : {1, 2})
      forces.push_back(
          {{c.row.rail, c.x, c.y, c.z, direction}, -leaning.force[i] * c.normal[direction]});
  }
  return forces;
}

}  // namespace railstep
