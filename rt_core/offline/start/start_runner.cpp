#include "offline/start/start_runner.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "offline/runner/element_matrices.h"
#include "online/contact/wheel_seat.h"
#include "online/model/progress.h"
#include "online/runner/force_elements.h"
#include "online/step/step.h"
#include "online/track/travel.h"

namespace railstep {

namespace {

double first_speed(const RunnerModel& runner) {
  return travelled(runner.travel, 0.).speed + runner.start_speed;
}
/// Where a runner is at a time from now on.
AlongTrack place_at(const RunnerModel& runner, double time) {
  return {0, -time, runner.start_speed * time};
}

/// A runner on rails as they lie at a time from now on, and on its design line.
Running running_here(const Model& model, const RunnerModel& runner, const PackedRunner& own,
                     double time, std::vector<RailsUnder> rails) {
  RunningOn on{std::move(rails), std::nullopt, model.design_line};
  if (is_there(on.line)) {
    on.place = on_line(model, runner, place_at(runner, time)).place;
    on.gravity = runner.frames.gravity;
  }
  return running_on(on, own.vehicle.runner, own.matrices, own.vehicle.contact, first_speed(runner));
}

/// Lets a runner run steadily.
void settle(const RunnerModel& runner, const PackedRunner& own, const Running& here,
            SettledRunners& settled) {
  const double speed = first_speed(runner);
  const SteadyRunning& steady = settled.steady.emplace_back(
      steady_running(own.vehicle.runner, here.matrices, own.vehicle.contact, speed, here.rails));
  for (const auto& wheels :
       wheel_forces(own.vehicle.runner, own.vehicle.contact, speed, steady, here.rails))
    settled.wheels.push_back(wheels);
}

/// The seat under one wheel, at a time from now on.
struct StaticSeat {
  WheelSeatRow row[kWheelSeatRows];
  RailForce place[kWheelSeatRows];
};
StaticSeat seat_of(const Model& model, const RunnerModel& runner, int wheelset, int side,
                   const Configuration& at, double time) {
  StaticSeat seat;
  SeatMotions motions;
  locate_wheel_seat(model, at, runner,
                    element_place(model, runner, wheelset, place_at(runner, time)), side, motions,
                    seat.row, seat.place);
  return seat;
}

double moved_by(const Model& model, const WheelSeatRow& seat, const Configuration& at) {
  double sum = seat.rise;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], seat.row, at);
  return sum;
}

/// Yaw at which wheelsets roll along uneven rails, rad.
double rolling_yaw(const Model& model, const RunnerModel& runner, int wheelset, double time) {
  const double speed = first_speed(runner), span = 1e-5;
  if (speed == 0. || model.signals == 0) return 0.;
  const auto middle = [&](double at) {
    const RailsUnder under = rails_under(model, runner, wheelset, place_at(runner, time + at));
    return .5 * (under.y[0] + under.y[1]);
  };
  return (middle(span) - middle(-span)) / (2. * span * speed);
}

/// Deflections of the dampers that are in series with springs, whose forces are 0.
std::vector<double> series_of(const RunnerMatrices& m, const Eigen::VectorXd& u) {
  std::vector<double> all;
  for (const RunnerMatrices::Series& series : m.series)
    all.push_back(series.row.dot(u) + series.moved);
  return all;
}

/// Moves each wheelset to the middle of its uneven rails, and the other bodies with them.
void follow_alignment(const RunnerMatrices& m, const Model& model, const RunnerModel& runner,
                      double time, SteadyRunning& steady) {
  const Eigen::Index n = m.mass.size();
  Eigen::VectorXd given = Eigen::VectorXd::Zero(n);
  std::vector<bool> is_given(static_cast<std::size_t>(n), false);
  is_given[0] = true;  // x of the first body
  for (int i = 0; i < runner.wheelsets; ++i) {
    const RailsUnder under = rails_under(model, runner, i, place_at(runner, time));
    const Eigen::Index first = runner.wheelset[i].first;
    for (int k = 0; k < kMotions; ++k) is_given[static_cast<std::size_t>(first + k)] = true;
    given[first + index_of(BodyMotion::y)] = .5 * (under.y[0] + under.y[1]);
    given[first + index_of(BodyMotion::yaw)] = rolling_yaw(model, runner, i, time);
  }
  // Bump stops may begin to press, or let go.
  constexpr int kIterations = 20;
  const Eigen::VectorXd before = steady.displacement, held = element_forces(m, before);
  Eigen::VectorXd moved = given, more = Eigen::VectorXd::Zero(m.rods.cols());
  const Eigen::Index rods = m.rods.cols();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + rods, n + rods);
    K.topLeftCorner(n, n) = stiffness_at(m, before + moved);
    K.topRightCorner(n, rods) = m.rods;
    K.bottomLeftCorner(rods, n) = m.rods.transpose();
    Eigen::VectorXd force(n + rods);
    force.head(n) = element_forces(m, before + moved) - held - m.stiffness * moved - m.rods * more;
    force.tail(rods) = -m.rods.transpose() * moved;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (!is_given[static_cast<std::size_t>(k)]) continue;
      K.row(k).setZero();
      K.col(k).setZero();
      K(k, k) = 1.;
      force[k] = 0.;
    }
    const Eigen::VectorXd solved = K.fullPivLu().solve(force), step = solved.head(n);
    moved += step;
    more += solved.tail(rods);
    if (m.force_elements.empty() || step.cwiseAbs().maxCoeff() < 1e-14) break;
  }
  steady.displacement += moved;
  steady.tension += more;
}

}  // namespace

SettledRunners runners_on_even_rails(const PackedModel& packed) {
  SettledRunners settled;
  const Model& model = packed.model();
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    const PackedRunner& own = packed.runners()[static_cast<std::size_t>(r)];
    std::vector<RailsUnder> rails(static_cast<std::size_t>(runner.wheelsets));
    for (int i = 0; i < runner.wheelsets; ++i)
      std::copy_n(rails_under(model, runner, i, place_at(runner, 0.)).grip, 2,
                  rails[static_cast<std::size_t>(i)].grip);
    settle(runner, own, running_here(model, runner, own, 0., std::move(rails)), settled);
  }
  return settled;
}

void add_forces(const PackedModel& packed, const SettledRunners& runners, const Configuration& at,
                double time, Acting& acting) {
  const Model& model = packed.model();
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    const auto set = static_cast<std::size_t>(runner.first_wheelset);
    for (int i = 0; i < runner.wheelsets; ++i)
      for (int side = 0; side < 2; ++side) {
        const StaticSeat seat = seat_of(model, runner, i, side, at, time);
        if (!seat.row[0].on_rail) continue;
        const WheelForce& f =
            runners.wheels[set + static_cast<std::size_t>(i)][static_cast<std::size_t>(side)];
        acting.contacts.push_back({seat.row[0].row, -f.generalised[1]});
        acting.contacts.push_back({seat.row[1].row, -f.generalised[2]});
        acting.contacts.push_back({seat.row[2].row, f.on_section});
        RailForce place = seat.place[1];
        place.force = -f.generalised[2];
        acting.ports.push_back(place);
      }
  }
}

Eigen::VectorXd constraint_forces_of_acceleration(const RunnerModel& r, double time) {
  const double a = travelled(r.travel, time).acceleration;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(constraint_count(r), r.size);
  rows(0, 0) = 1.;
  for (std::int32_t i = 0; i < r.rods; ++i)
    rows.row(1 + i) = Eigen::Map<const Eigen::RowVectorXd>(
        r.rod_row + static_cast<std::ptrdiff_t>(i) * r.size, r.size);
  Eigen::VectorXd per_mass = Eigen::VectorXd::Zero(r.size), frames = per_mass;
  for (std::int32_t k = 0; k < kMotions * r.bodies; ++k) per_mass[k] = 1. / r.mass[k];
  for (std::int32_t b = 0; b < r.bodies; ++b) frames[kMotions * b] = -a;
  for (std::int32_t i = 0; i < r.wheelsets; ++i)
    frames[r.wheelset[i].first + index_of(BodyMotion::pitch)] = -a / r.wheelset[i].radius;
  // rows M^-1 (M frames + rows' force) = 0
  Eigen::VectorXd force =
      (rows * per_mass.asDiagonal() * rows.transpose()).ldlt().solve(-(rows * frames));
  force.tail(r.rods) = -force.tail(r.rods).eval();  // rows are elongations
  return force;
}

SettledRunners settle_runners(const PackedModel& packed, const SettledRunners& pressing,
                              const Configuration& at, double time, const Acting& acting,
                              std::size_t first_port) {
  const Model& model = packed.model();
  SettledRunners settled;
  for (std::int32_t r = 0; r < model.runners; ++r) {
    const RunnerModel& runner = model.runner[r];
    const PackedRunner& own = packed.runners()[static_cast<std::size_t>(r)];
    std::vector<RailsUnder> rails;
    for (int i = 0; i < runner.wheelsets; ++i) {
      const RailsUnder uneven = rails_under(model, runner, i, place_at(runner, time));
      RailsUnder& under = rails.emplace_back(RailsUnder{});
      for (int side = 0; side < 2; ++side) {
        under.z[side] = uneven.z[side];
        under.grip[side] = uneven.grip[side];
        // Alignment is followed; the gauge is not.
        under.y[side] = uneven.y[side] - .5 * (uneven.y[0] + uneven.y[1]);
        const StaticSeat seat = seat_of(model, runner, i, side, at, time);
        if (!seat.row[0].on_rail) continue;
        const std::int32_t of_all = runner.first_wheelset + i;
        const auto set = static_cast<std::size_t>(of_all);
        double force[kWheelForces];
        keep_wheel_force(pressing.wheels[set][static_cast<std::size_t>(side)], force);
        const SeatFlexibility gives = seat_flexibility_beside(model, runner, side, seat.place[1]);
        under.y[side] += moved_by(model, seat.row[0], at) + moved_by_wheel(gives.along[0], force);
        under.roll[side] = moved_by(model, seat.row[2], at) + moved_by_wheel(gives.along[2], force);
        under.z[side] +=
            moved_by(model, seat.row[1], at) + moved_by_wheel(gives.along[1], force) +
            residual_displacement(model, acting.ports.data(), static_cast<int>(acting.ports.size()),
                                  static_cast<int>(first_port++));
      }
    }
    const Running here = running_here(model, runner, own, time, std::move(rails));
    settle(runner, own, here, settled);
    follow_alignment(here.matrices, model, runner, time, settled.steady.back());
    settled.series.push_back(series_of(here.matrices, settled.steady.back().displacement));
  }
  return settled;
}

void put_seats(const Model& model, State& state) {
  if (!keeps_seats(model)) return;
  const Configuration at{state.u, {state.u, state.v}, track_offset(model, 0)};
  Outputs outputs{};
  publish_start(model, state, outputs);
  RailForce force[kMaxRailForces];
  const int forces = rail_forces(model, outputs, force);
  // Those of the runners' wheels are the last ones.
  int wheel = forces -
              static_cast<int>(std::count(
                  outputs.wheel_on_rail, outputs.wheel_on_rail + 2 * model.runner_wheelsets, true));
  for (std::int32_t r = 0; r < model.runners; ++r)
    for (int i = 0; i < model.runner[r].wheelsets; ++i)
      for (int side = 0; side < 2; ++side) {
        const RunnerModel& runner = model.runner[r];
        const std::int32_t set = runner.first_wheelset + i;
        double* const kept = seat_motion_of(state, set, side);
        std::fill_n(kept, kSeatMotions, 0.);
        const StaticSeat seat = seat_of(model, runner, i, side, at, 0.);
        if (!seat.row[0].on_rail) continue;
        const SeatFlexibility gives = seat_flexibility(model, runner, side, seat.place[1]);
        for (int k = 0; k < kWheelSeatRows; ++k)
          kept[k] = moved_by(model, seat.row[k], at) +
                    moved_by_wheel(gives.along[k], wheel_force_of(state, set, side));
        for (int j = 0; j < forces; ++j)
          if (j != wheel)
            kept[1] += force[j].force * residual_between(model, force[j], seat.place[1]);
        ++wheel;
      }
}

void start_elements(const Model& model, const RunnerModel& runner, State& state) {
  std::vector<double> pose(kMostPoses);
  const double* const poses = poses_of(model, runner, along_in(runner, state), pose.data());
  for (std::int32_t j = 0; j < runner.force_elements; ++j) {
    const ForceElement& e = runner.force_element[j];
    double* const memory = state.element_memory + e.memory;
    std::fill_n(memory, memory_of(e.law), 0.);
    const StandingElement at = standing_element(model, runner, j, state, poses);
    if (is_brake(e))
      memory[0] = at.z;
    else
      keep_element(e, at.step, at.from_memory, at.load, memory);
  }
}

}  // namespace railstep
