#include "offline/runner/running.h"

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
/// A number with its derivatives over the six motions of a wheelset and their rates.
using Derived = Eigen::AutoDiffScalar<Eigen::Matrix<double, 2 * kMotions, 1>>;

Index first_of(std::size_t body) { return kMotions * static_cast<Index>(body); }

/// Forces of the rails on all wheelsets, and their derivatives.
struct Contacts {
  VectorXd force;            // [n]
  MatrixXd by_displacement;  // [n][n]
  MatrixXd by_rate;
};

void add_wheelset(const RollingContact& contact, double radius, double speed, Index first,
                  const VectorXd& u, const VectorXd& v, Contacts& sum) {
  Derived motion[kMotions], rate[kMotions];
  for (int k = 0; k < kMotions; ++k) {
    motion[k] = Derived(u[first + k], 2 * kMotions, k);
    rate[k] = Derived(v[first + k], 2 * kMotions, kMotions + k);
  }
  for (const double side : {1., -1.}) {
    const WheelForce<Derived> f = wheel_force(contact, radius, side, speed, motion, rate);
    for (int k = 0; k < kMotions; ++k) {
      sum.force[first + k] += f.generalised[k].value();
      for (int j = 0; j < kMotions; ++j) {
        sum.by_displacement(first + k, first + j) += f.generalised[k].derivatives()[j];
        sum.by_rate(first + k, first + j) += f.generalised[k].derivatives()[kMotions + j];
      }
    }
  }
}

Contacts contacts_at(const Runner& runner, const RollingContact& contact, double speed,
                     const VectorXd& u, const VectorXd& v) {
  Contacts sum{VectorXd::Zero(u.size()), MatrixXd::Zero(u.size(), u.size()),
               MatrixXd::Zero(u.size(), u.size())};
  for (std::size_t b = 0; b < runner.bodies.size(); ++b)
    if (runner.bodies[b].is_wheelset())
      add_wheelset(contact, runner.bodies[b].radius, speed, first_of(b), u, v, sum);
  return sum;
}

/// How far the wheels sink under the weight.
double sunk(const Runner& runner, const RunnerMatrices& m, const RollingContact& contact) {
  double weight = 0., wheels = 0.;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    weight -= m.rest[first_of(b) + at(BodyMotion::z)];
    wheels += runner.bodies[b].is_wheelset() ? 2. : 0.;
  }
  return std::pow(weight / wheels / contact.hertz, 2. / 3.);
}

/// A moment about the axle stops a spin's motion, so its rate is sought in place of its angle.
bool is_spin(const Runner& runner, Index k) {
  return k % kMotions == at(BodyMotion::pitch) &&
         runner.bodies[static_cast<std::size_t>(k / kMotions)].is_wheelset();
}

}  // namespace

SteadyRunning steady_running(const Runner& runner, const RunnerMatrices& m,
                             const RollingContact& contact, double speed) {
  const Index n = m.mass.size();
  SteadyRunning s{VectorXd::Zero(n), VectorXd::Zero(n), 0.};
  for (Index k = at(BodyMotion::z); k < n; k += kMotions)
    s.displacement[k] = -sunk(runner, m, contact);
  constexpr int kCap = 60;
  for (int i = 0; i < kCap; ++i) {
    const Contacts c = contacts_at(runner, contact, speed, s.displacement, s.rate);
    const VectorXd left = m.rest + c.force - m.stiffness * s.displacement - m.damping * s.rate;
    MatrixXd J = m.stiffness - c.by_displacement;
    for (Index k = 0; k < n; ++k)
      if (is_spin(runner, k)) J.col(k) = m.damping.col(k) - c.by_rate.col(k);
    s.resistance = -left[0];
    const VectorXd step = J.bottomRightCorner(n - 1, n - 1).partialPivLu().solve(left.tail(n - 1));
    for (Index k = 1; k < n; ++k) (is_spin(runner, k) ? s.rate : s.displacement)[k] += step[k - 1];
    const double change = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(change)) break;
    if (change < 1e-11) return s;
  }
  fail("E-VEHICLE-23",
       "no steady motion of the vehicle was found; expected a suspension that holds each body in "
       "every direction");
}

LinearRunning linear_running(const Runner& runner, const RunnerMatrices& m,
                             const RollingContact& contact, double speed,
                             const SteadyRunning& steady) {
  const Contacts c = contacts_at(runner, contact, speed, steady.displacement, steady.rate);
  LinearRunning linear{m.mass, m.damping - c.by_rate, m.stiffness - c.by_displacement, m.series};
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    const RunnerBody& body = runner.bodies[b];
    if (!body.is_wheelset()) continue;
    const double spin = body.inertia[1] * speed / body.radius;
    const Index roll = first_of(b) + at(BodyMotion::roll), yaw = first_of(b) + at(BodyMotion::yaw);
    linear.damping(roll, yaw) -= spin;
    linear.damping(yaw, roll) += spin;
  }
  return linear;
}

std::vector<std::array<WheelForce<double>, 2>> wheel_forces(const Runner& runner,
                                                            const RollingContact& contact,
                                                            double speed,
                                                            const SteadyRunning& steady) {
  std::vector<std::array<WheelForce<double>, 2>> all;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const double* u = steady.displacement.data() + first_of(b);
    const double* v = steady.rate.data() + first_of(b);
    const double radius = runner.bodies[b].radius;
    all.push_back({wheel_force(contact, radius, 1., speed, u, v),
                   wheel_force(contact, radius, -1., speed, u, v)});
  }
  return all;
}

}  // namespace railstep
