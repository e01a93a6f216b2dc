#include "offline/start/standing_track.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "offline/math/refuse.h"
#include "offline/start/static_lines.h"
#include "online/contact/wheel_seat.h"
#include "online/model/progress.h"
#include "online/runner/runner_contact.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPlaces = 8;  // in a bay

/// The seats under all wheels of a runner, and their vertical forces.
struct Seats {
  std::vector<WheelSeatRow> row;
  std::vector<RailForce> place;
};
/// @param ahead  of where the vehicle stands, m
Seats seats_of(const Model& model, const RunnerModel& runner, const State& start, double ahead) {
  const Configuration at{start.u, {start.u, start.v}, track_offset(model, 0)};
  Seats all;
  for (int i = 0; i < runner.wheelsets; ++i) {
    SeatMotions motions;
    const double x = element_place(model, runner, i, 0, 0.) + ahead;
    for (int side = 0; side < 2; ++side) {
      WheelSeatRow row[kWheelSeatRows];
      RailForce place[kWheelSeatRows];
      locate_wheel_seat(model, at, runner, x, side, motions, row, place);
      if (!row[0].on_rail)
        refuse("E-RUNNER-26",
               "a wheel of a vehicle stands " + std::to_string(x) +
                   " m along the rails, which do not reach there; expected rails under all of its "
                   "wheels, and a bay ahead of each");
      all.row.insert(all.row.end(), row, row + kWheelSeatRows);
      all.place.push_back(place[1]);
      all.place.back().force = -wheel_force_of(start, runner.first_wheelset + i, side)[2];
    }
  }
  return all;
}

/// The lines of a model, one-sided supports as springs.
std::vector<Line> lines_of(const PackedModel& packed, const Track& track) {
  std::vector<Line> all = assemble(linear_about_rest(track)), lines;
  for (const PackedLine& own : packed.lines()) lines.push_back(std::move(all[own.index]));
  return lines;
}

/// Stiffness of a line with what the wheel loads take from it where the rails roll over their seats
/// (p_delta.h): the sum of q lever roll^2 / 2 over the seats around each wheel is energy.
Eigen::SparseMatrix<double> loaded_stiffness(const Model& model, const Line& line,
                                             const Seats& seats) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t wheel = 0; wheel < seats.place.size(); ++wheel) {
    const RailForce& at = seats.place[wheel];
    RailRow row{};
    row.rail = static_cast<std::int32_t>(wheel % 2);
    row.element = at.element;
    const SeatLevers around = seat_levers(model, row.rail, at.element, at.xi);
    row.seats = 1;
    row.lever[0] = 1.;
    for (std::int32_t i = 0; i < around.count; ++i) {
      row.seat[0] = around.node[i];
      const Eigen::SparseVector<double> roll = contact_row(line, row, true).sparseView();
      for (Eigen::SparseVector<double>::InnerIterator x(roll); x; ++x)
        for (Eigen::SparseVector<double>::InnerIterator y(roll); y; ++y)
          entries.emplace_back(static_cast<int>(x.index()), static_cast<int>(y.index()),
                               -at.force * around.lever[i] * x.value() * y.value());
    }
  }
  Eigen::SparseMatrix<double> taken(line.unknowns(), line.unknowns());
  taken.setFromTriplets(entries.begin(), entries.end());
  return line.stiffness + taken;
}

/// The track condensed to its seats.
StandingTrack condensed_to(const Model& model, const std::vector<Line>& lines, const Seats& seats) {
  const auto n = static_cast<Index>(seats.row.size());
  MatrixXd flexibility = MatrixXd::Zero(n, n);
  std::vector<MatrixXd> moved;  // by unit forces
  for (const Line& line : lines) {
    MatrixXd rows(line.unknowns(), n);
    for (Index i = 0; i < n; ++i)
      rows.col(i) = contact_row(line, seats.row[static_cast<std::size_t>(i)].row, true);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> stiffness(
        loaded_stiffness(model, line, seats));
    moved.push_back(stiffness.solve(rows));
    flexibility += rows.transpose() * moved.back();
  }
  const MatrixXd stiffness = flexibility.inverse();
  StandingTrack track{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), stiffness};
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const MatrixXd shape = moved[l] * stiffness;  // by unit displacements
    track.mass += shape.transpose() * (lines[l].mass * shape);
    track.damping += shape.transpose() * (lines[l].damping * shape);
  }
  return track;
}

/// The springs by which a vertical force on a section that rolls turns it.
void add_leans(const Model& model, const RunnerModel& runner, const State& start,
               StandingTrack& track) {
  for (int wheel = 0; wheel < 2 * runner.wheelsets; ++wheel) {
    const int side = wheel % 2;
    const double q = wheel_force_of(start, runner.first_wheelset + wheel / 2, side)[2];
    const Index roll = kWheelSeatRows * wheel + 2;
    track.stiffness(roll, roll) -= q * seat_lean(model, runner.contact, side, 1.).lean;
  }
}

/// Places of the rails under the wheels.
std::vector<RailsUnder> places_of(const Model& model, const RunnerModel& runner,
                                  const State& start) {
  const Configuration at{start.u, {start.u, start.v}, track_offset(model, 0)};
  const Seats seats = seats_of(model, runner, start, 0.);
  const auto moved = [&](int row) {
    const WheelSeatRow& seat = seats.row[static_cast<std::size_t>(row)];
    double sum = seat.rise;
    for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], seat.row, at);
    return sum;
  };
  const int wheels = 2 * runner.wheelsets;
  std::vector<RailsUnder> places(static_cast<std::size_t>(runner.wheelsets));
  for (int wheel = 0; wheel < wheels; ++wheel) {
    RailsUnder& under = places[static_cast<std::size_t>(wheel / 2)];
    under.y[wheel % 2] = moved(kWheelSeatRows * wheel);
    under.z[wheel % 2] = moved(kWheelSeatRows * wheel + 1) +
                         residual_displacement(model, seats.place.data(), wheels, wheel);
  }
  return places;
}

}  // namespace

RunningOn rails_at_rest(const PackedModel& packed, const Track& track, std::int32_t runner) {
  const Model& model = packed.model();
  const RunnerModel& own = model.runner[runner];
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)));
  State start = state_on(model, memory.data());
  reset(model, start);
  const std::vector<Line> lines = lines_of(packed, track);
  StandingTrack mean = condensed_to(model, lines, seats_of(model, own, start, 0.));
  for (int i = 1; i < kPlaces; ++i) {
    const StandingTrack there =
        condensed_to(model, lines, seats_of(model, own, start, i * track.bay_length / kPlaces));
    mean.mass += there.mass;
    mean.damping += there.damping;
    mean.stiffness += there.stiffness;
  }
  for (MatrixXd* A : {&mean.mass, &mean.damping, &mean.stiffness}) *A /= kPlaces;
  add_leans(model, own, start, mean);
  return {places_of(model, own, start), std::move(mean)};
}

}  // namespace railstep
