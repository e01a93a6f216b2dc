#include "offline/vehicle/vehicle.h"

#include <Eigen/LU>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// Height of a body's point over the coordinates.
Eigen::VectorXd row(const Vehicle& vehicle, const std::vector<int>& first, int body, double place) {
  const auto b = static_cast<std::size_t>(body);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(first.back());
  r[first[b]] = 1.;
  if (vehicle.bodies[b].pitch_inertia > 0.) r[first[b] + 1] = vehicle.bodies[b].place - place;
  return r;
}

void check(const Vehicle& vehicle) {
  const auto is_body = [&](int body) {
    return body >= 0 && body < static_cast<int>(vehicle.bodies.size());
  };
  if (vehicle.bodies.empty() || vehicle.wheels.empty())
    refuse("E-VEHICLE-01", "a vehicle has no body or no wheel; expected one of each or more");
  for (const Vehicle::Body& body : vehicle.bodies) {
    if (!(body.mass > 0.))
      refuse("E-VEHICLE-40", "the mass of a vehicle's body is not positive; expected above 0 kg");
    if (!(body.pitch_inertia >= 0.))
      refuse("E-VEHICLE-41",
             "the pitch inertia of a vehicle's body is negative; expected 0 or more");
    if (!(body.carried >= 0.))
      refuse("E-VEHICLE-42", "a carried mass is negative; expected 0 kg or more");
  }
  for (const Vehicle::Suspension& s : vehicle.suspensions) {
    if (!is_body(s.upper) || !is_body(s.lower) || s.upper == s.lower)
      refuse("E-VEHICLE-43",
             "a suspension does not join two bodies of its vehicle; expected two different ones");
    if (!(s.stiffness >= 0.) || !(s.damping >= 0.))
      refuse("E-VEHICLE-44",
             "the stiffness or damping of a suspension is negative; expected 0 or more");
  }
  for (const Vehicle::Wheel& wheel : vehicle.wheels)
    if (!is_body(wheel.body) || !(wheel.radius > 0.))
      refuse("E-VEHICLE-45",
             "a wheel has no body of its vehicle, or no radius; expected both, and a radius above "
             "0 m");
}

}  // namespace

std::vector<int> first_coordinates(const Vehicle& vehicle) {
  std::vector<int> first = {0};
  for (const Vehicle::Body& body : vehicle.bodies)
    first.push_back(first.back() + (body.pitch_inertia > 0. ? 2 : 1));
  return first;
}

VehicleMatrices vehicle_matrices(const Vehicle& vehicle, double gravity) {
  check(vehicle);
  const std::vector<int> first = first_coordinates(vehicle);
  const int n = first.back(), wheels = static_cast<int>(vehicle.wheels.size());
  VehicleMatrices m;
  m.mass = m.damping = m.stiffness = Eigen::MatrixXd::Zero(n, n);
  m.weight = Eigen::VectorXd::Zero(n);
  m.wheels = Eigen::MatrixXd::Zero(wheels, n);
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const Vehicle::Body& body = vehicle.bodies[b];
    m.mass(first[b], first[b]) = body.mass;
    m.weight[first[b]] = (body.mass + body.carried) * gravity;
    if (body.pitch_inertia > 0.) m.mass(first[b] + 1, first[b] + 1) = body.pitch_inertia;
  }
  for (const Vehicle::Suspension& s : vehicle.suspensions) {
    const Eigen::VectorXd stretch =
        row(vehicle, first, s.upper, s.place) - row(vehicle, first, s.lower, s.place);
    m.stiffness += s.stiffness * stretch * stretch.transpose();
    m.damping += s.damping * stretch * stretch.transpose();
  }
  for (int w = 0; w < wheels; ++w) {
    const Vehicle::Wheel& wheel = vehicle.wheels[static_cast<std::size_t>(w)];
    m.wheels.row(w) = row(vehicle, first, wheel.body, wheel.place).transpose();
  }
  return m;
}

VehicleRest vehicle_at_rest(const VehicleMatrices& m) {
  const Eigen::Index n = m.mass.rows(), wheels = m.wheels.rows();
  // Forces over the stiffest spring keep the pivots alike.
  const double scale =
      m.stiffness.diagonal().maxCoeff() > 0. ? m.stiffness.diagonal().maxCoeff() : 1.;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + wheels, n + wheels);
  A.topLeftCorner(n, n) = m.stiffness / scale;
  A.topRightCorner(n, wheels) = -m.wheels.transpose();
  A.bottomLeftCorner(wheels, n) = m.wheels;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + wheels);
  b.head(n) = -m.weight / scale;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
  if (!lu.isInvertible())
    refuse("E-VEHICLE-02",
           "the springs and wheels of a vehicle leave it a free motion; expected suspensions with "
           "stiffness in every direction in which its bodies move");
  const Eigen::VectorXd x = lu.solve(b);
  return {x.head(n), scale * x.tail(wheels)};
}

}  // namespace railstep
