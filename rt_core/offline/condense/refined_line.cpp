
#include "offline/analysis/free_motion.h"
#include "offline/condense/line_flexibility.h"
#include "offline/element/shape.h"
#include "offline/math/refuse.h"
#include "offline/math/sparse.h"

namespace railstep {

namespace {

/// A rail's unknowns where it stands, at the nodes of divided elements.
Eigen::VectorXd divided_state(const Eigen::VectorXd& rail, int elements, int parts) {
  if (rail.size() == 0) return rail;
  Eigen::VectorXd fine(9 * (2 * elements * parts + 1));
  for (int node = 0; node <= 2 * elements * parts; ++node) {
    const int element = std::min(node / (2 * parts), elements - 1);
    const auto n = shape(static_cast<double>(node - 2 * parts * element) / parts - 1.);
    fine.segment<9>(9 * node).setZero();
    for (int i = 0; i < 3; ++i)
      fine.segment<9>(9 * node) +=
          n[static_cast<std::size_t>(i)] * rail.segment<9>(9 * (2 * element + i));
  }
  return fine;
}

Track divided(Track track, int parts) {
  if (track.state)
    for (Eigen::VectorXd& rail : track.state->rail)
      rail = divided_state(rail, track.elements(), parts);
  track.elements_per_bay *= parts;
  return track;
}

}  // namespace

RefinedLine::RefinedLine(const Track& track, const Line& line, int parts)
    : whole_(track),
      track_(divided(track, parts)),
      elements_(track.elements()),
      parts_(parts),
      line_(matching(track_, line)) {
  factor_.compute(line_.stiffness);
  held_ = is_held(factor_, line_.stiffness);
}

void RefinedLine::refuse_free_modes() const {
  if (held_) return;
  railstep::refuse_free_modes(track_, {line_}, {});  // by its name
  refuse("E-TRACK-35",
         "the track has a free rigid mode; expected a support or a held end in every direction in "
         "which it moves");
}

Eigen::SparseMatrix<double> RefinedLine::columns(const LoadPoint& load_point, int element,
                                                 int points) const {
  const double length = track_.element_length() * parts_;
  // The weight of the load point's rail is left to the caller.
  const double weight = line_.rail_factor[static_cast<std::size_t>(load_point.rail)];
  Eigen::SparseMatrix<double> all(line_.unknowns(), points + 1);
  for (int p = 0; p <= points; ++p) {
    const double x = length * (element + static_cast<double>(p) / points);
    all.col(p) = point_row(track_, line_,
                           {load_point.rail, x, load_point.y, load_point.z, load_point.direction}) /
                 weight;
  }
  return all;
}

Eigen::VectorXd RefinedLine::under(const LoadPoint& load_point, const LoadPoint& other,
                                   int points) const {
  const Strip strip = between(load_point, other, points, 0);
  Eigen::VectorXd result(tabled_elements(whole_) * (points + 1));
  for (int e = 0; e < tabled_elements(whole_); ++e)
    result.segment(e * (points + 1), points + 1) = strip(e).diagonal();
  return result;
}

LineFlexibility::Strip RefinedLine::between(const LoadPoint& a, const LoadPoint& b, int points,
                                            int range) const {
  refuse_free_modes();
  return [=, this](int element) {
    const Eigen::MatrixXd moved = factor_.solve(Eigen::MatrixXd(columns(a, element, points)));
    Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(points + 1, (2 * range + 1) * (points + 1));
    for (int shift = -range; shift <= range; ++shift)
      if (const int e2 = shifted(whole_, element, shift); e2 >= 0)
        strip.middleCols((shift + range) * (points + 1), points + 1) =
            (columns(b, e2, points).transpose() * moved).transpose();
    return strip;
  };
}

Eigen::VectorXd RefinedLine::from(const LoadPoint& load_point, const Functional& functional,
                                  int points, Elements at) const {
  refuse_free_modes();
  const Eigen::VectorXd load = functional_row(track_, line_, functional);
  const Eigen::VectorXd moved = factor_.solve(load);
  Eigen::VectorXd result(at.count() * (points + 1));
  for (int e = at.first; e < at.last; ++e)
    result.segment((e - at.first) * (points + 1), points + 1) =
        columns(load_point, e, points).transpose() * moved;
  return result;
}

Eigen::VectorXd RefinedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  refuse_free_modes();
  const Eigen::VectorXd load(functional_row(track_, line_, force));
  const Eigen::VectorXd moved = factor_.solve(load);
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = functional_row(track_, line_, reads[i]).dot(moved);
  return result;
}

}  // namespace railstep
