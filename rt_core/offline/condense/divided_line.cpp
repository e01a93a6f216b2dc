#include <stdexcept>

#include "offline/condense/line_flexibility.h"

namespace railstep {

namespace {

/// Unknowns of the end nodes of an element in the line, -1 where held.
std::vector<int> end_unknowns(const Line& line, const std::vector<int>& carried, int element) {
  std::vector<int> result;
  for (const int node : {2 * element, 2 * element + 2})
    for (const int k : carried)
      result.push_back(
          line.unknown_of[static_cast<std::size_t>(node)][static_cast<std::size_t>(k)]);
  return result;
}

/// Rows of `from` at the given unknowns, 0 where held.
Eigen::MatrixXd gather(const Eigen::MatrixXd& from, const std::vector<int>& unknowns) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(unknowns.size()), from.cols());
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const int unknown = unknowns[static_cast<std::size_t>(i)];
    if (unknown < 0)
      result.row(i).setZero();
    else
      result.row(i) = from.row(unknown);
  }
  return result;
}

/// The line's stiffness with every element's end-node stiffness changed by `change`.
Eigen::SparseMatrix<double> with_change(const Track& track, const Line& line,
                                        const std::vector<int>& carried,
                                        const Eigen::MatrixXd& change) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < track.elements(); ++e) {
    const std::vector<int> place = end_unknowns(line, carried, e);
    for (std::size_t j = 0; j < place.size(); ++j)
      for (std::size_t i = 0; i < place.size(); ++i)
        if (place[i] >= 0 && place[j] >= 0)
          entries.emplace_back(place[i], place[j],
                               change(static_cast<int>(i), static_cast<int>(j)));
  }
  Eigen::SparseMatrix<double> result(line.unknowns(), line.unknowns());
  result.setFromTriplets(entries.begin(), entries.end());
  return result + line.stiffness;
}

}  // namespace

DividedLine::DividedLine(const Track& track, const Line& line, int parts)
    : track_(track), line_(line), element_(track, carried_unknowns(line), parts) {
  if (parts == 1) {
    factor(line.stiffness);
    return;
  }
  const Superelement whole(track, element_.carried(), 1);
  factor(with_change(track, line, element_.carried(), element_.stiffness() - whole.stiffness()));
}

/// Held is what Statics takes for held: all pivots above 1e-12 of their diagonal.
void DividedLine::factor(const Eigen::SparseMatrix<double>& stiffness) {
  factor_.compute(stiffness);
  held_ = factor_.info() == Eigen::Success;
  if (!held_) return;
  const Eigen::VectorXd diagonal = factor_.permutationP() * Eigen::VectorXd(stiffness.diagonal());
  held_ = (factor_.vectorD().array() > 1e-12 * diagonal.array()).all();
}

void DividedLine::refuse_free_modes() const {
  if (!held_)
    throw std::invalid_argument(
        "residual flexibility needs a track that is held: it has a free rigid mode");
}

Superelement::Rows DividedLine::port_rows(double z, int points) const {
  const int parts = element_.parts();
  Eigen::MatrixXd rows(points + 1, (2 * parts + 1) * static_cast<int>(element_.carried().size()));
  for (int p = 0; p <= points; ++p)
    rows.row(p) = element_.row(static_cast<double>(p) * parts / points, 0., z, 2).transpose();
  return element_.condense(rows);
}

/// Displacements of the line under unit forces on the end unknowns of an element; [unknowns][2d].
Eigen::MatrixXd DividedLine::end_columns(int element) const {
  const std::vector<int> place = end_unknowns(line_, element_.carried(), element);
  Eigen::MatrixXd unit =
      Eigen::MatrixXd::Zero(line_.unknowns(), static_cast<Eigen::Index>(place.size()));
  for (std::size_t j = 0; j < place.size(); ++j)
    if (place[j] >= 0) unit(place[j], static_cast<Eigen::Index>(j)) = 1.;
  return factor_.solve(unit);
}

Eigen::VectorXd DividedLine::under(double a_z, double b_z, int points) const {
  refuse_free_modes();
  const Superelement::Rows a = port_rows(a_z, points), b = port_rows(b_z, points);
  const Eigen::VectorXd held = element_.held(a, b).diagonal();
  Eigen::VectorXd result(track_.elements() * (points + 1));
  for (int e = 0; e < track_.elements(); ++e) {
    const Eigen::MatrixXd ends = gather(end_columns(e), end_unknowns(line_, element_.carried(), e));
    for (int p = 0; p <= points; ++p)
      result[e * (points + 1) + p] = a.ends.row(p).dot(ends * b.ends.row(p).transpose()) + held[p];
  }
  return result;
}

LineFlexibility::Strip DividedLine::between(double a_z, double b_z, int points) const {
  refuse_free_modes();
  const Superelement::Rows a = port_rows(a_z, points), b = port_rows(b_z, points);
  return [this, a, b, points, held = element_.held(a, b)](int element) {
    const Eigen::MatrixXd moved = end_columns(element) * a.ends.transpose();  // [unknowns][points]
    Eigen::MatrixXd strip(points + 1, track_.elements() * (points + 1));
    for (int e = 0; e < track_.elements(); ++e) {
      const Eigen::MatrixXd ends = gather(moved, end_unknowns(line_, element_.carried(), e));
      strip.middleCols(e * (points + 1), points + 1) = (b.ends * ends).transpose();
    }
    strip.middleCols(element * (points + 1), points + 1) += held;
    return strip;
  };
}

/// A point of the functional over the divided element that holds it, weighted by its factor and
/// its rail's part in the line.
Superelement::Rows DividedLine::rail_row(const Functional::OnRail& point, int element) const {
  const RailPoint& at = point.at;
  const double place = at.x / track_.element_length() - element;
  Eigen::VectorXd row = element_.row(place * element_.parts(), at.y, at.z, at.direction);
  const std::vector<int>& carried = element_.carried();
  for (Eigen::Index i = 0; i < row.size(); ++i) {
    const int k = carried[static_cast<std::size_t>(i) % carried.size()];
    if (flips_in_mirror(line_, at.rail, k)) row[i] = -row[i];
  }
  row *= point.factor * line_.rail_factor[static_cast<std::size_t>(at.rail)];
  return element_.condense(row.transpose());
}

DividedLine::Spread DividedLine::spread(const Functional& functional) const {
  Spread result{sleeper_load(line_, functional), {}};
  for (const Functional::OnRail& point : functional.rail) {
    const int element = element_at(track_, point.at.x);
    const Superelement::Rows row = rail_row(point, element);
    const std::vector<int> ends = end_unknowns(line_, element_.carried(), element);
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (ends[i] >= 0) result.load[ends[i]] += row.ends(0, static_cast<Eigen::Index>(i));
    result.points.push_back({element, row});
  }
  return result;
}

Eigen::VectorXd DividedLine::from(double z, const Functional& functional, int points) const {
  refuse_free_modes();
  const Superelement::Rows port = port_rows(z, points);
  const Spread read = spread(functional);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(track_.elements() * (points + 1));
  for (const Spread::OnElement& point : read.points)
    result.segment(point.element * (points + 1), points + 1) +=
        element_.held(port, point.rows).col(0);
  const Eigen::VectorXd moved = factor_.solve(read.load);
  for (int e = 0; e < track_.elements(); ++e)
    result.segment(e * (points + 1), points + 1) +=
        port.ends * gather(moved, end_unknowns(line_, element_.carried(), e)).col(0);
  return result;
}

Eigen::VectorXd DividedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  refuse_free_modes();
  const Spread acting = spread(force);
  const Eigen::VectorXd moved = factor_.solve(acting.load);
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const Spread read = spread(reads[i]);
    double sum = read.load.dot(moved);
    for (const Spread::OnElement& a : acting.points)
      for (const Spread::OnElement& b : read.points)
        if (a.element == b.element) sum += element_.held(a.rows, b.rows)(0, 0);
    result[static_cast<Eigen::Index>(i)] = sum;
  }
  return result;
}

}  // namespace railstep
