#include "offline/analysis/damped.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "offline/analysis/krylov.h"
#include "offline/analysis/modes.h"
#include "offline/analysis/rigid.h"
#include "offline/analysis/statics.h"
#include "offline/math/complex.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kSwings = 1e-6;                   // Im rate/|rate| of what is not overdamped
constexpr double kConverged = 1e-10;               // of a Ritz value
constexpr double kGood = 1e-10, kAccepted = 1e-8;  // residual: sought, and demanded
constexpr int kMostUnknowns = 100'000;             // of a damped line: 400 vectors of it are 1.3 GB
constexpr double kBeyond = 10.;  // of the highest undamped rate: above the effect of dampers
constexpr int kFirst = 60, kMore = 40, kMost = 800;  // vectors of the Krylov space

/// The root nearest to `rate` of shape' Q(rate) shape = 0, plain transpose. As Q is symmetric, the
/// error of the root is of second order in the error of the shape.
ComplexNumber improved(const Line& line, ComplexNumber rate, const Eigen::VectorXcd& shape) {
  const auto product = [&](const Eigen::SparseMatrix<double>& A) -> ComplexNumber {
    return (shape.transpose() * (A.cast<ComplexNumber>() * shape))(0, 0);
  };
  const ComplexNumber m = product(line.mass), c = product(line.damping),
                      k = product(line.stiffness);
  const ComplexNumber root = std::sqrt(c * c - 4. * m * k);
  if (!(std::abs(m * rate * rate) > 1e-8 * std::abs(k))) return rate;
  const ComplexNumber a = (-c + root) / (2. * m), b = (-c - root) / (2. * m);
  return std::abs(a - rate) < std::abs(b - rate) ? a : b;
}

/// One step of inverse iteration: Q(rate) next = Q'(rate) shape.
Eigen::VectorXcd inverse_step(const Line& line, ComplexNumber rate, const Eigen::VectorXcd& shape) {
  const Eigen::SparseLU<Eigen::SparseMatrix<ComplexNumber>> factor(dynamic_stiffness(line, rate));
  if (factor.info() != Eigen::Success) return shape;  // an exact rate
  const Eigen::VectorXcd force = 2. * rate * (line.mass.cast<ComplexNumber>() * shape) +
                                 line.damping.cast<ComplexNumber>() * shape;
  const Eigen::VectorXcd next = factor.solve(force);
  return next.allFinite() && next.norm() > 0. ? Eigen::VectorXcd(next / next.norm()) : shape;
}

/// The residual that rounding of K x alone may leave; it is largest for modes far below the
/// highest.
double rounding(const Line& line, const Eigen::VectorXcd& shape) {
  const Eigen::VectorXd terms = line.stiffness.cwiseAbs() * shape.cwiseAbs();
  const double left = 10. * std::numeric_limits<double>::epsilon() * terms.norm();
  return left / (2. * (line.stiffness.cast<ComplexNumber>() * shape).norm());
}

void refine(const Line& line, ComplexNumber& rate, Eigen::VectorXcd& shape) {
  rate = improved(line, rate, shape);
  for (int iteration = 0; iteration < 3 && residual(line, rate, shape) > kGood; ++iteration) {
    shape = inverse_step(line, rate, shape);
    rate = improved(line, rate, shape);
  }
  if (!(residual(line, rate, shape) <= std::max(kAccepted, rounding(line, shape))))
    fail("E-MODES-02", "a damped mode near " + std::to_string(std::abs(rate) / (kTwoPi)) +
                           " Hz does not converge; ask for fewer modes or shorten the track");
}

/// The swinging Ritz pairs with |rate| <= radius; nothing if some are not yet sharp.
std::optional<std::vector<Krylov::Ritz>> sharp(const Line& line, const Krylov& space,
                                               ComplexNumber shift, double radius) {
  // The quarter disc of that radius lies within this distance of its middle.
  std::vector<Krylov::Ritz> all = space.within(1.01 * std::abs(shift)), found;
  for (Krylov::Ritz& r : all) {
    const double size = std::abs(r.rate);
    if (!(size <= radius) || r.rate.imag() < kSwings * size) continue;
    if (is_rigid(line.stiffness, r.shape)) continue;
    if (!space.complete() && !(r.error <= kConverged)) return std::nullopt;
    found.push_back(std::move(r));
  }
  std::sort(found.begin(), found.end(), [](const Krylov::Ritz& a, const Krylov::Ritz& b) {
    return std::abs(a.rate) < std::abs(b.rate);
  });
  return found;
}

/// The highest undamped rate of a small line, 1/s. A mode that swings has |rate|^2 = shape* K
/// shape/(shape* M shape), never over its square where all unknowns carry mass.
double highest_rate(const Line& line) {
  const Modes all = modes(line);
  return all.frequency.size() == 0 ? 0. : kTwoPi * all.frequency.maxCoeff();
}

struct Search {
  std::vector<Krylov::Ritz> found;
  bool complete;  // the space held every rate, those beyond the radius too
};

/// All swinging modes with |rate| <= radius. The Krylov space grows until it knows them sharply and
/// a further growth adds none: members of a cluster come out one after the other.
Search search(const Line& line, double radius) {
  const ComplexNumber shift(-.5 * radius, .5 * radius);
  Krylov space(line, shift);
  std::optional<std::size_t> before;
  for (Eigen::Index size = kFirst; size <= kMost; size += std::max<Eigen::Index>(kMore, size / 4)) {
    space.grow(size);
    auto found = sharp(line, space, shift, radius);
    if (found && (space.complete() || before == found->size()))
      return {std::move(*found), space.complete()};
    before = found ? std::optional(found->size()) : std::nullopt;
  }
  fail("E-MODES-03",
       "the damped modes up to " + std::to_string(radius / (kTwoPi)) +
           " Hz lie too close to be told apart; ask for fewer modes or shorten the track");
}

}  // namespace

double residual(const Line& line, ComplexNumber rate, const Eigen::VectorXcd& shape) {
  const Eigen::VectorXcd inertia = rate * rate * (line.mass.cast<ComplexNumber>() * shape);
  const Eigen::VectorXcd damping = rate * (line.damping.cast<ComplexNumber>() * shape);
  const Eigen::VectorXcd elastic = line.stiffness.cast<ComplexNumber>() * shape;
  return (inertia + damping + elastic).norm() / (inertia.norm() + damping.norm() + elastic.norm());
}

Oscillations oscillations(const Line& line, double radius) {
  if (line.unknowns() > kMostUnknowns)
    fail("E-MODES-04", "the damped modes of a line of " + std::to_string(line.unknowns()) +
                           " unknowns cannot be found; expected at most " +
                           std::to_string(kMostUnknowns) + ": shorten the track");
  Search result = search(line, radius);
  Oscillations modes;
  modes.all = result.complete && radius > kBeyond * highest_rate(line);
  modes.rate.resize(static_cast<Eigen::Index>(result.found.size()));
  modes.shape.resize(line.unknowns(), modes.rate.size());
  for (Eigen::Index i = 0; i < modes.rate.size(); ++i) {
    Krylov::Ritz& r = result.found[static_cast<std::size_t>(i)];
    refine(line, r.rate, r.shape);
    modes.rate[i] = r.rate;
    modes.shape.col(i) = r.shape;
  }
  return modes;
}

namespace {

using Listed = std::pair<double, double>;  // frequency, ratio

/// The lowest `count`, sorted.
void keep_lowest(std::vector<Listed>& modes, int count) {
  std::stable_sort(modes.begin(), modes.end());
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
}

/// The damped modes up to a frequency, Hz; whether these are all there are.
bool add_damped(const std::vector<Line>& damped, double frequency, std::vector<Listed>& to) {
  bool all = true;
  for (const Line& line : damped) {
    const Oscillations found = oscillations(line, kTwoPi * frequency);
    for (const ComplexNumber rate : found.rate)
      to.emplace_back(std::abs(rate) / (kTwoPi), -rate.real() / std::abs(rate));
    all = all && found.all;
  }
  return all;
}

}  // namespace

NaturalModes natural_modes(const Track& track, int count) {
  std::vector<Listed> sure, undamped;  // of lines without dampers and rigid; of all without theirs
  std::vector<Line> damped;
  for (const Line& line : assemble(track)) {
    const bool has_dampers = line.damping.norm() > 0.;
    for (const double frequency : lowest_modes(line, count).frequency) {
      undamped.emplace_back(frequency, 0.);
      if (!has_dampers || frequency == 0.) sure.emplace_back(frequency, 0.);
    }
    if (has_dampers) damped.push_back(line);
  }
  keep_lowest(undamped, count);
  std::vector<Listed> found = sure;
  // Dampers may raise rates (a part that they hold still is stiffer) and take low modes out of the
  // list.
  double highest = undamped.empty() ? 1. : std::max(1.05 * undamped.back().first, 1.);
  for (bool all = damped.empty(); !all; highest *= 1.3) {
    found = sure;
    all = add_damped(damped, highest, found);
    keep_lowest(found, count);
    all = all || (static_cast<int>(found.size()) == count && found.back().first <= highest);
  }
  keep_lowest(found, count);
  NaturalModes result;
  for (const auto& [frequency, ratio] : found) {
    result.frequency.push_back(frequency);
    result.damping_ratio.push_back(ratio);
  }
  return result;
}

}  // namespace railstep
