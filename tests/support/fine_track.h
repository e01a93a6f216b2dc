#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/condense/flexibility.h"
#include "support/sections.h"

namespace railstep {

inline constexpr int kPoints = 8;  // intervals per element, and how much finer the fine track is
// The fine track and the tables solve one discrete problem in two ways. K has a condition of about
// 1e8, so both are exact to 1e-8 of the largest flexibility.
inline constexpr double kRounding = 1e-7;
inline constexpr double kHeadZ = .1, kFootZ = -.085;  // m over the axis

/// Two rails on sleepers that move in all directions, so that rails are coupled by roll and shift.
inline Track sleeper_track(int elements_per_bay, RailEnds ends = {}) {
  Track t;
  t.section = section_f();
  t.bays = 6;
  t.elements_per_bay = elements_per_bay;
  t.ends = ends;
  t.support = {.stiffness = {50e6, 50e6, 200e6}, .roll_stiffness = .3e6, .height_z = kFootZ};
  t.sleeper = Sleeper{300., 169., {20e6, 20e6, 50e6}, {}};
  return t;
}

/// sleeper_track() with pads and ballast that differ from side to side and from seat to seat. One
/// sleeper hangs on the right, and one has no left pad.
inline Track lopsided_track(int elements_per_bay) {
  Track t = sleeper_track(elements_per_bay);
  t.support.half_spread = .05;
  for (int border = 0; border <= t.bays; ++border) {
    Seat seat = t.seat(border);
    for (const std::size_t side : {0u, 1u}) {
      const double f = 1. + .1 * border + .5 * static_cast<double>(side);
      for (double& k : seat.pad[side].stiffness) k *= f;
      for (double& k : seat.ballast[side].stiffness) k /= f;
      seat.pad[side].roll_stiffness *= f;
    }
    t.changed_seats[border] = seat;
  }
  t.changed_seats[2].ballast[1] = {};
  t.changed_seats[3].pad[0].stiffness = {};
  return t;
}

/// A track with pads of 0.16 m on sleepers that pitch.
inline Track long_pads(int elements_per_bay) {
  Track t = sleeper_track(elements_per_bay);
  t.support.length = .16;
  t.sleeper->pitch_inertia = 8.;
  t.sleeper->ballast_length = .26;
  return t;
}

inline Track peers_track(int elements_per_bay) {
  Track t;
  t.section = peers_rectangle();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = 16;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {3e6, 3e7, 3e7};
  return t;
}

/// The lowest modes of each line; empty if `per_bay` is 0.
inline std::vector<Basis> lowest_modes(const Track& track, const std::vector<Line>& lines,
                                       int per_bay) {
  std::vector<Basis> bases;
  for (const Line& line : lines) {
    const Modes all = modes(line);
    const auto kept = std::min<Eigen::Index>(per_bay * track.bays, all.frequency.size());
    bases.push_back({2. * M_PI * all.frequency.head(kept), all.shape.leftCols(kept)});
  }
  return bases;
}

enum class Kind { full, modal, nothing_kept };

inline std::vector<Basis> bases_of(Kind kind, const Track& track, const std::vector<Line>& lines) {
  if (kind == Kind::full) return {};
  return lowest_modes(track, lines, kind == Kind::modal ? 2 : 0);
}

inline Functional at_point(const RailPoint& point) { return {.rail = {{point, 1.}}}; }

/// The vertical opening of a pad: rail's foot over sleeper.
inline Functional opening(int rail, int seat) {
  return {.rail = {{{rail, .6 * seat, 0., kFootZ, 2}, 1.}}, .sleeper = {{rail, seat, 2, -1.}}};
}

/// The functional over the unknowns of one line, term by term.
inline Eigen::VectorXd row_of(const Track& track, const Line& line, const Functional& functional) {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(line.unknowns());
  for (const auto& [point, factor] : functional.rail) row += factor * point_row(track, line, point);
  for (const auto& at : functional.sleeper)
    row += at.factor * sleeper_row(track, line, at.rail, at.seat, at.direction);
  return row;
}

/// G_model computed directly, for a functional and a vertical force at (rail, x, z).
class KeptFlexibility {
 public:
  KeptFlexibility(const Track& track, const std::vector<Basis>& bases)
      : statics_(track), bases_(bases) {}

  double operator()(const Functional& functional, int rail, double x, double z) const {
    const std::vector<Line>& lines = statics_.lines();
    // The condensed port leaves b_z out: its force acts on the axis.
    const RailPoint port{rail, x, 0., bases_.empty() ? z : 0., 2};
    double sum = 0.;
    std::vector<Eigen::VectorXd> moved;
    if (bases_.empty()) moved = statics_.solve({{port, 1.}});
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const Eigen::VectorXd row = row_of(statics_.track(), lines[l], functional);
      if (bases_.empty()) {
        sum += row.dot(moved[l]);
        continue;
      }
      const Basis& b = bases_[l];
      const Eigen::VectorXd force = point_row(statics_.track(), lines[l], port);
      const Eigen::MatrixXd S = b.shapes.dense();
      for (Eigen::Index m = 0; m < b.omega.size(); ++m)
        sum += row.dot(S.col(m)) * S.col(m).dot(force) / (b.omega[m] * b.omega[m]);
    }
    return sum;
  }

 private:
  Statics statics_;
  std::vector<Basis> bases_;
};

/// Whole flexibility at a vertical force, on the fine track.
inline double exact(const Statics& fine, const Functional& functional,
                    const std::vector<Eigen::VectorXd>& moved) {
  double sum = 0.;
  for (std::size_t l = 0; l < moved.size(); ++l)
    sum += row_of(fine.track(), fine.lines()[l], functional).dot(moved[l]);
  return sum;
}

inline double place(const Track& track, int e, int p) {
  return track.element_length() * (e + static_cast<double>(p) / kPoints);
}

}  // namespace railstep
