#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "offline/math/hertz_depth.h"
#include "offline/math/refuse.h"
#include "offline/runner/element_matrices.h"
#include "offline/runner/running_contacts.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How far the wheels sink under the weight.
double sunk(const Runner& runner, const RunnerMatrices& m, const RollingContact& contact) {
  double weight = 0., wheels = 0.;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    weight -= m.rest[first_of(b) + index_of(BodyMotion::z)];
    wheels += runner.bodies[b].is_wheelset() ? 2. : 0.;
  }
  return hertz_depth(weight / wheels, contact.hertz);
}

/// The vehicle sunk into its contacts, each wheelset in the middle of its rails.
VectorXd first_guess(const Runner& runner, const RunnerMatrices& m, const RollingContact& contact,
                     const std::vector<RailsUnder>& rails) {
  VectorXd u = VectorXd::Zero(m.mass.size());
  const double depth = sunk(runner, m, contact);
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    double* const own = u.data() + first_of(b);
    own[index_of(BodyMotion::z)] = -depth;
    if (rails.empty() || !runner.bodies[b].is_wheelset()) continue;
    const RailsUnder& under = rails[set++];
    own[index_of(BodyMotion::y)] += .5 * (under.y[0] + under.y[1]);
    own[index_of(BodyMotion::z)] += .5 * (under.z[0] + under.z[1]);
    const double roll = .5 * (under.z[0] - under.z[1]) / contact.half_distance;
    own[index_of(BodyMotion::roll)] = roll;
    // The treads stay over the crowns.
    own[index_of(BodyMotion::y)] -= (runner.bodies[b].radius + contact.crown_radius) * roll;
  }
  return u;
}

bool all_touch(const Runner& runner, const RollingContact& contact, double speed,
               const SteadyRunning& steady, const std::vector<RailsUnder>& rails) {
  for (const auto& wheelset : wheel_forces(runner, contact, speed, steady, rails))
    for (const WheelForce& wheel : wheelset)
      if (!(wheel.normal > 0.)) return false;
  return true;
}

void sink_wheelsets(const Runner& runner, double by, VectorXd& u) {
  for (std::size_t b = 0; b < runner.bodies.size(); ++b)
    if (runner.bodies[b].is_wheelset()) u[first_of(b) + index_of(BodyMotion::z)] -= by;
}

/// Lets each wheelset roll where it touches: creep of wheels that slide has hardly a slope.
/// Profiles may touch far from the tread's datum, where the radius is another one.
void roll_wheelsets(const Runner& runner, const RollingContact& contact, double speed,
                    const std::vector<RailsUnder>& rails, SteadyRunning& s) {
  constexpr double kMost = .1;  // of a wheelset's spin
  constexpr int kBisections = 40;
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    double& spin = s.rate[first_of(b) + index_of(BodyMotion::pitch)];
    const auto moment_at = [&](double rate) {
      spin = rate;
      double moment = 0.;
      const auto wheels = wheel_forces(runner, contact, speed, s, rails);
      for (const WheelForce& wheel : wheels[set])
        moment += wheel.generalised[index_of(BodyMotion::pitch)];
      return moment;
    };
    const double most = kMost * std::fabs(speed) / runner.bodies[b].radius;
    double low = -most, high = most;
    const bool turns = moment_at(low) > 0. && moment_at(high) < 0.;
    for (int i = 0; i < kBisections && turns; ++i) {
      const double moment = moment_at(.5 * (low + high));
      (moment > 0. ? low : high) = spin;
    }
    if (!turns) spin = 0.;
    ++set;
  }
}

/// A moment about the axle stops a spin's motion, so its rate is sought in place of its angle.
bool is_spin(const Runner& runner, Index k) {
  return k % kMotions == index_of(BodyMotion::pitch) &&
         runner.bodies[static_cast<std::size_t>(k / kMotions)].is_wheelset();
}

/// Newton's steps of all coordinates but the first, then of the tensions of rods.
class StepWithRods {
 public:
  StepWithRods(const MatrixXd& J, const RunnerMatrices& m)
      : rods_(m.rods), moved_(m.rods_moved), scale_(J.diagonal().cwiseAbs().maxCoeff()) {
    const Index n = J.rows() - 1, held = rods_.cols();
    MatrixXd A = MatrixXd::Zero(n + held, n + held);
    A.topLeftCorner(n, n) = J.bottomRightCorner(n, n);
    A.topRightCorner(n, held) = scale_ * rods_.bottomRows(n);
    A.bottomLeftCorner(held, n) = scale_ * rods_.bottomRows(n).transpose();
    solver_.compute(A);
  }
  VectorXd step(const VectorXd& left, const VectorXd& u) const {
    const Index n = left.size() - 1, held = rods_.cols();
    VectorXd b(n + held);
    b.head(n) = left.tail(n);
    b.tail(held) = -scale_ * (rods_.transpose() * u + moved_);
    VectorXd step = solver_.solve(b);
    step.tail(held) *= scale_;
    return step;
  }

 private:
  const MatrixXd& rods_;
  const VectorXd& moved_;
  double scale_;
  Eigen::PartialPivLU<MatrixXd> solver_;
};

/// Newton's method for a vehicle that runs steadily on rails.
class SteadySearch {
 public:
  SteadySearch(const Runner& runner, const RunnerMatrices& m, const RollingContact& contact,
               double speed, const std::vector<RailsUnder>& rails)
      : runner_(runner), m_(m), contact_(contact), speed_(speed), rails_(rails) {}

  /// @param hold  1/s2: masses times this lead the vehicle to where it runs, less in each iteration
  ///              and in the end not at all. It then finds flanks that Newton's method by itself
  ///              leaps over.
  /// @param farthest  m, rad and rad/s: more is held again where a step would go farther
  std::optional<SteadyRunning> find(double hold, double farthest) const {
    constexpr int kCap = 120;
    constexpr double kLess = .8, kMore = 8., kFree = 1.;
    SteadyRunning s = start();
    for (int i = 0; i < kCap; ++i) {
      SteadyRunning next = s;
      const double change = improve(hold, next);
      if (!std::isfinite(change)) break;
      if (change > farthest || (farthest < HUGE_VAL && !touches(next))) {
        hold = kMore * std::max(hold, kFree);
        continue;
      }
      s = std::move(next);
      if (hold == 0. && change < 1e-11 && touches(s)) return s;
      hold = kLess * hold > kFree ? kLess * hold : 0.;
    }
    return std::nullopt;
  }

 private:
  bool touches(const SteadyRunning& tried) const {
    return all_touch(runner_, contact_, speed_, tried, rails_);
  }
  SteadyRunning start() const {
    const Index n = m_.mass.size();
    SteadyRunning s{first_guess(runner_, m_, contact_, rails_), VectorXd::Zero(n), 0.,
                    VectorXd::Zero(m_.rods.cols())};
    // Contacts that press give Newton's method its way back.
    for (int i = 0; i < 20 && !touches(s); ++i) sink_wheelsets(runner_, 2e-4, s.displacement);
    roll_wheelsets(runner_, contact_, speed_, rails_, s);
    return s;
  }
  VectorXd left_at(const SteadyRunning& at, const VectorXd& force) const {
    return m_.rest + force + element_forces(m_, at.displacement) - m_.stiffness * at.displacement -
           m_.damping * at.rate - m_.rods * at.tension;
  }
  MatrixXd slopes_at(const SteadyRunning& s, const RailForces& c, double hold) const {
    MatrixXd J = stiffness_at(m_, s.displacement) - c.by_displacement;
    for (Index k = 0; k < J.rows(); ++k) {
      const bool spins = is_spin(runner_, k);
      if (spins) J.col(k) = m_.damping.col(k) - c.by_rate.col(k);
      J(k, k) += m_.mass[k] * (spins ? std::sqrt(hold) : hold);
    }
    return J;
  }
  /// The motions after a part of a step.
  SteadyRunning moved(const SteadyRunning& from, const VectorXd& step, double part) const {
    SteadyRunning next = from;
    const Index n = m_.mass.size();
    for (Index k = 1; k < n; ++k)
      (is_spin(runner_, k) ? next.rate : next.displacement)[k] += part * step[k - 1];
    next.tension += part * step.tail(m_.rods.cols());
    return next;
  }
  /// One step, of which it takes such a part that the wheels touch. @returns the size of all of it
  double improve(double hold, SteadyRunning& s) const {
    constexpr int kHalvings = 12;
    const Index n = m_.mass.size();
    const RailForces c = contacts_at(runner_, contact_, speed_, s.displacement, s.rate, rails_);
    const VectorXd left = left_at(s, c.force);
    s.resistance = -left[0];
    const StepWithRods newton(slopes_at(s, c, hold), m_);
    const VectorXd step = newton.step(left, s.displacement);
    SteadyRunning next = s;
    double part = 1.;
    for (int halving = 0; halving < kHalvings; ++halving, part *= .5) {
      next = moved(s, step, part);
      if (!touches(next)) continue;
      if (hold > 0.) break;
      // The step that would follow with the same derivatives is shorter (Deuflhard).
      const VectorXd force =
          forces_at(runner_, contact_, speed_, next.displacement, next.rate, rails_);
      const double following =
          newton.step(left_at(next, force), next.displacement).head(n - 1).norm();
      if (following <= (1. - .25 * part) * step.head(n - 1).norm()) break;
    }
    s = std::move(next);
    return step.head(n - 1).cwiseAbs().maxCoeff();
  }

  const Runner& runner_;
  const RunnerMatrices& m_;
  const RollingContact& contact_;
  double speed_;
  const std::vector<RailsUnder>& rails_;
};

}  // namespace

SteadyRunning steady_running(const Runner& runner, const RunnerMatrices& m,
                             const RollingContact& contact, double speed,
                             const std::vector<RailsUnder>& rails) {
  constexpr double kLed = 1e5, kFar = .1;  // 1/s2; m, rad and rad/s
  constexpr std::pair<double, double> kWays[] = {
      {0., HUGE_VAL}, {kLed, HUGE_VAL}, {.1 * kLed, HUGE_VAL}, {kLed, kFar}};
  const SteadySearch search(runner, m, contact, speed, rails);
  for (const auto& [hold, farthest] : kWays)
    if (std::optional<SteadyRunning> found = search.find(hold, farthest)) return *std::move(found);
  fail("E-VEHICLE-23",
       "no steady motion of the vehicle with all wheels on their rails was found; expected a "
       "suspension that holds each body in every direction, and rails that are not too uneven");
}

}  // namespace railstep
