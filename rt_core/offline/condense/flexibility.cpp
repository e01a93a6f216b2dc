#include "offline/condense/flexibility.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "offline/math/refuse.h"
#include "offline/track/pad.h"

namespace railstep {

namespace {

/// Elements beyond which G_res counts as nothing, as a part of the largest G_exact(x, x).
constexpr double kNegligible = 1e-4;

std::vector<double> to_vector(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

/// Part of a functional's largest value that counts as 0. It is so small that outputs do not jump
/// where their tables end.
constexpr double kFaded = 1e-8;
/// Elements, and bays, to either side at which functionals and pairs are evaluated first. If the
/// outer quarter of these counts as 0, so do all places beyond: in full order the error of a mesh
/// fades with the distance.
struct FirstLook {
  int elements, bays;
};
constexpr FirstLook kFunctionalLook{96, 16}, kPairLook{24, 8};
int first_look(const FirstLook& look, const Track& track) {
  return std::max(look.elements, look.bays * track.elements_per_bay);
}
bool has_faded(int range, int look) { return 4 * range <= 3 * look; }

std::size_t place_in(const PairTable& table, int e, int p, int e2, int q) {
  const auto n = static_cast<std::size_t>(table.points) + 1;
  const auto blocks = 2 * static_cast<std::size_t>(table.range) + 1;
  const int shift = e2 - e + table.range;
  const std::size_t block = static_cast<std::size_t>(e) * blocks + static_cast<std::size_t>(shift);
  return (block * n + static_cast<std::size_t>(p)) * n + static_cast<std::size_t>(q);
}

/// All elements' strips in one table.
PairTable table_of(const LineFlexibility::Strip& strip, int elements, int points, int range) {
  const int n = points + 1;
  PairTable table{points, range, {}};
  table.value.reserve(place_in(table, elements, 0, elements - range, 0));
  for (int e = 0; e < elements; ++e) {
    const Eigen::MatrixXd row = strip(e);
    for (int shift = 0; shift <= 2 * range; ++shift)
      for (int p = 0; p < n; ++p)
        for (int q = 0; q < n; ++q) table.value.push_back(row(p, shift * n + q));
  }
  return table;
}

/// The distance, in elements, beyond which all values of strips stay below a limit. The strips are
/// not stored, since all pairs of elements would be their number squared.
int range_of(const LineFlexibility::Strip& strip, int elements, int points, int look,
             double limit) {
  int range = 0;
  for (int e = 0; e < elements; ++e) {
    const Eigen::MatrixXd row = strip(e);
    for (int shift = -look; shift <= look; ++shift)
      if (std::abs(shift) > range &&
          row.middleCols((shift + look) * (points + 1), points + 1).lpNorm<Eigen::Infinity>() >=
              limit)
        range = std::abs(shift);
  }
  return range;
}

/// Whether forces of load points move any of these unknowns.
/// @param vertical  these are vertical ones on y = 0 of upright rails
bool carries_any(const std::vector<int>& carried, bool vertical) {
  return std::any_of(carried.begin(), carried.end(), [&](int k) {
    return k == 2 || k == 8 || (!vertical && (k == 1 || k == 4 || k == 5 || k == 7));
  });
}

void check_functional(const Track& track, const Functional& functional) {
  const auto check = [&](int rail, int direction, int most) {
    if (rail < 0 || rail >= track.rails || direction < 0 || direction > most)
      refuse("E-CONDENSE-07",
             "a functional names a rail or a direction that the track does not have");
  };
  for (const Functional::OnRail& point : functional.rail) {
    check(point.at.rail, point.at.direction, 2);
    (void)element_at(track, point.at.x);
  }
  for (const Functional::OnSleeper& at : functional.sleeper) {
    check(at.rail, at.direction, 3);
    if (at.seat < 0 || at.seat > track.bays || !track.seat(at.seat).sleeper)
      refuse("E-CONDENSE-08", "a functional names a sleeper that the track does not have");
  }
}

/// The elements that hold a functional's points, and those beside its sleepers.
Elements elements_of(const Track& track, const Functional& functional) {
  Elements all{track.elements(), 0};
  const auto add = [&](int first, int last) {
    all = {std::min(all.first, first), std::max(all.last, last)};
  };
  for (const Functional::OnRail& point : functional.rail) {
    const int e = element_at(track, point.at.x);
    add(e, e + 1);
  }
  for (const Functional::OnSleeper& at : functional.sleeper) {
    const int e = at.seat * track.elements_per_bay;
    add(std::max(e - 1, 0), std::min(e + 1, track.elements()));
  }
  return {std::min(all.first, all.last), all.last};
}

}  // namespace

struct ResidualFlexibility::Pair {
  const Line* line;
  std::array<std::vector<int>, 2> carried;  // of each rail
  std::unique_ptr<LineFlexibility> exact, model;
};

ResidualFlexibility::~ResidualFlexibility() = default;

ResidualFlexibility::ResidualFlexibility(const Track& track, const std::vector<Line>& lines,
                                         const std::vector<Basis>& bases, int points, bool lateral)
    : track_(track), lines_(lines), bases_(bases), points_(points) {
  if (points < 3)
    refuse("E-CONDENSE-09",
           "residual flexibility has " + std::to_string(points) + " intervals; expected 3 or more");
  if (!bases.empty() && bases.size() != lines.size())
    refuse("E-CONDENSE-10", "residual flexibility has " + std::to_string(bases.size()) +
                                " bases for " + std::to_string(lines.size()) +
                                " lines; expected one for each line, or none");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const std::array<std::vector<int>, 2> carried = {carried_unknowns(line, 0),
                                                     carried_unknowns(line, 1)};
    // Lines that no force moves are not needed.
    const bool vertical = track.cant == 0. && !lateral;
    if (!carries_any(carried[0], vertical) && !carries_any(carried[1], vertical)) continue;
    Pair pair{&line, carried, exact_line(track_, line, points), nullptr};
    if (bases_.empty())
      pair.model = exact_line(track_, line, 1);
    else
      pair.model = std::make_unique<ReducedLine>(track_, line, bases_[i]);
    pairs_.push_back(std::move(pair));
  }
}

/// Weight of the load point in the line, 0 if it does not move the line.
double ResidualFlexibility::weight(const Pair& pair, LoadPoint load_point) const {
  if (load_point.rail < 0 || load_point.rail >= track_.rails)
    refuse("E-CONDENSE-11",
           "residual flexibility is asked for on a rail that the track does not have");
  const auto rail = static_cast<std::size_t>(load_point.rail);
  double row[9];
  load_row(track_, load_point, row);
  const std::vector<int>& carried = pair.carried[rail];
  const bool moved =
      std::any_of(carried.begin(), carried.end(), [&](int k) { return row[k] != 0.; });
  return moved ? pair.line->rail_factor[rail] : 0.;
}

std::vector<double> ResidualFlexibility::under(LoadPoint load_point) const {
  return under(load_point, load_point);
}

std::vector<double> ResidualFlexibility::under(LoadPoint load_point, LoadPoint other) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(tabled_elements(track_) * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, load_point) * weight(pair, other);
    if (w == 0.) continue;
    sum += w * (pair.exact->under(load_point, other, points_) -
                pair.model->under(load_point, other, points_));
  }
  return to_vector(sum);
}

std::vector<double> ResidualFlexibility::exact_under(LoadPoint load_point) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(tabled_elements(track_) * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, load_point);
    if (w != 0.) sum += w * w * pair.exact->under(load_point, load_point, points_);
  }
  return to_vector(sum);
}

std::vector<double> ResidualFlexibility::from(LoadPoint load_point,
                                              const Functional& functional) const {
  return to_vector(sums(load_point, functional, {0, track_.elements()}).missing);
}

ResidualFlexibility::Sums ResidualFlexibility::sums(LoadPoint load_point,
                                                    const Functional& functional,
                                                    Elements at) const {
  check_functional(track_, functional);
  Sums sum{Eigen::VectorXd::Zero(at.count() * (points_ + 1)), 0.};
  Eigen::VectorXd exact = sum.missing;
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, load_point);
    if (w == 0.) continue;
    const Eigen::VectorXd own = w * pair.exact->from(load_point, functional, points_, at);
    exact += own;
    sum.missing += own - w * pair.model->from(load_point, functional, points_, at);
  }
  sum.largest_exact = exact.lpNorm<Eigen::Infinity>();
  return sum;
}

/// The first and the last element with a value that does not count as 0.
Elements ResidualFlexibility::filled(const Sums& sums, Elements at, double nothing) const {
  Elements found{at.last, at.first};
  for (int e = at.first; e < at.last; ++e) {
    const auto there = sums.missing.segment((e - at.first) * (points_ + 1), points_ + 1);
    if (there.lpNorm<Eigen::Infinity>() > nothing) found = {std::min(found.first, e), e + 1};
  }
  return found;
}

ResidualFlexibility::Near ResidualFlexibility::near(const std::vector<LoadPoint>& load_points,
                                                    const Functional& functional,
                                                    Elements among) const {
  const bool whole = !bases_.empty() || track_.ring;
  const Elements all{among.first, std::min(among.last, track_.elements())};
  const Elements own = whole ? all : elements_of(track_, functional);
  for (int look = first_look(kFunctionalLook, track_);; look *= 2) {
    const Elements at{std::max(own.first - look, 0), std::min(own.last + look, all.last)};
    std::vector<Sums> of_load_point;
    of_load_point.reserve(load_points.size());
    double largest = 0.;
    for (const LoadPoint& load_point : load_points)
      largest = std::max(
          largest, of_load_point.emplace_back(sums(load_point, functional, at)).largest_exact);
    Elements found = own;
    for (const Sums& sum : of_load_point) {
      const Elements more = filled(sum, at, kFaded * largest);
      found = {std::min(found.first, more.first), std::max(found.last, more.last)};
    }
    const int range = std::max(own.first - found.first, found.last - own.last);
    if (!has_faded(range, look) && at.count() < all.count()) continue;
    Near near{found, {}};
    near.value.reserve(load_points.size() *
                       static_cast<std::size_t>(found.count() * (points_ + 1)));
    for (const Sums& sum : of_load_point) {
      const double* const first = sum.missing.data() + (found.first - at.first) * (points_ + 1);
      near.value.insert(near.value.end(), first, first + found.count() * (points_ + 1));
    }
    return near;
  }
}

std::vector<double> ResidualFlexibility::at_once(LoadPoint load_point, const Functional& functional,
                                                 Elements at) const {
  check_functional(track_, functional);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(at.count() * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const auto i = static_cast<std::size_t>(pair.line - lines_.data());
    const double w = weight(pair, load_point);
    if (w == 0. || bases_.empty() || bases_[i].at_once.size() == 0) continue;
    sum +=
        w * ReducedLine(track_, *pair.line, bases_[i]).at_once(load_point, functional, points_, at);
  }
  return to_vector(sum);
}

double PairTable::at(int e, int p, int e2, int q) const {
  if (std::abs(e2 - e) > range) return 0.;
  return value[place_in(*this, e, p, e2, q)];
}

/// Sum over the lines that both load points move.
LineFlexibility::Strip ResidualFlexibility::strips(LoadPoint a, LoadPoint b, int points,
                                                   int range) const {
  struct Part {
    double weight;
    LineFlexibility::Strip exact, model;
  };
  std::vector<Part> parts;
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, a) * weight(pair, b);
    if (w != 0.)
      parts.push_back(
          {w, pair.exact->between(a, b, points, range), pair.model->between(a, b, points, range)});
  }
  const Eigen::Index rows = points + 1, columns = (2 * range + 1) * rows;
  return [parts, rows, columns](int element) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, columns);
    for (const Part& part : parts) sum += part.weight * (part.exact(element) - part.model(element));
    return sum;
  };
}

double ResidualFlexibility::largest_exact(LoadPoint load_point) const {
  const std::vector<double> exact = exact_under(load_point);
  return *std::max_element(exact.begin(), exact.end());
}

PairTable ResidualFlexibility::between(LoadPoint a, LoadPoint b, int points, int most) const {
  if (points < 1 || points_ % points != 0)
    refuse("E-CONDENSE-12", "a table between load points has " + std::to_string(points) +
                                " points; expected a divisor of the " + std::to_string(points_) +
                                " points of the track");
  most = std::min(most, track_.elements() - 1);
  const double limit = kNegligible * std::max(largest_exact(a), largest_exact(b));
  const int elements = tabled_elements(track_);
  // The error of a basis is not local.
  int look = std::min(most, bases_.empty() ? first_look(kPairLook, track_) : most);
  int range = range_of(strips(a, b, points, look), elements, points, look, limit);
  while (look < most && !has_faded(range, look)) {
    look = std::min(most, 2 * look);
    range = range_of(strips(a, b, points, look), elements, points, look, limit);
  }
  return table_of(strips(a, b, points, range), elements, points, range);
}

}  // namespace railstep
