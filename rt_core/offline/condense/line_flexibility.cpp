#include "offline/condense/line_flexibility.h"

#include "offline/track/pad.h"

namespace railstep {

int tabled_elements(const Track& track) {
  return track.ring ? track.elements_per_bay : track.elements();
}

std::vector<int> carried_unknowns(const Line& line, int rail) {
  std::vector<int> found;
  for (int k = 0; k < 9; ++k)
    if (line.unknown(rail, 1, k) >= 0 && !(line.rigid_section && k == 7)) found.push_back(k);
  return found;
}

bool is_held(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factor,
             const Eigen::SparseMatrix<double>& stiffness) {
  if (factor.info() != Eigen::Success) return false;
  const Eigen::VectorXd diagonal = factor.permutationP() * Eigen::VectorXd(stiffness.diagonal());
  return (factor.vectorD().array() > 1e-12 * diagonal.array()).all();
}

std::unique_ptr<LineFlexibility> exact_line(const Track& track, const Line& line, int parts) {
  if (has_long_pads(track)) return std::make_unique<RefinedLine>(track, line, parts);
  return std::make_unique<DividedLine>(track, line, parts);
}

bool same_rail(const Line& line, int a, int b) { return a == b || line.mirrored; }

int element_at(const Track& track, double x) { return place_on(track, x).element; }

Eigen::VectorXd sleeper_load(const Track& track, const Line& line, const Functional& functional) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(line.unknowns());
  for (const Functional::OnSleeper& at : functional.sleeper)
    load += at.factor * sleeper_row(track, line, at.rail, at.seat, at.direction);
  return load;
}

}  // namespace railstep
