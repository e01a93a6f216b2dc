#include "offline/start/standing_track.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "offline/math/refuse.h"
#include "offline/pack/seat_residual.h"
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
    const double x = element_place(model, runner, i, {0, 0.}) + ahead;
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
    row.rail = wheel_of(static_cast<std::int32_t>(wheel)).side;
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

/// Rows of all seats over a line, [unknowns][rows].
MatrixXd rows_of(const Line& line, const Seats& seats) {
  MatrixXd rows(line.unknowns(), static_cast<Index>(seats.row.size()));
  for (Index i = 0; i < rows.cols(); ++i)
    rows.col(i) = contact_row(line, seats.row[static_cast<std::size_t>(i)].row, true);
  return rows;
}

/// The track where a vehicle stands.
struct Place {
  Seats seats;
  std::vector<SeatFlexibility> missed;  // of each seat, beyond what the lines have
  Seats ahead, behind;                  // seats between which slopes are means
  double apart;                         // of these, m
};

/// Means over places in a bay of what unit forces along the rows of all seats make there.
class MeanResponse {
 public:
  explicit MeanResponse(Index rows)
      : flexibility_(MatrixXd::Zero(rows, rows)),
        slope_(flexibility_),
        mass_(flexibility_),
        damping_(flexibility_) {}

  void add(const Model& model, const std::vector<Line>& lines, const Place& at) {
    MatrixXd slope = MatrixXd::Zero(slope_.rows(), slope_.cols());
    for (const Line& line : lines) {
      const MatrixXd rows = rows_of(line, at.seats);
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> stiffness(
          loaded_stiffness(model, line, at.seats));
      const MatrixXd moved = stiffness.solve(rows);
      flexibility_ += rows.transpose() * moved;
      slope += (rows_of(line, at.ahead) - rows_of(line, at.behind)).transpose() * moved / at.apart;
      mass_ += moved.transpose() * (line.mass * moved);
      damping_ += moved.transpose() * (line.damping * moved);
    }
    for (std::size_t wheel = 0; wheel < at.missed.size(); ++wheel)
      for (int i = 0; i < kWheelSeatRows; ++i)
        for (int j = 0; j < kWheelSeatRows; ++j) {
          const auto first = static_cast<Index>(kWheelSeatRows * wheel);
          flexibility_(first + i, first + j) += at.missed[wheel].along[i][j];
          // In the mean over a bay a force bends the rail ahead of it as that behind it.
          slope(first + i, first + j) = 0.;
        }
    // On a rail that rises the contact moves ahead on the wheel: the rise does not count.
    for (Index i = 1; i < slope.rows(); i += kWheelSeatRows) slope.row(i).setZero();
    slope_ += slope;
    ++places_;
  }

  /// Masses, dampers and springs with that response to slow forces.
  StandingTrack track() const {
    const MatrixXd stiffness = places_ * flexibility_.inverse();
    return {stiffness * (mass_ / places_) * stiffness, stiffness * (damping_ / places_) * stiffness,
            stiffness, slope_ / places_ * stiffness};
  }

 private:
  MatrixXd flexibility_, slope_, mass_, damping_;  // sums
  double places_ = 0.;
};

/// The springs by which a vertical force on a section that rolls turns it.
void add_leans(const Model& model, const RunnerModel& runner, const State& start,
               StandingTrack& track) {
  for (int wheel = 0; wheel < 2 * runner.wheelsets; ++wheel) {
    const auto [set, side] = wheel_of(wheel);
    const double q = wheel_force_of(start, runner.first_wheelset + set, side)[2];
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
    const auto [set, side] = wheel_of(wheel);
    RailsUnder& under = places[static_cast<std::size_t>(set)];
    const double* const force = wheel_force_of(start, runner.first_wheelset + set, side);
    const SeatFlexibility gives =
        seat_flexibility_beside(model, runner, side, seats.place[static_cast<std::size_t>(wheel)]);
    under.y[side] = moved(kWheelSeatRows * wheel) + moved_by_wheel(gives.along[0], force);
    under.z[side] = moved(kWheelSeatRows * wheel + 1) + moved_by_wheel(gives.along[1], force) +
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
  const MeshResidual missed(packed, linear_about_rest(track), lines);
  MeanResponse response(2 * own.wheelsets * kWheelSeatRows);
  const double apart = track.bay_length / kPlaces;
  Seats behind = seats_of(model, own, start, 0.);
  for (int i = 0; i < kPlaces; ++i) {
    Seats seats = seats_of(model, own, start, (i + .5) * apart),
          ahead = seats_of(model, own, start, (i + 1) * apart);
    std::vector<SeatFlexibility> of_seats;
    of_seats.reserve(seats.place.size());
    for (int wheel = 0; wheel < 2 * own.wheelsets; ++wheel)
      of_seats.push_back(
          missed.under(runner, wheel_of(wheel).side, seats.place[static_cast<std::size_t>(wheel)]));
    response.add(model, lines,
                 {std::move(seats), std::move(of_seats), ahead, std::move(behind), apart});
    behind = std::move(ahead);
  }
  StandingTrack mean = response.track();
  add_leans(model, own, start, mean);
  return {places_of(model, own, start), std::move(mean)};
}

}  // namespace railstep
