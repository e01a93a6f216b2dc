#include <cmath>
#include <string>

#include "offline/contact/hertz.h"
#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "offline/pack/travel_rows.h"
#include "online/math/table.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

ContactLaw contact_of(const RunningVehicle& vehicle, double radius, const Railhead& head,
                      const Material& material) {
  switch (vehicle.contact) {
    case WheelContactKind::linear:
      if (!(vehicle.stiffness > 0.) || !(vehicle.damping >= 0.))
        refuse("E-PACK-37", "the stiffness of a linear contact is " +
                                std::to_string(vehicle.stiffness) + " N/m and its damping " +
                                std::to_string(vehicle.damping) +
                                " N s/m; expected a stiffness above 0 and a damping of at least 0");
      return {0., vehicle.stiffness, vehicle.damping};
    case WheelContactKind::bonded:
      return {0., kBonded, 0.};
    default:
      return {hertz_constant(radius, head.crown_radius, material.young, material.poisson), 0., 0.};
  }
}

}  // namespace

double first_speed(const MovingLoad& load) {
  if (load.speeds.empty()) return load.speed;
  return table_value(load.speeds.data(), static_cast<std::int32_t>(load.speeds.size() / 2), 0.);
}

TravelTable travel_table(double speed, const std::vector<double>& speeds) {
  TravelTable made{{}, speed};
  if (speeds.empty()) return made;
  made.speed = 0.;
  std::vector<double>& rows = made.rows;
  for (std::size_t i = 0; i < speeds.size(); i += 2) {
    const double t = speeds[i], v = speeds[i + 1];
    double way = 0.;
    if (!rows.empty()) {
      const double* last = rows.data() + rows.size() - 3;
      if (!(t > last[0]))
        refuse(
            "E-PACK-38",
            "the times in a table of speeds do not rise; expected each time above the one before");
      way = last[2] + .5 * (t - last[0]) * (last[1] + v);
    }
    rows.insert(rows.end(), {t, v, way});
    if (std::abs(v) > std::abs(made.speed)) made.speed = v;
  }
  const double at_zero = travelled(made.model(), 0.).distance;
  for (std::size_t i = 2; i < rows.size(); i += 3) rows[i] -= at_zero;
  return made;
}

TravelModel PackedModel::keep_travel(double speed, const std::vector<double>& speeds) {
  TravelTable made = travel_table(speed, speeds);
  TravelModel packed = made.model();
  packed.table = packed.rows == 0 ? nullptr : keep(std::move(made.rows));
  return packed;
}

void PackedModel::add_vehicle(const Track& track, const RunningVehicle& vehicle,
                              const std::array<Railhead, 2>& heads) {
  if (vehicle.rail < 0 || vehicle.rail >= track.rails)
    refuse(
        "E-PACK-06",
        "a vehicle is on a rail that the track does not have; expected rail 0, or rail 1 of two");
  if (model_.vehicles == kMaxVehicles)
    refuse("E-PACK-40", "there are more vehicles than a model takes; expected at most " +
                            std::to_string(kMaxVehicles));
  const VehicleMatrices m = vehicle_matrices(vehicle.vehicle, vehicle.gravity);
  const auto n = static_cast<std::int32_t>(m.mass.rows());
  if (n > kMaxVehicleUnknowns)
    refuse("E-PACK-41", "a vehicle has " + std::to_string(n) + " coordinates; expected at most " +
                            std::to_string(kMaxVehicleUnknowns));
  if (!vehicle.tread.empty() && vehicle.tread.size() != vehicle.vehicle.wheels.size())
    refuse("E-PACK-43", "a vehicle has " + std::to_string(vehicle.tread.size()) +
                            " treads; expected none or " +
                            std::to_string(vehicle.vehicle.wheels.size()) + ", one for each wheel");
  const auto rail = static_cast<std::size_t>(vehicle.rail);
  SuspendedModel& packed = model_.vehicle[model_.vehicles];
  packed.start = model_.endless.origin + vehicle.start;
  packed.travel = keep_travel(vehicle.speed, vehicle.speeds);
  const SuspendedResponse step =
      add_suspended({m.mass.diagonal(), -m.weight, m.damping, m.stiffness, Eigen::MatrixXd(n, 0)},
                    vehicle.forces, packed);
  const Eigen::MatrixXd moved = step.inverse * m.wheels.transpose();
  for (std::size_t i = 0; i < vehicle.vehicle.wheels.size(); ++i) {
    const Vehicle::Wheel& wheel = vehicle.vehicle.wheels[i];
    const auto row = static_cast<Eigen::Index>(i);
    ContactModel& own = insert_contact(vehicle_contact(model_, model_.vehicle_wheels));
    ++model_.vehicle_wheels;
    own.kind = ContactKind::wheel;
    own.bodies = model_.vehicles;
    own.rail = vehicle.rail;
    own.place = wheel.place;
    own.law = contact_of(vehicle, wheel.radius, heads[rail], track.bar(vehicle.rail).material);
    own.load_point = load_point_of_wheel(vehicle.rail);
    own.row = keep(column_by_column(m.wheels.row(row)));
    own.moved = keep(column_by_column(moved.col(row)));
    if (!vehicle.tread.empty()) own.tread = keep(vehicle.tread[i]);
  }
  ++model_.vehicles;
}

}  // namespace railstep
