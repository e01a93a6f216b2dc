#include <stdexcept>

#include "offline/condense/line_flexibility.h"
#include "offline/condense/selected_inverse.h"
#include "offline/element/shape.h"

namespace railstep {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

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

/// The unknowns of each element of each rail, -1 where held.
std::vector<std::vector<int>> element_unknowns(const Track& track, const Line& line) {
  std::vector<std::vector<int>> all;
  for (int rail = 0; rail < track.rails; ++rail)
    for (int e = 0; e < track.elements(); ++e) {
      std::vector<int>& own = all.emplace_back();
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 9; ++k) own.push_back(line.element_unknown(rail, e, i, k));
    }
  return all;
}

}  // namespace

RefinedLine::RefinedLine(const Track& track, const Line& line, int parts)
    : track_(divided(track, parts)),
      elements_(track.elements()),
      parts_(parts),
      line_(matching(track_, line)) {
  factor_.compute(grouped(line_.stiffness, element_unknowns(track_, line_)));
  held_ = is_held(factor_, line_.stiffness);
}

void RefinedLine::refuse_free_modes() const {
  if (!held_)
    throw std::invalid_argument(
        "residual flexibility needs a track that is held: it has a free rigid mode");
}

Eigen::SparseMatrix<double> RefinedLine::columns(const Port& port, int element, int points) const {
  const double length = track_.element_length() * parts_;
  // The weight of the port's rail is left to the caller.
  const double weight = line_.rail_factor[static_cast<std::size_t>(port.rail)];
  Eigen::SparseMatrix<double> all(line_.unknowns(), points + 1);
  for (int p = 0; p <= points; ++p) {
    const double x = length * (element + static_cast<double>(p) / points);
    all.col(p) = point_row(track_, line_, {port.rail, x, port.y, port.z, 2}) / weight;
  }
  return all;
}

Eigen::VectorXd RefinedLine::under(const Port& port, const Port& seen, int points) const {
  refuse_free_modes();
  const SelectedInverse inverse(factor_);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(elements_ * (points + 1));
  for (int e = 0; e < elements_; ++e) {
    const Sparse acting = columns(port, e, points), read = columns(seen, e, points);
    for (int p = 0; p <= points; ++p)
      for (Sparse::InnerIterator b(read, p); b; ++b)
        for (Sparse::InnerIterator a(acting, p); a; ++a)
          result[e * (points + 1) + p] +=
              b.value() * inverse.at(static_cast<int>(b.row()), static_cast<int>(a.row())) *
              a.value();
  }
  return result;
}

LineFlexibility::Strip RefinedLine::between(const Port& a, const Port& b, int points) const {
  refuse_free_modes();
  Eigen::SparseMatrix<double> seen(line_.unknowns(), elements_ * (points + 1));
  for (int e = 0; e < elements_; ++e)
    seen.middleCols(e * (points + 1), points + 1) = columns(b, e, points);
  return [this, a, points, seen](int element) -> Eigen::MatrixXd {
    const Eigen::MatrixXd moved = factor_.solve(Eigen::MatrixXd(columns(a, element, points)));
    return (seen.transpose() * moved).transpose();
  };
}

Eigen::VectorXd RefinedLine::from(const Port& port, const Functional& functional,
                                  int points) const {
  refuse_free_modes();
  const Eigen::VectorXd load = functional_row(track_, line_, functional);
  const Eigen::VectorXd moved = factor_.solve(load);
  Eigen::VectorXd result(elements_ * (points + 1));
  for (int e = 0; e < elements_; ++e)
    result.segment(e * (points + 1), points + 1) = columns(port, e, points).transpose() * moved;
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
