#include "offline/vehicle/kinds.h"

namespace railstep {

namespace {

/// Adds a frame's axles, at whatever place the frame has.
void add_axles(const BogieData& data, int frame, NamedVehicle& v) {
  const double middle = v.vehicle.bodies[static_cast<std::size_t>(frame)].place;
  for (int axle = 0; axle < data.axles; ++axle) {
    const double place = middle + data.wheelbase * (.5 - axle / (data.axles - 1.));
    const int wheel = static_cast<int>(v.vehicle.bodies.size());
    v.vehicle.bodies.push_back({data.wheel_mass, 0., place});
    v.vehicle.suspensions.push_back(
        {frame, wheel, place, data.primary_stiffness, data.primary_damping});
    v.vehicle.wheels.push_back({wheel, place, data.radius});
    v.bodies.push_back("wheel_" + std::to_string(v.vehicle.wheels.size()));
  }
}

}  // namespace

NamedVehicle point_mass(double mass, double radius) {
  NamedVehicle v;
  v.vehicle.bodies = {{mass}};
  v.vehicle.wheels = {{0, 0., radius}};
  v.bodies = {"body"};
  return v;
}

NamedVehicle sprung_mass(double mass, double unsprung, double stiffness, double damping,
                         double radius) {
  NamedVehicle v;
  v.vehicle.bodies = {{mass}, {unsprung}};
  v.vehicle.suspensions = {{0, 1, 0., stiffness, damping}};
  v.vehicle.wheels = {{1, 0., radius}};
  v.bodies = {"body", "wheel_1"};
  return v;
}

NamedVehicle bogie(const BogieData& data) {
  NamedVehicle v;
  v.vehicle.bodies = {{data.frame_mass, data.frame_inertia, 0., data.carried}};
  v.bodies = {"frame"};
  add_axles(data, 0, v);
  return v;
}

NamedVehicle car(const CarData& data) {
  NamedVehicle v;
  v.vehicle.bodies = {{data.body_mass, data.body_inertia, 0.}};
  v.bodies = {"body", "frame_1", "frame_2"};
  for (const double side : {.5, -.5}) {
    const double place = side * data.bogie_distance;
    v.vehicle.bodies.push_back(
        {data.bogie.frame_mass, data.bogie.frame_inertia, place, data.bogie.carried});
    v.vehicle.suspensions.push_back({0, static_cast<int>(v.vehicle.bodies.size()) - 1, place,
                                     data.secondary_stiffness, data.secondary_damping});
  }
  for (const int frame : {1, 2}) add_axles(data.bogie, frame, v);
  return v;
}

}  // namespace railstep
