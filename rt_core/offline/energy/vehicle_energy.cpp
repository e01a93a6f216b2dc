#include "offline/energy/vehicle_energy.h"

#include <Eigen/Core>

#include "online/contact/body_force.h"

namespace railstep {
namespace {

using Vector = Eigen::Map<const Eigen::VectorXd>;
using Matrix =
    Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

struct Matrices {
  Vector mass, weight;
  Matrix damping, stiffness, row;
  explicit Matrices(const VehicleModel& v)
      : mass(v.mass, v.size),
        weight(v.weight, v.size),
        damping(v.damping, v.size, v.size),
        stiffness(v.stiffness, v.size, v.size),
        row(v.row, v.wheels, v.size) {}
};

/// Forces of tables and inputs, along the coordinates.
Eigen::VectorXd forces_on(const Model& model, const VehicleModel& vehicle, const State& at) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(vehicle.size);
  add_forces(vehicle, static_cast<double>(at.steps) * model.scheme.dt, at.input, sum.data());
  return sum;
}

}  // namespace

VehicleEnergy vehicle_energy(const VehicleModel& vehicle, const State& at) {
  const Matrices m(vehicle);
  const Vector u(at.u + vehicle.first, vehicle.size), v(at.v + vehicle.first, vehicle.size);
  return {.5 * v.dot(m.mass.cwiseProduct(v)), .5 * u.dot(m.stiffness * u)};
}

VehicleWork vehicle_work(const Model& model, const VehicleModel& vehicle, const State& before,
                         const State& after) {
  const Matrices m(vehicle);
  const auto part = [&](const double* values) {
    return Vector(values + vehicle.first, vehicle.size);
  };
  const double dt = model.scheme.dt;
  const Eigen::VectorXd du = part(after.u) - part(before.u), dv = part(after.v) - part(before.v);
  const Eigen::VectorXd f0 = forces_on(model, vehicle, before),
                        f1 = forces_on(model, vehicle, after);
  const double work = .5 * (f0 + f1).dot(du);
  if (model.form == Form::condensed)
    return {-m.weight.dot(du), work, du.dot(m.damping * du) / dt, .5 * (f0 - f1).dot(du)};
  const Eigen::VectorXd v = .5 * (part(before.v) + part(after.v));
  const Eigen::VectorXd g = .5 * (part(before.g) + part(after.g));
  const Eigen::VectorXd eu = du - dt * v, ev = dv - dt * g, Mg = m.mass.cwiseProduct(g);
  const double power =
      part(before.v).dot(m.damping * part(before.v)) + part(after.v).dot(m.damping * part(after.v));
  const double loss = eu.dot(Mg + m.damping * v) - v.dot(m.mass.cwiseProduct(ev)) -
                      .25 * dt * dv.dot(m.damping * dv);
  return {-m.weight.dot(du), work, .5 * dt * power, loss};
}

double vehicle_unbalanced(const Model& model, const VehicleModel& vehicle, const State& at,
                          const State& after) {
  const Matrices m(vehicle);
  const auto part = [&](const double* values) {
    return Vector(values + vehicle.first, vehicle.size);
  };
  const Vector force(at.contact_force + vehicle_contact(model, vehicle.first_wheel),
                     vehicle.wheels);
  const Eigen::VectorXd left = m.row.transpose() * force + forces_on(model, vehicle, at) -
                               m.weight - m.mass.cwiseProduct(part(at.g)) - m.damping * part(at.v) -
                               m.stiffness * part(at.u);
  return left.dot(part(after.u) - part(at.u));
}

}  // namespace railstep
