#include "offline/condense/line_flexibility.h"

namespace railstep {

std::vector<int> carried_unknowns(const Line& line) {
  std::vector<int> found;
  for (int k = 0; k < 9; ++k)
    if (line.unknown(1, k) >= 0) found.push_back(k);
  return found;
}

int element_at(const Track& track, double x) { return place_on(track, x).element; }

bool flips_in_mirror(const Line& line, int rail, int k) {
  return line.mirrored && rail == 1 && (k == 1 || k == 3 || k == 5 || k == 7);
}

Eigen::VectorXd sleeper_load(const Line& line, const Functional& functional) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(line.unknowns());
  for (const Functional::OnSleeper& at : functional.sleeper) {
    const int unknown = line.sleeper_unknown_of[static_cast<std::size_t>(at.seat)]
                                               [static_cast<std::size_t>(at.direction)];
    if (unknown < 0) continue;
    const double weight = at.factor * line.rail_factor[static_cast<std::size_t>(at.rail)];
    load[unknown] += flips_in_mirror(line, at.rail, at.direction) ? -weight : weight;
  }
  return load;
}

}  // namespace railstep
