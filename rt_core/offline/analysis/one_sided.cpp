#include "offline/analysis/one_sided.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "offline/math/refuse.h"
#include "offline/math/sparse.h"

namespace railstep {

namespace {

using Factor = Eigen::SimplicialLDLT<Sparse>;

constexpr int kMostIterations = 200;
constexpr double kLittle = 1e-6;  // of an open spring's stiffness

}  // namespace

OneSided::OneSided(const Track& track, const std::vector<Line>& lines, std::vector<FixedPort> ports)
    : ports_(std::move(ports)), joined_(join(track, lines, ports_)) {
  const Sparse all = stiffness(Closed(ports_.size(), true), 0.);
  all_closed_.compute(all);
  if (is_held(all_closed_, all)) return;
  refuse_free_modes(track, lines, ports_);  // by its name
  refuse("E-TRACK-37",
         "the stiffness of the track cannot be factored; expected stiffnesses that differ by fewer "
         "orders of magnitude");
}

Sparse OneSided::stiffness(const Closed& closed, double open_fraction) const {
  Eigen::VectorXd k(static_cast<Eigen::Index>(ports_.size()));
  for (std::size_t p = 0; p < ports_.size(); ++p)
    k[static_cast<Eigen::Index>(p)] = (closed[p] ? 1. : open_fraction) * ports_[p].stiffness;
  return joined_.stiffness + Sparse(joined_.closing * k.asDiagonal() * joined_.closing.transpose());
}

Eigen::VectorXd OneSided::depth(const Eigen::VectorXd& u) const {
  Eigen::VectorXd d = joined_.closing.transpose() * u;
  for (std::size_t p = 0; p < ports_.size(); ++p) d[static_cast<Eigen::Index>(p)] -= ports_[p].gap;
  return d;
}

OneSided::Closed OneSided::closed_at(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd d = depth(u);
  Closed closed;
  for (const double own : d) closed.push_back(own >= 0.);
  return closed;
}

/// K u + forces of the springs - f.
Eigen::VectorXd OneSided::gradient(const Eigen::VectorXd& u, const Eigen::VectorXd& load) const {
  Eigen::VectorXd force = depth(u).cwiseMax(0.);
  for (std::size_t p = 0; p < ports_.size(); ++p)
    force[static_cast<Eigen::Index>(p)] *= ports_[p].stiffness;
  return joined_.stiffness * u + joined_.closing * force - load;
}

/// If too few springs are closed to hold the track, the open ones hold it a little, and the step
/// goes as far as the next spring that closes. If the track then buckles, they hold it as if all
/// were closed. Both steps lower E.
Eigen::VectorXd OneSided::newton_step(const Closed& closed, const Eigen::VectorXd& g) const {
  for (const double open_fraction : {0., kLittle}) {
    const Sparse held = stiffness(closed, open_fraction);
    const Factor factor(held);
    if (is_held(factor, held)) return factor.solve(-g);
  }
  return all_closed_.solve(-g);
}

/// The t >= 0 of the least E(u + t step): its slope rises in t along straight pieces that end where
/// a spring closes or opens.
double OneSided::minimum_along(const Eigen::VectorXd& u, const Eigen::VectorXd& step,
                               const Eigen::VectorXd& load) const {
  const Eigen::VectorXd d = depth(u), s = joined_.closing.transpose() * step;
  const Eigen::VectorXd Ks = joined_.stiffness * step;
  const double start = step.dot(joined_.stiffness * u - load), curvature = step.dot(Ks);
  const auto slope = [&](double t) {
    double sum = start + t * curvature;
    for (std::size_t p = 0; p < ports_.size(); ++p) {
      const auto i = static_cast<Eigen::Index>(p);
      sum += ports_[p].stiffness * std::max(0., d[i] + t * s[i]) * s[i];
    }
    return sum;
  };
  std::vector<double> ends;
  for (Eigen::Index i = 0; i < d.size(); ++i)
    if (s[i] != 0. && -d[i] / s[i] > 0.) ends.push_back(-d[i] / s[i]);
  std::sort(ends.begin(), ends.end());
  double from = 0.;
  for (const double to : ends) {
    const double low = slope(from), high = slope(to);
    if (high >= 0.) return high > low ? from - low * (to - from) / (high - low) : from;
    from = to;
  }
  const double low = slope(from), more = slope(from + 1.) - low;
  if (low >= 0.) return from;
  double all = curvature;
  for (std::size_t p = 0; p < ports_.size(); ++p)
    all += ports_[p].stiffness * std::pow(s[static_cast<Eigen::Index>(p)], 2);
  if (!(more > 1e-12 * all))
    refuse(
        "E-TRACK-38",
        "no equilibrium: the loads lift the track off the one-sided supports that should hold it; "
        "expected track.gravity = true, a load that presses down, or step.start = \"released\"");
  return from - low / more;
}

std::vector<Eigen::VectorXd> OneSided::solve(const std::vector<Eigen::VectorXd>& load) const {
  Eigen::VectorXd f(joined_.first.back());
  for (std::size_t l = 0; l < load.size(); ++l)
    f.segment(joined_.first[l], load[l].size()) = load[l];
  // A track under its usual load rests with all springs closed, so the search begins there.
  Eigen::VectorXd gaps(static_cast<Eigen::Index>(ports_.size()));
  double largest_gap = 0.;  // m; a spring that rests closed does not move
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    gaps[static_cast<Eigen::Index>(p)] = ports_[p].stiffness * ports_[p].gap;
    largest_gap = std::max(largest_gap, std::abs(ports_[p].gap));
  }
  Eigen::VectorXd u = all_closed_.solve(f + joined_.closing * gaps);
  Closed closed = closed_at(u);
  bool done = false;
  for (int iteration = 0; iteration < kMostIterations && !done; ++iteration) {
    const Eigen::VectorXd step = newton_step(closed, gradient(u, f));
    const double length = minimum_along(u, step, f);
    u += length * step;
    const Closed now = closed_at(u);
    // A whole step that changes no spring's state solved the linear system of that state; a spring
    // that flickers about 0 no longer moves anything.
    const double nothing = std::max(1e-9 * u.norm(), 1e-12 * largest_gap);
    done = (now == closed && std::abs(length - 1.) < 1e-6) || step.norm() <= nothing;
    closed = now;
  }
  if (!done)
    refuse("E-TRACK-39",
           "no equilibrium was found: the one-sided supports open and close again and again; use "
           "step.start = \"released\"");
  std::vector<Eigen::VectorXd> result;
  for (std::size_t l = 0; l < load.size(); ++l)
    result.emplace_back(u.segment(joined_.first[l], load[l].size()));
  return result;
}

std::vector<double> OneSided::forces(const std::vector<Eigen::VectorXd>& displacement) const {
  Eigen::VectorXd u(joined_.first.back());
  for (std::size_t l = 0; l < displacement.size(); ++l)
    u.segment(joined_.first[l], displacement[l].size()) = displacement[l];
  const Eigen::VectorXd d = depth(u);
  std::vector<double> result;
  for (std::size_t p = 0; p < ports_.size(); ++p)
    result.push_back(ports_[p].stiffness * std::max(0., d[static_cast<Eigen::Index>(p)]));
  return result;
}

}  // namespace railstep
