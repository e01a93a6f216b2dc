#include <algorithm>

#include "offline/analysis/free_motion.h"
#include "offline/condense/line_flexibility.h"
#include "offline/math/refuse.h"

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

/// A solution at the given unknowns, 0 if held.
Eigen::VectorXd gather(const Stretch& from, const std::vector<int>& unknowns) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = unknowns[i] < 0 ? 0. : from[unknowns[i]];
  return result;
}

/// Loads on the given unknowns; held unknowns carry theirs.
Eigen::SparseVector<double> spread_over(const Line& line, const std::vector<int>& unknowns,
                                        const Eigen::VectorXd& loads) {
  Eigen::SparseVector<double> result(line.unknowns());
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (unknowns[i] >= 0) result.coeffRef(unknowns[i]) += loads[static_cast<Eigen::Index>(i)];
  return result;
}

/// Adds a change of every element's end-node stiffness along a rail.
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
    if (parts == 1) continue;
    const Superelement whole(track, rail, carried, 1);
    add_change(track, line, rail, own, own.stiffness() - whole.stiffness(), entries);
  }
  Eigen::SparseMatrix<double> change(line.unknowns(), line.unknowns());
  change.setFromTriplets(entries.begin(), entries.end());
  factor(parts == 1 ? line.stiffness : Eigen::SparseMatrix<double>(change + line.stiffness));
}

const Superelement& DividedLine::element(int rail) const {
  return *element_[line_.mirrored ? 0 : static_cast<std::size_t>(rail)];
}

void DividedLine::factor(const Eigen::SparseMatrix<double>& stiffness) {
  factor_.compute(stiffness);
  held_ = is_held(factor_, stiffness);
  if (!held_ || track_.ring) return;
  local_.emplace(stiffness);
  find_spans();
}

void DividedLine::find_spans() {
  for (int e = 0; e < track_.elements(); ++e) {
    auto& [lowest, highest] = span_.emplace_back(line_.unknowns(), -1);
    for (const int rail : {0, 1}) {
      if (!element_[static_cast<std::size_t>(rail)]) continue;
      for (const int unknown : end_unknowns(line_, rail, element(rail), e)) {
        if (unknown < 0) continue;
        lowest = std::min(lowest, unknown);
        highest = std::max(highest, unknown);
      }
    }
  }
}

void DividedLine::refuse_free_modes() const {
  if (held_) return;
  railstep::refuse_free_modes(track_, {line_}, {});  // by its name
  refuse("E-TRACK-35",
         "the track has a free rigid mode; expected a support or a held end in every direction in "
         "which it moves");
}

/// From a rail's own unknowns to the line's.
void DividedLine::sign(int rail, Eigen::VectorXd& row) const {
  const std::vector<int>& carried = element(rail).carried();
  for (Eigen::Index i = 0; i < row.size(); ++i)
    row[i] *= sign_of(line_, rail, carried[static_cast<std::size_t>(i) % carried.size()]);
}

Superelement::Rows DividedLine::load_rows(const LoadPoint& load_point, int points) const {
  const Superelement& own = element(load_point.rail);
  const int parts = own.parts();
  Eigen::MatrixXd rows(points + 1, (2 * parts + 1) * static_cast<int>(own.carried().size()));
  for (int p = 0; p <= points; ++p) {
    Eigen::VectorXd row =
        own.row(static_cast<double>(p) * parts / points, track_.lean(load_point.rail), load_point.y,
                load_point.z, load_point.direction);
    sign(load_point.rail, row);
    rows.row(p) = row.transpose();
  }
  return own.condense(rows);
}

/// Displacements under a load that contain the ends of some elements, on a ring of all.
Stretch DividedLine::moved(const Eigen::SparseVector<double>& load, Elements around) const {
  if (!local_) return {0, factor_.solve(Eigen::VectorXd(load))};
  int first = line_.unknowns(), last = -1;
  for (int e = around.first; e < around.last; ++e) {
    const auto& [lowest, highest] = span_[static_cast<std::size_t>(e)];
    first = std::min(first, lowest);
    last = std::max(last, highest);
  }
  return local_->solve(load, std::min(first, last + 1), last + 1);
}

/// Displacements of an element's end unknowns under unit forces on them; [2d][2d].
const Eigen::MatrixXd& DividedLine::end_flexibility(int rail, int at) const {
  auto& known = end_flexibility_[line_.mirrored ? 0 : static_cast<std::size_t>(rail)];
  known.resize(static_cast<std::size_t>(tabled_elements(track_)));
  Eigen::MatrixXd& result = known[static_cast<std::size_t>(at)];
  if (result.size() > 0) return result;
  const std::vector<int> place = end_unknowns(line_, rail, element(rail), at);
  const auto n = static_cast<Eigen::Index>(place.size());
  result.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    result.col(j) =
        gather(moved(spread_over(line_, place, Eigen::VectorXd::Unit(n, j)), {at, at + 1}), place);
  return result;
}

Eigen::VectorXd DividedLine::under(const LoadPoint& load_point, const LoadPoint& other,
                                   int points) const {
  refuse_free_modes();
  const Superelement::Rows a = load_rows(load_point, points), b = load_rows(other, points);
  const Eigen::VectorXd held = element(load_point.rail).held(a, b).diagonal();
  Eigen::VectorXd result(tabled_elements(track_) * (points + 1));
  for (int e = 0; e < tabled_elements(track_); ++e) {
    const Eigen::MatrixXd& ends = end_flexibility(load_point.rail, e);
    for (int p = 0; p <= points; ++p)
      result[e * (points + 1) + p] = a.ends.row(p).dot(ends * b.ends.row(p).transpose()) + held[p];
  }
  return result;
}

LineFlexibility::Strip DividedLine::between(const LoadPoint& a, const LoadPoint& b, int points,
                                            int range) const {
  refuse_free_modes();
  const Superelement::Rows from = load_rows(a, points), to = load_rows(b, points);
  const bool same = same_rail(line_, a.rail, b.rail);
  const Eigen::MatrixXd held = same ? element(a.rail).held(from, to) : Eigen::MatrixXd();
  return [=, this](int at) {
    const std::vector<int> acting = end_unknowns(line_, a.rail, element(a.rail), at);
    const Elements around{std::max(at - range, 0), std::min(at + range + 1, track_.elements())};
    Eigen::MatrixXd strip = Eigen::MatrixXd::Zero(points + 1, (2 * range + 1) * (points + 1));
    for (int p = 0; p <= points; ++p) {
      const Stretch x = moved(spread_over(line_, acting, from.ends.row(p).transpose()), around);
      for (int shift = -range; shift <= range; ++shift)
        if (const int e = shifted(track_, at, shift); e >= 0)
          strip.row(p).segment((shift + range) * (points + 1), points + 1) =
              to.ends * gather(x, end_unknowns(line_, b.rail, element(b.rail), e));
    }
    if (same) strip.middleCols(range * (points + 1), points + 1) += held;
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
  const Eigen::VectorXd sleepers = sleeper_load(track_, line_, functional);
  Spread result{sleepers.sparseView(), {}};
  for (const Functional::OnRail& point : functional.rail) {
    const int rail = point.at.rail;
    if (line_.rail_factor[static_cast<std::size_t>(rail)] == 0.) continue;
    const int at = element_at(track_, point.at.x);
    const Superelement::Rows row = rail_rows({point.at, part * point.factor}, at);
    const std::vector<int> ends = end_unknowns(line_, rail, element(rail), at);
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (ends[i] >= 0) result.load.coeffRef(ends[i]) += row.ends(0, static_cast<Eigen::Index>(i));
    result.points.push_back({rail, at, row});
  }
  return result;
}

Eigen::VectorXd DividedLine::from(const LoadPoint& load_point, const Functional& functional,
                                  int points, Elements at) const {
  refuse_free_modes();
  const Superelement& own = element(load_point.rail);
  const Superelement::Rows rows = load_rows(load_point, points);
  const Spread read = spread(functional);
  const Stretch x = moved(read.load, at);
  Eigen::VectorXd result(at.count() * (points + 1));
  for (int e = at.first; e < at.last; ++e)
    result.segment((e - at.first) * (points + 1), points + 1) =
        rows.ends * gather(x, end_unknowns(line_, load_point.rail, own, e));
  for (const Spread::OnElement& point : read.points)
    if (same_rail(line_, load_point.rail, point.rail) && point.element >= at.first &&
        point.element < at.last)
      result.segment((point.element - at.first) * (points + 1), points + 1) +=
          own.held(rows, point.rows).col(0);
  return result;
}

Eigen::VectorXd DividedLine::flexibility(const std::vector<Functional>& reads,
                                         const Functional& force) const {
  refuse_free_modes();
  const Spread acting = spread(force);
  const Eigen::VectorXd x = factor_.solve(Eigen::VectorXd(acting.load));
  Eigen::VectorXd result(static_cast<Eigen::Index>(reads.size()));
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const Spread read = spread(reads[i]);
    double sum = read.load.dot(x);
    for (const Spread::OnElement& a : acting.points)
      for (const Spread::OnElement& b : read.points)
        if (a.element == b.element && same_rail(line_, a.rail, b.rail))
          sum += element(a.rail).held(a.rows, b.rows)(0, 0);
    result[static_cast<Eigen::Index>(i)] = sum;
  }
  return result;
}

}  // namespace railstep
