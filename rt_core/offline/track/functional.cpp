#include "offline/track/functional.h"

namespace railstep {

Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional) {
  Eigen::SparseVector<double> row(line.unknowns());
  for (const Functional::OnRail& term : functional.rail)
    row += term.factor * point_row(track, line, term.at);
  for (const Functional::OnSleeper& term : functional.sleeper) {
    const int unknown = line.sleeper_unknown_of[static_cast<std::size_t>(term.seat)]
                                               [static_cast<std::size_t>(term.direction)];
    const double weight = line.rail_factor[static_cast<std::size_t>(term.rail)];
    const bool flips = line.mirrored && term.rail == 1 && term.direction == 1;
    if (unknown >= 0 && weight != 0.)
      row.coeffRef(unknown) += term.factor * (flips ? -weight : weight);
  }
  return row;
}

}  // namespace railstep
