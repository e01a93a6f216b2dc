#include "offline/runner/running.h"

#include <Eigen/Dense>
#include <cmath>

#include "offline/runner/element_matrices.h"
#include "offline/runner/rolling_slopes.h"
#include "offline/runner/running_contacts.h"

namespace railstep {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
  running.matrices.turned = turned_stiffness(on.line, at, runner, u);
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
  const RailForces c =
      contacts_at(runner, contact, speed, steady.displacement, steady.rate, on.rails);
  LinearRunning linear{m.mass, damping_at_rest(m) - c.by_rate,
                       sticking_stiffness_at(m, steady.displacement) - c.by_displacement, m.series,
                       m.rods};
  if (m.turned.size() > 0) linear.stiffness += m.turned;
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

}  // namespace railstep
