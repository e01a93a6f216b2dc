#include <Eigen/SparseCholesky>
#include <algorithm>

#include "offline/analysis/free_motion.h"
#include "offline/pack/pack.h"

namespace railstep {

namespace {

constexpr int kLeverPoints = 4;  // intervals per element of the levers' table

/// Share of a unit force on a rail that a seat carries. By reciprocity it is the shape under a unit
/// force along the pad of this seat, which serves all places of the force. Free lines are left out.
class SeatShares {
 public:
  SeatShares(const Track& track, const std::vector<Line>& lines)
      : track_(track), lines_(lines), factor_(lines.size()), held_(lines.size()) {
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      factor_[l].compute(lines_[l].stiffness);
      held_[l] = is_held(factor_[l], lines_[l].stiffness);
    }
  }
  /// Height of the rail's axis over x under a unit force that opens the pad, m/N.
  class Shape {
   public:
    Shape(const SeatShares& shares, int rail, int seat) : shares_(shares), rail_(rail) {
      const Functional gap = pad_gap(shares.track_, rail, seat);
      for (std::size_t l = 0; l < shares.lines_.size(); ++l) {
        const Line& line = shares.lines_[l];
        const Eigen::VectorXd row(functional_row(shares.track_, line, gap));
        moved_.emplace_back(shares.held_[l] ? Eigen::VectorXd(shares.factor_[l].solve(row))
                                            : Eigen::VectorXd::Zero(row.size()));
      }
    }
    double operator()(double x) const {
      double sum = 0.;
      for (std::size_t l = 0; l < moved_.size(); ++l)
        sum += point_row(shares_.track_, shares_.lines_[l], {rail_, x, 0., 0., 2}).dot(moved_[l]);
      return sum;
    }

   private:
    const SeatShares& shares_;
    int rail_;
    std::vector<Eigen::VectorXd> moved_;
  };

 private:
  const Track& track_;
  const std::vector<Line>& lines_;
  std::vector<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factor_;
  std::vector<bool> held_;
};

bool pads_are_off_the_axis(const Track& track) {
  for (int seat = 0; seat <= track.bays; ++seat)
    for (const Support& pad : track.seat(seat).pad)
      if (pad.height_z != 0. && pad.stiffness[2] != 0.) return true;
  return false;
}

/// PDeltaModel::lever of one rail, 0 on elements that the traffic does not visit.
std::vector<double> levers(const Track& track, const SeatShares& shares, int rail, Elements met) {
  const int per_bay = track.elements_per_bay;
  std::vector<double> lever(
      static_cast<std::size_t>(track.elements()) * kPDeltaSeats * (kLeverPoints + 1), 0.);
  const int around = kPDeltaSeats / 2, last = std::min(met.last / per_bay + around, track.bays);
  for (int seat = std::max(met.first / per_bay - around, 0); seat <= last; ++seat) {
    const Support pad = track.seat(seat).pad[static_cast<std::size_t>(rail)];
    if (pad.one_sided()) continue;  // over a gap
    const SeatShares::Shape shape(shares, rail, seat);
    for (int s = 0; s < kPDeltaSeats; ++s) {
      const int bay = seat - s + (kPDeltaSeats / 2 - 1);
      for (int e = std::max(bay * per_bay, met.first); e < std::min((bay + 1) * per_bay, met.last);
           ++e)
        for (int p = 0; p <= kLeverPoints; ++p) {
          const double x = (e + static_cast<double>(p) / kLeverPoints) * track.element_length();
          const int at = (e * kPDeltaSeats + s) * (kLeverPoints + 1) + p;
          lever[static_cast<std::size_t>(at)] = pad.stiffness[2] * pad.height_z * shape(x);
        }
    }
  }
  return lever;
}

}  // namespace

void PackedModel::add_p_delta(const Track& track) {
  if (track.unknowns == Unknowns::vertical || track.rigid) return;
  if (model_.wheelsets == 0 && model_.external_wheels == 0 && model_.runners == 0)
    return;  // no lateral forces
  if (!pads_are_off_the_axis(track)) return;
  PDeltaModel& p_delta = model_.p_delta;
  p_delta.elements_per_bay = track.elements_per_bay;
  p_delta.points = kLeverPoints;
  // A support that does not pull and has no gap is mostly closed: it is a spring here.
  const Track reference = linear_about_rest(track);
  const std::vector<Line> all = assemble(reference);
  std::vector<Line> lines;
  for (const PackedLine& own : lines_) lines.push_back(all[own.index]);
  const SeatShares shares(reference, lines);
  p_delta.lever[0] = keep(levers(reference, shares, 0, met_));
  p_delta.lever[1] =
      is_symmetric(track) ? p_delta.lever[0] : keep(levers(reference, shares, 1, met_));
}

}  // namespace railstep
