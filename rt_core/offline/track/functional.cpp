#include "offline/track/functional.h"

#include "offline/track/pad.h"

namespace railstep {

Functional pad_gap(const Track& track, int rail, int seat) {
  const Seat there = track.seat(seat);
  const Support& pad = there.pad[static_cast<std::size_t>(rail)];
  Functional gap;
  double offset = 0.;
  for (const PadPoint& at : pad_points(track, seat, pad.length)) {
    gap.rail.push_back({{rail, at.x, 0., pad.height_z, 2}, at.part});
    offset += at.part * at.offset;
  }
  if (there.sleeper) gap.sleeper.push_back({rail, seat, 2, -1.});
  if (there.sleeper && there.sleeper->moves[2] && offset != 0.)
    gap.sleeper.push_back({rail, seat, 3, offset});
  return gap;
}

Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional) {
  Eigen::SparseVector<double> row(line.unknowns());
  for (const Functional::OnRail& term : functional.rail)
    row += term.factor * point_row(track, line, term.at);
  for (const Functional::OnSleeper& term : functional.sleeper)
    row += term.factor * sleeper_row(track, line, term.rail, term.seat, term.direction);
  return row;
}

}  // namespace railstep
