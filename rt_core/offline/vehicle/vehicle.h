#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/math/constants.h"

namespace railstep {

/// How wheels hold on to the rail: by Hertz; by a spring and a damper that pull too; or so that
/// they never leave it.
enum class WheelContactKind { hertz, linear, bonded };

/// A vehicle that bounces and pitches over one rail: rigid bodies on springs and dampers, wheels on
/// the rail. Places are along x from the vehicle's origin, positive ahead.
struct Vehicle {
  struct Body {
    double mass;                // kg
    double pitch_inertia = 0.;  // about y through its centre, kg m2; 0: it does not pitch
    double place = 0.;          // of its centre, m
    double carried = 0.;        // kg: weight without inertia
  };
  /// A spring and a damper, upright, side by side.
  struct Suspension {
    int upper, lower;  // bodies
    double place;      // m
    double stiffness;  // N/m
    double damping;    // N s/m
  };
  /// Where a body rests on the rail.
  struct Wheel {
    int body;
    double place;   // m
    double radius;  // m
  };
  std::vector<Body> bodies;
  std::vector<Suspension> suspensions;
  std::vector<Wheel> wheels;
};

/// First coordinate of each body among the vehicle's, z and then pitch if it has one; behind the
/// last body their number.
std::vector<int> first_coordinates(const Vehicle& vehicle);

/// M q'' + C q' + K q = B' f - weight, q = each body's centre z (up) and then its pitch
/// (right-handed about y: ahead goes down) if it has one; B q are the wheels' z, f the rail's
/// forces on them, up.
struct VehicleMatrices {
  Eigen::MatrixXd mass, damping, stiffness;  // [n][n]
  Eigen::VectorXd weight;                    // [n] N
  Eigen::MatrixXd wheels;                    // B [wheels][n]
};

/// Throws Refused on no bodies or wheels, masses not above 0, bodies that are not there, and on
/// stiffness, damping or pitch inertia below 0.
VehicleMatrices vehicle_matrices(const Vehicle& vehicle, double gravity = kGravity);

/// Where the vehicle stands on a level, rigid rail: q and the rail's forces on its wheels, N.
/// Throws Refused if springs and wheels leave a motion free.
struct VehicleRest {
  Eigen::VectorXd displacement, force;
};
VehicleRest vehicle_at_rest(const VehicleMatrices& matrices);

}  // namespace railstep
