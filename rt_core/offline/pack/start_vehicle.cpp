#include "offline/pack/start_vehicle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace railstep {

namespace {

using Rows =
    Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// The vehicles' matrices side by side.
struct Together {
  Eigen::MatrixXd stiffness, row;  // [all][all], [wheels][all]
  Eigen::VectorXd weight;          // [all] N
};

Together together(const Model& model) {
  Eigen::Index n = 0;
  for (std::int32_t b = 0; b < model.vehicles; ++b) n += model.vehicle[b].size;
  Together all{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(model.vehicle_wheels, n),
               Eigen::VectorXd::Zero(n)};
  n = 0;
  for (std::int32_t b = 0; b < model.vehicles; ++b) {
    const VehicleModel& v = model.vehicle[b];
    all.stiffness.block(n, n, v.size, v.size) = Rows(v.stiffness, v.size, v.size);
    all.row.block(v.first_wheel, n, v.wheels, v.size) = Rows(v.row, v.wheels, v.size);
    all.weight.segment(n, v.size) = Eigen::Map<const Eigen::VectorXd>(v.weight, v.size);
    n += v.size;
  }
  return all;
}

/// Penetration under a force, and its rise over it.
struct Depth {
  double value, slope;  // m, m/N
};
Depth depth_of(const ContactModel& contact, double force) {
  if (contact.hertz == 0.) return {force / contact.stiffness, 1. / contact.stiffness};
  const double value = std::pow(force / contact.hertz, 2. / 3.);
  return {value, 2. / 3. * value / force};
}

constexpr int kTurns = 50;  // Newton's steps; a handful is enough where there is an answer

}  // namespace

SettledVehicles settle_vehicles(const Model& model, const Eigen::MatrixXd& flexibility,
                                const Eigen::VectorXd& free) {
  const Together all = together(model);
  const Eigen::Index n = all.weight.size(), wheels = free.size();
  // Forces over a stiffness keep the pivots alike.
  const double stiff = std::max(all.stiffness.diagonal().maxCoeff(), 1e6);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd force =
      Eigen::VectorXd::Constant(wheels, all.weight.sum() / static_cast<double>(wheels));
  for (Eigen::Index i = 0; i < wheels; ++i)
    if (model.vehicle_wheel[i].contact.hertz > 0. && !(force[i] > 0.))
      throw std::invalid_argument("no equilibrium in contact: nothing presses a vehicle down");
  bool settled = false, lifted_off = false;
  for (int turn = 0; turn < kTurns && !settled && !lifted_off; ++turn) {
    Eigen::MatrixXd A(n + wheels, n + wheels);
    Eigen::VectorXd b(n + wheels);
    A.topLeftCorner(n, n) = all.stiffness / stiff;
    A.topRightCorner(n, wheels) = -all.row.transpose();
    A.bottomLeftCorner(wheels, n) = all.row;
    A.bottomRightCorner(wheels, wheels) = stiff * flexibility;
    b.head(n) = (all.row.transpose() * force - all.weight - all.stiffness * u) / stiff;
    b.tail(wheels) = free - all.row * u - flexibility * force;
    for (Eigen::Index i = 0; i < wheels; ++i) {
      const Depth depth = depth_of(model.vehicle_wheel[i].contact, force[i]);
      A(n + i, n + i) += stiff * depth.slope;
      b[n + i] -= depth.value;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    if (!lu.isInvertible())
      throw std::invalid_argument(
          "no equilibrium: a vehicle's springs and wheels leave it a free motion");
    const Eigen::VectorXd change = lu.solve(b);
    u += change.head(n);
    settled = turn > 0;
    for (Eigen::Index i = 0; i < wheels; ++i) {
      const double next = force[i] + stiff * change[n + i];
      // A wheel that presses less than nothing gets a tenth of what it had, and another turn.
      const bool lifted = model.vehicle_wheel[i].contact.hertz > 0. && !(next > 0.);
      const double taken = lifted ? .1 * force[i] : next;
      // Newton's error is the square of its last step: 1e-10 leaves rounding.
      if (lifted || std::abs(taken - force[i]) > 1e-10 * force.cwiseAbs().maxCoeff())
        settled = false;
      force[i] = taken;
      if (taken < 1e-9 * std::abs(all.weight.sum()) && lifted) lifted_off = true;
    }
  }
  if (!settled)
    throw std::invalid_argument("no equilibrium with all of a vehicle's wheels on the rail");
  SettledVehicles found{force, {}};
  for (Eigen::Index b = 0, at = 0; b < model.vehicles; at += model.vehicle[b].size, ++b)
    found.displacement.emplace_back(u.segment(at, model.vehicle[b].size));
  return found;
}

}  // namespace railstep
