#include "offline/runner/running.h"

#include <Eigen/Dense>
#include <cmath>

#include "offline/math/hertz_depth.h"
#include "offline/math/refuse.h"
#include "offline/runner/element_matrices.h"
#include "offline/runner/rolling_slopes.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index first_of(std::size_t body) { return kMotions * static_cast<Index>(body); }

/// Forces of the rails on all wheelsets, and their derivatives.
struct Contacts {
  VectorXd force;            // [n]
  MatrixXd by_displacement;  // [n][n]
  MatrixXd by_rate;
};

/// Rates of a wheelset's material on a design line. @param first  of its coordinates
std::array<double, kMotions> material_rates(const RailsUnder& rails, double radius, Index first,
                                            const VectorXd& u, const VectorXd& v) {
  std::array<double, kMotions> rates{};
  std::copy_n(v.data() + first, kMotions, rates.begin());
  add_frame_rates(rails, radius, u.data() + first, rates.data());
  return rates;
}

void add_wheelset(const RollingContact& contact, double radius, double speed,
                  const RailsUnder& rails, Index first, const VectorXd& u, const VectorXd& v,
                  Contacts& sum) {
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

Contacts contacts_at(const Runner& runner, const RollingContact& contact, double speed,
                     const VectorXd& u, const VectorXd& v,
                     const std::vector<RailsUnder>& rails = {}) {
  Contacts sum{VectorXd::Zero(u.size()), MatrixXd::Zero(u.size(), u.size()),
               MatrixXd::Zero(u.size(), u.size())};
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const RailsUnder under = rails.empty() ? RailsUnder{} : rails[set++];
    add_wheelset(contact, runner.bodies[b].radius, speed, under, first_of(b), u, v, sum);
  }
  return sum;
}

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

}  // namespace

SteadyRunning steady_running(const Runner& runner, const RunnerMatrices& m,
                             const RollingContact& contact, double speed,
                             const std::vector<RailsUnder>& rails) {
  const Index n = m.mass.size();
  SteadyRunning s{VectorXd::Zero(n), VectorXd::Zero(n), 0., VectorXd::Zero(m.rods.cols())};
  s.displacement = first_guess(runner, m, contact, rails);
  const auto touches = [&](const SteadyRunning& tried) {
    return all_touch(runner, contact, speed, tried, rails);
  };
  // Contacts that press give Newton's method its way back.
  for (int i = 0; i < 20 && !touches(s); ++i) sink_wheelsets(runner, 2e-4, s.displacement);
  const auto left_at = [&](const SteadyRunning& at, const VectorXd& force) -> VectorXd {
    return m.rest + force + element_forces(m, at.displacement) - m.stiffness * at.displacement -
           m.damping * at.rate - m.rods * at.tension;
  };
  roll_wheelsets(runner, contact, speed, rails, s);
  constexpr int kCap = 60, kHalvings = 12;
  for (int i = 0; i < kCap; ++i) {
    const Contacts c = contacts_at(runner, contact, speed, s.displacement, s.rate, rails);
    const VectorXd left = left_at(s, c.force);
    MatrixXd J = stiffness_at(m, s.displacement) - c.by_displacement;
    for (Index k = 0; k < n; ++k)
      if (is_spin(runner, k)) J.col(k) = m.damping.col(k) - c.by_rate.col(k);
    s.resistance = -left[0];
    const StepWithRods newton(J, m);
    const VectorXd step = newton.step(left, s.displacement);
    const double change = step.head(n - 1).cwiseAbs().maxCoeff();
    if (!std::isfinite(change)) break;
    SteadyRunning next = s;
    double part = 1.;
    for (int halving = 0; halving < kHalvings; ++halving, part *= .5) {
      next = s;
      for (Index k = 1; k < n; ++k)
        (is_spin(runner, k) ? next.rate : next.displacement)[k] += part * step[k - 1];
      next.tension += part * step.tail(m.rods.cols());
      if (!touches(next)) continue;
      // The step that would follow with the same derivatives is shorter (Deuflhard).
      const VectorXd force = forces_at(runner, contact, speed, next.displacement, next.rate, rails);
      const double following =
          newton.step(left_at(next, force), next.displacement).head(n - 1).norm();
      if (following <= (1. - .25 * part) * step.head(n - 1).norm()) break;
    }
    s = std::move(next);
    if (change < 1e-11 && touches(s)) return s;
  }
  fail("E-VEHICLE-23",
       "no steady motion of the vehicle with all wheels on their rails was found; expected a "
       "suspension that holds each body in every direction, and rails that are not too uneven");
}

Running running_on(const RunningOn& on, const Runner& runner, const RunnerMatrices& matrices,
                   const RollingContact& contact, double speed) {
  if (!is_there(on.line)) return {matrices, on.rails};
  const OnLine at{on.place, speed, 0.};
  Running running{matrices, on.rails};
  set_frame_rates(on.line, at, runner, running.rails);
  // Forces depend on motions by the angles between frames, so that each pass is much closer.
  constexpr int kPasses = 40;
  VectorXd u = VectorXd::Zero(matrices.mass.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    running.matrices = matrices_on(on.line, at, runner, matrices, on.gravity, u);
    const VectorXd found =
        steady_running(runner, running.matrices, contact, speed, running.rails).displacement;
    const double change = (found - u).cwiseAbs().maxCoeff();
    u = found;
    if (change < 1e-12) break;
  }
  return running;
}

namespace {

/// Adds the derivatives of one wheel's force over the motions of the seat under it, and those of
/// the force on the seat.
/// @param first, seat  coordinates of the wheelset and of the seat
void add_seat(const WheelSlopes& slopes, Index first, Index seat, LinearRunning& linear) {
  // Over y, z and roll of the seat; the wheel's place counts over the rail.
  const auto add = [&](Index row, int k, double factor) {
    for (int j = 0; j < 2; ++j) {
      linear.stiffness(row, seat + j) += factor * slopes.by_motion[k][j];
      linear.damping(row, seat + j) += factor * slopes.by_rate[k][1 + j];
    }
    linear.stiffness(row, seat + 2) -= factor * slopes.by_section[k];
    linear.damping(row, seat + 2) -= factor * slopes.by_section_rate[k];
  };
  for (int k = 0; k < kMotions; ++k) add(first + k, k, 1.);
  constexpr int kForces[3] = {1, 2, 6};  // along y and z, and the moment on the section
  constexpr double factor[3] = {-1., -1., 1.};
  for (int d = 0; d < 3; ++d) {
    add(seat + d, kForces[d], factor[d]);
    for (int j = 0; j < 4; ++j)
      linear.stiffness(seat + d, first + index_of(kPlaced[j])) -=
          factor[d] * slopes.by_motion[kForces[d]][j];
    for (int j = 0; j < kMotions; ++j)
      linear.damping(seat + d, first + j) -= factor[d] * slopes.by_rate[kForces[d]][j];
  }
}

/// Changes the last coordinates, those of the seats, to their modes on the track alone.
void take_modes(const StandingTrack& track, LinearRunning& linear) {
  const Index seats = track.mass.rows(), n = linear.mass.size();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(track.stiffness, track.mass);
  MatrixXd change = MatrixXd::Identity(n, n);
  change.bottomRightCorner(seats, seats) = modes.eigenvectors();
  linear.stiffness = change.transpose() * linear.stiffness * change;
  linear.damping = change.transpose() * linear.damping * change;
  linear.mass.tail(seats).setOnes();
}

/// The motions of rails that give way, beside those of a vehicle.
void add_track(const Runner& runner, const RollingContact& contact, double speed,
               const SteadyRunning& steady, const RunningOn& on, LinearRunning& linear) {
  const StandingTrack& track = *on.track;
  const Index n = linear.mass.size(), seats = track.mass.rows();
  linear.mass.conservativeResize(n + seats);
  for (MatrixXd* A : {&linear.stiffness, &linear.damping}) {
    A->conservativeResize(n + seats, n + seats);
    A->rightCols(seats).setZero();
    A->bottomRows(seats).setZero();
  }
  for (RunnerMatrices::Series& own : linear.series) {
    own.row.conservativeResize(n + seats);
    own.row.tail(seats).setZero();
  }
  linear.rods.conservativeResize(n + seats, Eigen::NoChange);
  linear.rods.bottomRows(seats).setZero();
  Index seat = n;
  std::size_t set = 0;
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    if (!runner.bodies[b].is_wheelset()) continue;
    const RailsUnder under = on.rails.empty() ? RailsUnder{} : on.rails[set++];
    for (const int side : {0, 1}) {
      double u[kMotions];
      place_over_rail(under, side, steady.displacement.data() + first_of(b), u);
      WheelSlopes slopes;
      static_cast<void>(force_on_wheel(contact, runner.bodies[b].radius, side == 0 ? 1. : -1.,
                                       {speed, under.grip[side]}, {u, under.roll[side]},
                                       material_rates(under, runner.bodies[b].radius, first_of(b),
                                                      steady.displacement, steady.rate)
                                           .data(),
                                       slopes));
      add_seat(slopes, first_of(b), seat, linear);
      seat += 3;
    }
  }
  linear.stiffness.rightCols(seats) -= speed * linear.damping.rightCols(seats) * track.slope;
  linear.stiffness.bottomRightCorner(seats, seats) += track.stiffness;
  linear.damping.bottomRightCorner(seats, seats) += track.damping;
  take_modes(track, linear);
}

}  // namespace

LinearRunning linear_running(const Runner& runner, const RunnerMatrices& m,
                             const RollingContact& contact, double speed,
                             const SteadyRunning& steady, const RunningOn& on) {
  const Contacts c =
      contacts_at(runner, contact, speed, steady.displacement, steady.rate, on.rails);
  LinearRunning linear{m.mass, damping_at_rest(m) - c.by_rate,
                       sticking_stiffness_at(m, steady.displacement) - c.by_displacement, m.series,
                       m.rods};
  for (std::size_t b = 0; b < runner.bodies.size(); ++b) {
    const RunnerBody& body = runner.bodies[b];
    if (!body.is_wheelset()) continue;
    const double spin = body.inertia[1] * speed / body.radius;
    const Index roll = first_of(b) + index_of(BodyMotion::roll),
                yaw = first_of(b) + index_of(BodyMotion::yaw);
    linear.damping(roll, yaw) -= spin;
    linear.damping(yaw, roll) += spin;
  }
  if (on.track) add_track(runner, contact, speed, steady, on, linear);
  return linear;
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
