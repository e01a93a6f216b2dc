#include "offline/condense/flexibility.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "offline/track/pad.h"

namespace railstep {

namespace {

/// Elements beyond which G_res counts as nothing, as a part of the largest G_exact(x, x).
constexpr double kNegligible = 1e-4;

std::vector<double> to_vector(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

std::size_t place_in(const PairTable& table, int e, int p, int e2, int q) {
  const auto n = static_cast<std::size_t>(table.points) + 1;
  const auto blocks = 2 * static_cast<std::size_t>(table.reach) + 1;
  const int shift = e2 - e + table.reach;
  const std::size_t block = static_cast<std::size_t>(e) * blocks + static_cast<std::size_t>(shift);
  return (block * n + static_cast<std::size_t>(p)) * n + static_cast<std::size_t>(q);
}

/// The element that lies `shift` elements on, round a ring; -1: off the rail.
int shifted(const Track& track, int e, int shift) {
  const int elements = track.elements(), e2 = e + shift;
  if (track.ring) return (e2 % elements + elements) % elements;
  return e2 >= 0 && e2 < elements ? e2 : -1;
}

/// Takes from the strip of element e what lies within the table's reach.
void keep(const Eigen::MatrixXd& strip, int e, const Track& track, PairTable& table) {
  const int n = table.points + 1;
  for (int shift = -table.reach; shift <= table.reach; ++shift) {
    const int e2 = shifted(track, e, shift);
    for (int p = 0; p < n && e2 >= 0; ++p)
      for (int q = 0; q < n; ++q)
        table.value[place_in(table, e, p, e + shift, q)] = strip(p, e2 * n + q);
  }
}

/// Whether a vertical force moves any of these, on y = 0 of an upright rail or anywhere.
bool carries_any(const std::vector<int>& carried, bool upright) {
  return std::any_of(carried.begin(), carried.end(), [&](int k) {
    return k == 2 || k == 8 || (!upright && (k == 1 || k == 4 || k == 5 || k == 7));
  });
}

void check_functional(const Track& track, const Functional& functional) {
  const auto check = [&](int rail, int direction, int most) {
    if (rail < 0 || rail >= track.rails || direction < 0 || direction > most)
      throw std::out_of_range("a functional names a rail or a direction that the track lacks");
  };
  for (const Functional::OnRail& point : functional.rail) {
    check(point.at.rail, point.at.direction, 2);
    (void)element_at(track, point.at.x);
  }
  for (const Functional::OnSleeper& at : functional.sleeper) {
    check(at.rail, at.direction, 3);
    if (at.seat < 0 || at.seat > track.bays || !track.seat(at.seat).sleeper)
      throw std::out_of_range("a functional names a sleeper that the track lacks");
  }
}

}  // namespace

struct ResidualFlexibility::Pair {
  const Line* line;
  std::array<std::vector<int>, 2> carried;  // of each rail
  std::unique_ptr<LineFlexibility> exact, model;
};

ResidualFlexibility::~ResidualFlexibility() = default;

ResidualFlexibility::ResidualFlexibility(const Track& track, const std::vector<Line>& lines,
                                         const std::vector<Basis>& bases, int points)
    : track_(track), lines_(lines), bases_(bases), points_(points) {
  if (points < 3) throw std::invalid_argument("residual flexibility needs 3 intervals or more");
  if (!bases.empty() && bases.size() != lines.size())
    throw std::invalid_argument("residual flexibility needs one basis per line, or none");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const std::array<std::vector<int>, 2> carried = {carried_unknowns(line, 0),
                                                     carried_unknowns(line, 1)};
    // The others nothing here asks for.
    const bool upright = track.cant == 0.;
    if (!carries_any(carried[0], upright) && !carries_any(carried[1], upright)) continue;
    Pair pair{&line, carried, exact_line(track_, line, points), nullptr};
    if (bases_.empty())
      pair.model = exact_line(track_, line, 1);
    else
      pair.model = std::make_unique<ReducedLine>(track_, line, bases_[i]);
    pairs_.push_back(std::move(pair));
  }
}

/// Weight of the port in the line, 0 if it does not move the line.
double ResidualFlexibility::weight(const Pair& pair, Port port) const {
  if (port.rail < 0 || port.rail >= track_.rails)
    throw std::invalid_argument("residual flexibility is asked on a rail that the track lacks");
  const auto rail = static_cast<std::size_t>(port.rail);
  double row[9];
  height_row(track_.lean(port.rail), port.y, port.z, row);
  const std::vector<int>& carried = pair.carried[rail];
  const bool moved =
      std::any_of(carried.begin(), carried.end(), [&](int k) { return row[k] != 0.; });
  return moved ? pair.line->rail_factor[rail] : 0.;
}

std::vector<double> ResidualFlexibility::under(Port port) const { return under(port, port); }

std::vector<double> ResidualFlexibility::under(Port port, Port seen) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(tabled_elements(track_) * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, port) * weight(pair, seen);
    if (w == 0.) continue;
    sum += w * (pair.exact->under(port, seen, points_) - pair.model->under(port, seen, points_));
  }
  return to_vector(sum);
}

std::vector<double> ResidualFlexibility::exact_under(Port port) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(tabled_elements(track_) * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, port);
    if (w != 0.) sum += w * w * pair.exact->under(port, port, points_);
  }
  return to_vector(sum);
}

std::vector<double> ResidualFlexibility::from(Port port, const Functional& functional) const {
  check_functional(track_, functional);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(track_.elements() * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, port);
    if (w == 0.) continue;
    sum += w * (pair.exact->from(port, functional, points_) -
                pair.model->from(port, functional, points_));
  }
  return to_vector(sum);
}

std::vector<double> ResidualFlexibility::at_once(Port port, const Functional& functional) const {
  check_functional(track_, functional);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(track_.elements() * (points_ + 1));
  for (const Pair& pair : pairs_) {
    const auto i = static_cast<std::size_t>(pair.line - lines_.data());
    const double w = weight(pair, port);
    if (w == 0. || bases_.empty() || bases_[i].at_once.size() == 0) continue;
    sum += w * ReducedLine(track_, *pair.line, bases_[i]).at_once(port, functional, points_);
  }
  return to_vector(sum);
}

double PairTable::at(int e, int p, int e2, int q) const {
  if (std::abs(e2 - e) > reach) return 0.;
  return value[place_in(*this, e, p, e2, q)];
}

/// Sum over the lines that both ports move.
LineFlexibility::Strip ResidualFlexibility::strips(Port a, Port b, int points) const {
  struct Part {
    double weight;
    LineFlexibility::Strip exact, model;
  };
  std::vector<Part> parts;
  for (const Pair& pair : pairs_) {
    const double w = weight(pair, a) * weight(pair, b);
    if (w != 0.)
      parts.push_back({w, pair.exact->between(a, b, points), pair.model->between(a, b, points)});
  }
  const Eigen::Index rows = points + 1, columns = track_.elements() * (points + 1);
  return [parts, rows, columns](int element) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, columns);
    for (const Part& part : parts) sum += part.weight * (part.exact(element) - part.model(element));
    return sum;
  };
}

double ResidualFlexibility::largest_exact(Port port) const {
  const std::vector<double> exact = exact_under(port);
  return *std::max_element(exact.begin(), exact.end());
}

PairTable ResidualFlexibility::between(Port a, Port b, int points, int most) const {
  if (points < 1 || points_ % points != 0)
    throw std::invalid_argument("a table between ports takes a divisor of the points of the track");
  const LineFlexibility::Strip strip = strips(a, b, points);
  const int elements = tabled_elements(track_), n = points + 1;
  most = std::min(most, track_.elements() - 1);
  // Two passes over the strips: the whole table would be elements^2 blocks.
  std::vector<double> largest(static_cast<std::size_t>(most) + 1, 0.);  // by distance in elements
  for (int e = 0; e < elements; ++e) {
    const Eigen::MatrixXd row = strip(e);
    for (int shift = -most; shift <= most; ++shift) {
      const int e2 = shifted(track_, e, shift);
      double& there = largest[static_cast<std::size_t>(std::abs(shift))];
      if (e2 >= 0) there = std::max(there, row.middleCols(e2 * n, n).cwiseAbs().maxCoeff());
    }
  }
  const double limit = kNegligible * std::max(largest_exact(a), largest_exact(b));
  PairTable table{points, most, {}};
  while (table.reach > 0 && largest[static_cast<std::size_t>(table.reach)] < limit) --table.reach;
  table.value.assign(
      static_cast<std::size_t>(elements * (2 * table.reach + 1)) * static_cast<std::size_t>(n * n),
      0.);
  for (int e = 0; e < elements; ++e) keep(strip(e), e, track_, table);
  return table;
}

double most_negative(const std::vector<double>& table) {
  double lowest = 0.;
  for (const double value : table) lowest = std::min(lowest, value);
  return lowest;
}

}  // namespace railstep
