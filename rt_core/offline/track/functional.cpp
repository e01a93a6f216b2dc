#include "offline/track/functional.h"

#include "offline/track/pad.h"
#include "offline/track/squeeze.h"

namespace railstep {

void add_underside(const Track& track, int rail, int seat, double x, double y, double factor,
                   Functional& to) {
  const double z = track.seat(seat).pad[static_cast<std::size_t>(rail)].height_z;
  const Cant cant = track.lean(rail);
  to.rail.push_back({{rail, x, y, z, 2}, factor * cant.cosine});
  if (cant.sine != 0.) to.rail.push_back({{rail, x, y, z, 1}, -factor * cant.sine});
}

/// u_end, and along z as much as the sleeper rises by the distance from its end's middle,
/// aside (u_left - u_right)/g.
void add_sleeper_top(const Track& track, int rail, int seat, double y, double factor,
                     Functional& to) {
  const Seat there = track.seat(seat);
  if (!there.sleeper) return;
  const Cant cant = track.lean(rail);
  to.sleeper.push_back({rail, seat, 2, factor * cant.cosine});
  if (cant.sine != 0.) to.sleeper.push_back({rail, seat, 1, -factor * cant.sine});
  const double aside =
      cant.cosine * y - cant.sine * there.pad[static_cast<std::size_t>(rail)].height_z;
  if (track.rails == 1 || aside == 0.) return;
  const double lever = cant.cosine * aside / track.rail_spacing;
  to.sleeper.push_back({0, seat, 2, factor * lever});
  to.sleeper.push_back({1, seat, 2, -factor * lever});
}

Functional pad_gap(const Track& track, int rail, int seat) {
  const Seat there = track.seat(seat);
  const Support& pad = there.pad[static_cast<std::size_t>(rail)];
  Functional gap;
  double offset = 0.;
  for (const PadPoint& at : pad_points(track, seat, pad.length)) {
    add_underside(track, rail, seat, at.x, 0., at.part, gap);
    offset += at.part * at.offset;
  }
  add_sleeper_top(track, rail, seat, 0., -1., gap);
  if (there.sleeper && there.sleeper->moves[2] && offset != 0.)
    gap.sleeper.push_back({rail, seat, 3, offset * track.lean(rail).cosine});
  gap.part = part_of_pad(track, seat, rail);
  return gap;
}

double part_in(const Track& track, const Functional& functional) {
  return strains_section(track.unknowns) ? 1. : functional.part;
}

Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional) {
  Eigen::SparseVector<double> row(line.unknowns());
  for (const Functional::OnRail& term : functional.rail)
    row += term.factor * point_row(track, line, term.at);
  for (const Functional::OnSleeper& term : functional.sleeper)
    row += term.factor * sleeper_row(track, line, term.rail, term.seat, term.direction);
  return part_in(track, functional) * row;
}

}  // namespace railstep
