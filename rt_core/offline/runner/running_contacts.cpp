#include "offline/runner/running_contacts.h"

#include <algorithm>

#include "offline/runner/rolling_slopes.h"

namespace railstep {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::array<double, kMotions> material_rates(const RailsUnder& rails, double radius, Index first,
                                            const VectorXd& u, const VectorXd& v) {
  std::array<double, kMotions> rates{};
  std::copy_n(v.data() + first, kMotions, rates.begin());
  add_frame_rates(rails, radius, u.data() + first, rates.data());
  return rates;
}

namespace {

void add_wheelset(const RollingContact& contact, double radius, double speed,
                  const RailsUnder& rails, Index first, const VectorXd& u, const VectorXd& v,
                  RailForces& sum) {
  for (const int side : {0, 1}) {
    WheelSlopes slopes;
    double over_rail[kMotions];
    place_over_rail(rails, side, u.data() + first, over_rail);
    const WheelForce f = force_on_wheel(contact, radius, side == 0 ? 1. : -1.,
                                        {speed, rails.grip[side]}, {over_rail, rails.roll[side]},
                                        material_rates(rails, radius, first, u, v).data(), slopes);
    for (int k = 0; k < kMotions; ++k) {
      sum.force[first + k] += f.generalised[k];
      for (int j = 0; j < 4; ++j)
        sum.by_displacement(first + k, first + index_of(kPlaced[j])) += slopes.by_motion[k][j];
      for (int j = 0; j < kMotions; ++j) sum.by_rate(first + k, first + j) += slopes.by_rate[k][j];
    }
  }
}

}  // namespace

VectorXd forces_at(const Runner& runner, const RollingContact& contact, double speed,
                   const VectorXd& u, const VectorXd& v, const std::vector<RailsUnder>& rails) {
  SteadyRunning at;
  at.displacement = u;
  at.rate = v;
  const auto wheels = wheel_forces(runner, contact, speed, at, rails);
  VectorXd sum = VectorXd::Zero(u.size());
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    for (const WheelForce& wheel : wheels[set])
      for (int k = 0; k < kMotions; ++k) sum[first_of(b) + k] += wheel.generalised[k];
    ++set;
  }
  return sum;
}

RailForces contacts_at(const Runner& runner, const RollingContact& contact, double speed,
                       const VectorXd& u, const VectorXd& v, const std::vector<RailsUnder>& rails) {
  RailForces sum{VectorXd::Zero(u.size()), MatrixXd::Zero(u.size(), u.size()),
                 MatrixXd::Zero(u.size(), u.size())};
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const RailsUnder under = rails.empty() ? RailsUnder{} : rails[set++];
    add_wheelset(contact, runner.bodies[b].radius, speed, under, first_of(b), u, v, sum);
  }
  return sum;
}

std::vector<std::array<WheelForce, 2>> wheel_forces(const Runner& runner,
                                                    const RollingContact& contact, double speed,
                                                    const SteadyRunning& steady,
                                                    const std::vector<RailsUnder>& rails) {
  std::vector<std::array<WheelForce, 2>> all;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const RailsUnder under = rails.empty() ? RailsUnder{} : rails[all.size()];
    std::array<WheelForce, 2> wheels;
    for (const int side : {0, 1}) {
      Rolling rolling(speed, under.grip[side]);
      rolling.keeps = true;
      double u[kMotions];
      place_over_rail(under, side, steady.displacement.data() + first_of(b), u);
      wheels[static_cast<std::size_t>(side)] = force_on_wheel(
          contact, runner.bodies[b].radius, side == 0 ? 1. : -1., rolling, {u, under.roll[side]},
          material_rates(under, runner.bodies[b].radius, first_of(b), steady.displacement,
                         steady.rate)
              .data(),
          RailRate{});
    }
    all.push_back(wheels);
  }
  return all;
}

}  // namespace railstep
