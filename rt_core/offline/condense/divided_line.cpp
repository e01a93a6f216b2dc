#include <stdexcept>

#include "offline/condense/line_flexibility.h"
#include "offline/condense/selected_inverse.h"

namespace railstep {

namespace {

/// Unknowns of the end nodes of an element of a rail in the line, -1 where held.
std::vector<int> end_unknowns(const Line& line, int rail, const Superelement& whole, int element) {
  std::vector<int> result;
  for (const int end : {0, 2})
    for (const int k : whole.carried())
      result.push_back(line.element_unknown(rail, element, end, k));
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

/// The inverse at the given unknowns, 0 where held.
Eigen::MatrixXd gather(const SelectedInverse& inverse, const std::vector<int>& unknowns) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const int row = unknowns[static_cast<std::size_t>(i)],
                column = unknowns[static_cast<std::size_t>(j)];
      result(i, j) = row < 0 || column < 0 ? 0. : inverse.at(row, column);
    }
  return result;
}

/// Adds a change of every element's end-node stiffness along a rail, and with one part a 0 wherever
/// two of its unknowns meet: what the inverse is asked for.
void add_change(const Track& track, const Line& line, int rail, const Superelement& element,
                const Eigen::MatrixXd& change, std::vector<Eigen::Triplet<double>>& entries) {
  for (int e = 0; e < track.elements(); ++e) {
    const std::vector<int> place = end_unknowns(line, rail, element, e);
    for (std::size_t j = 0; j < place.size(); ++j)
      for (std::size_t i = 0; i < place.size(); ++i)
        if (place[i] >= 0 && place[j] >= 0)
          entries.emplace_back(place[i], place[j],
                               change(static_cast<int>(i), static_cast<int>(j)));
  }
}

}  // namespace

DividedLine::DividedLine(const Track& track, const Line& line, int parts)
    : track_(track), line_(line) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const int rail : {0, 1}) {
    const std::vector<int> carried = carried_unknowns(line, rail);
    if (carried.empty() || (rail == 1 && line.mirrored)) continue;
    auto& own = element_[static_cast<std::size_t>(rail)].emplace(track, rail, carried, parts);
    const Superelement whole(track, rail, carried, 1);
    add_change(track, line, rail, own, own.stiffness() - whole.stiffness(), entries);
  }
  Eigen::SparseMatrix<double> change(line.unknowns(), line.unknowns());
  change.setFromTriplets(entries.begin(), entries.end());
  factor(change + line.stiffness);
}

const Superelement& DividedLine::element(int rail) const {
  return *element_[line_.mirrored ? 0 : static_cast<std::size_t>(rail)];
}

void DividedLine::factor(const Eigen::SparseMatrix<double>& stiffness) {
  factor_.compute(stiffness);
  held_ = is_held(factor_, stiffness);
}

void DividedLine::refuse_free_modes() const {
  if (!held_)
    throw std::invalid_argument(
        "residual flexibility needs a track that is held: it has a free rigid mode");
}

/// From a rail's own unknowns to the line's.
void DividedLine::sign(int rail, Eigen::VectorXd& row) const {
  const std::vector<int>& carried = element(rail).carried();
  for (Eigen::Index i = 0; i < row.size(); ++i)
    row[i] *= sign_of(line_, rail, carried[static_cast<std::size_t>(i) % carried.size()]);
}

Superelement::Rows DividedLine::port_rows(const Port& port, int points) const {
  const Superelement& own = element(port.rail);
  const int parts = own.parts();
  Eigen::MatrixXd rows(points + 1, (2 * parts + 1) * static_cast<int>(own.carried().size()));
  for (int p = 0; p <= points; ++p) {
    Eigen::VectorXd row =
        own.row(static_cast<double>(p) * parts / points, track_.lean(port.rail), port.y, port.z, 2);
    sign(port.rail, row);
    rows.row(p) = row.transpose();
  }
  return own.condense(rows);
}

/// Displacements of the line under unit forces on the end unknowns of an element; [unknowns][2d].
Eigen::MatrixXd DividedLine::end_columns(int rail, int at) const {
  const std::vector<int> place = end_unknowns(line_, rail, element(rail), at);
  Eigen::MatrixXd unit =
      Eigen::MatrixXd::Zero(line_.unknowns(), static_cast<Eigen::Index>(place.size()));
  for (std::size_t j = 0; j < place.size(); ++j)
    if (place[j] >= 0) unit(place[j], static_cast<Eigen::Index>(j)) = 1.;
  return factor_.solve(unit);
}

Eigen::VectorXd DividedLine::under(const Port& port, const Port& seen, int points) const {
  refuse_free_modes();
  const Superelement& own = element(port.rail);
  const Superelement::Rows a = port_rows(port, points), b = port_rows(seen, points);
  const Eigen::VectorXd held = own.held(a, b).diagonal();
  const SelectedInverse inverse(factor_);
  Eigen::VectorXd result(tabled_elements(track_) * (points + 1));
  for (int e = 0; e < tabled_elements(track_); ++e) {
    const Eigen::MatrixXd ends = gather(inverse, end_unknowns(line_, port.rail, own, e));
    for (int p = 0; p <= points; ++p)
      result[e * (points + 1) + p] = a.ends.row(p).dot(ends * b.ends.row(p).transpose()) + held[p];
  }
  return result;
}

LineFlexibility::Strip DividedLine::between(const Port& a, const Port& b, int points) const {
  refuse_free_modes();
  const Superelement::Rows from = port_rows(a, points), to = port_rows(b, points);
  const bool same = same_rail(line_, a.rail, b.rail);
  const Eigen::MatrixXd held = same ? element(a.rail).held(from, to) : Eigen::MatrixXd();
  return [=, this](int at) {
    const Eigen::MatrixXd moved =
        end_columns(a.rail, at) * from.ends.transpose();  // [unknowns][points]
    Eigen::MatrixXd strip(points + 1, track_.elements() * (points + 1));
    for (int e = 0; e < track_.elements(); ++e) {
      const Eigen::MatrixXd ends = gather(moved, end_unknowns(line_, b.rail, element(b.rail), e));
      strip.middleCols(e * (points + 1), points + 1) = (to.ends * ends).transpose();
    }
    if (same) strip.middleCols(at * (points + 1), points + 1) += held;
    return strip;
  };
}

/// A point of the functional over the divided element that holds it, weighted by its factor and
/// its rail's part in the line.
Superelement::Rows DividedLine::rail_rows(const Functional::OnRail& point, int at_element) const {
  const RailPoint& at = point.at;
  const Superelement& own = element(at.rail);
  const double place = at.x / track_.element_length() - at_element;
  Eigen::VectorXd row =
      own.row(place * own.parts(), track_.lean(at.rail), at.y, at.z, at.direction);
  sign(at.rail, row);
  row *= point.factor * line_.rail_factor[static_cast<std::size_t>(at.rail)];
  return own.condense(row.transpose());
}

DividedLine::Spread DividedLine::spread(const Functional& functional) const {
  const double part = part_in(track_, functional);
  Spread result{sleeper_load(track_, line_, functional), {}};
  for (const Functional::OnRail& point : functional.rail) {
    const int rail = point.at.rail;
    if (line_.rail_factor[static_cast<std::size_t>(rail)] == 0.) continue;
    const int at = element_at(track_, point.at.x);
    const Superelement::Rows row = rail_rows({point.at, part * point.factor}, at);
    const std::vector<int> ends = end_unknowns(line_, rail, element(rail), at);
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (ends[i] >= 0) result.load[ends[i]] += row.ends(0, static_cast<Eigen::Index>(i));
    result.points.push_back({rail, at, row});
  }
  return result;
}

Eigen::VectorXd DividedLine::from(const Port& port, const Functional& functional,
                                  int points) const {
  refuse_free_modes();
  const Superelement& own = element(port.rail);
  const Superelement::Rows rows = port_rows(port, points);
  const Spread read = spread(functional);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(track_.elements() * (points + 1));
  for (const Spread::OnElement& point : read.points)
    if (same_rail(line_, port.rail, point.rail))
      result.segment(point.element * (points + 1), points + 1) += own.held(rows, point.rows).col(0);
  const Eigen::VectorXd moved = factor_.solve(read.load);
  for (int e = 0; e < track_.elements(); ++e)
    result.segment(e * (points + 1), points + 1) +=
        rows.ends * gather(moved, end_unknowns(line_, port.rail, own, e)).col(0);
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
        if (a.element == b.element && same_rail(line_, a.rail, b.rail))
          sum += element(a.rail).held(a.rows, b.rows)(0, 0);
    result[static_cast<Eigen::Index>(i)] = sum;
  }
  return result;
}

}  // namespace railstep
