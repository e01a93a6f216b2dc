#include <Eigen/SparseCholesky>

#include "offline/condense/line_flexibility.h"
#include "offline/pack/pack.h"

namespace railstep {

namespace {

constexpr int kTurnPoints = 4;  // intervals per element of the levers' table

/// What a seat bears of a unit force on its rail: by reciprocity the shape that a unit force along
/// its pad makes, for all places of the force at once. Lines that are free are left out.
class SeatShares {
 public:
  SeatShares(const Track& track, const std::vector<PackedLine>& lines)
      : track_(track), lines_(lines), factor_(lines.size()), held_(lines.size()) {
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      factor_[l].compute(lines_[l].line.stiffness);
      held_[l] = is_held(factor_[l], lines_[l].line.stiffness);
    }
  }
  /// Height of the rail's axis over x, m/N, as a unit force opens the pad.
  class Shape {
   public:
    Shape(const SeatShares& shares, int rail, int seat) : shares_(shares), rail_(rail) {
      const Functional gap = pad_gap(shares.track_, rail, seat);
      for (std::size_t l = 0; l < shares.lines_.size(); ++l) {
        const Line& line = shares.lines_[l].line;
        const Eigen::VectorXd row(functional_row(shares.track_, line, gap));
        moved_.emplace_back(shares.held_[l] ? Eigen::VectorXd(shares.factor_[l].solve(row))
                                            : Eigen::VectorXd::Zero(row.size()));
      }
    }
    double operator()(double x) const {
      double sum = 0.;
      for (std::size_t l = 0; l < moved_.size(); ++l)
        sum +=
            point_row(shares_.track_, shares_.lines_[l].line, {rail_, x, 0., 0., 2}).dot(moved_[l]);
      return sum;
    }

   private:
    const SeatShares& shares_;
    int rail_;
    std::vector<Eigen::VectorXd> moved_;
  };

 private:
  const Track& track_;
  const std::vector<PackedLine>& lines_;
  std::vector<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factor_;
  std::vector<bool> held_;
};

bool pads_are_off_the_axis(const Track& track) {
  for (int seat = 0; seat <= track.bays; ++seat)
    for (const Support& pad : track.seat(seat).pad)
      if (pad.height_z != 0. && pad.stiffness[2] != 0.) return true;
  return false;
}

/// SeatTurnModel::lever of one rail.
std::vector<double> levers(const Track& track, const SeatShares& shares, int rail) {
  const int per_bay = track.elements_per_bay;
  std::vector<double> lever(
      static_cast<std::size_t>(track.elements()) * kTurnSeats * (kTurnPoints + 1), 0.);
  for (int seat = 0; seat <= track.bays; ++seat) {
    const Support pad = track.seat(seat).pad[static_cast<std::size_t>(rail)];
    const SeatShares::Shape shape(shares, rail, seat);
    for (int s = 0; s < kTurnSeats; ++s) {
      const int bay = seat - s + (kTurnSeats / 2 - 1);
      for (int e = bay * per_bay; e < (bay + 1) * per_bay && bay >= 0 && bay < track.bays; ++e)
        for (int p = 0; p <= kTurnPoints; ++p) {
          const double x = (e + static_cast<double>(p) / kTurnPoints) * track.element_length();
          const int at = (e * kTurnSeats + s) * (kTurnPoints + 1) + p;
          lever[static_cast<std::size_t>(at)] = pad.stiffness[2] * pad.height_z * shape(x);
        }
    }
  }
  return lever;
}

}  // namespace

void PackedModel::add_turn(const Track& track) {
  if (track.unknowns == Unknowns::vertical || model_.wheelsets == 0) return;
  if (!pads_are_off_the_axis(track)) return;
  SeatTurnModel& turn = model_.turn;
  turn.elements_per_bay = track.elements_per_bay;
  turn.points = kTurnPoints;
  const SeatShares shares(track, lines_);
  turn.lever[0] = keep(levers(track, shares, 0));
  turn.lever[1] = is_symmetric(track) ? turn.lever[0] : keep(levers(track, shares, 1));
}

}  // namespace railstep
