#pragma once
#include <string>
#include <vector>

#include "offline/math/constants.h"
#include "offline/vehicle/vehicle.h"

namespace railstep {

/// A vehicle and the names of its bodies, in their order.
struct NamedVehicle {
  Vehicle vehicle;
  std::vector<std::string> bodies;
};

/// Values of one rail, which are half of those of a vehicle on two rails.
struct BogieData {
  double frame_mass, frame_inertia;           // kg, about y kg m2
  double wheel_mass;                          // of half a wheelset, kg
  double wheelbase;                           // first to last axle, m
  int axles;                                  // 2 or 3, at equal distances
  double primary_stiffness, primary_damping;  // of each axle box, N/m, N s/m
  double carried = 0.;                        // on the frame's middle, weight without inertia, kg
  double radius = kWheelRadius;               // of the wheels, m
};
struct CarData {
  BogieData bogie;  // each of two
  double body_mass, body_inertia;
  double bogie_distance;                          // between their middles, m
  double secondary_stiffness, secondary_damping;  // of each bogie
};

/// A mass on one wheel: "body".
NamedVehicle point_mass(double mass, double radius = kWheelRadius);

/// A mass on a spring and a damper on an unsprung one: "body", "wheel_1".
NamedVehicle sprung_mass(double mass, double unsprung, double stiffness, double damping,
                         double radius = kWheelRadius);

/// A frame on axles: "frame", then "wheel_1", the foremost, and so on. Its origin is its middle.
NamedVehicle bogie(const BogieData& data);

/// A body on two bogies: "body", "frame_1" and "frame_2", "wheel_1" and so on, from the front.
NamedVehicle car(const CarData& data);

}  // namespace railstep
