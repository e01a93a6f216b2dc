// Compares the coupled contact solve with bisection in long double.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "online/contact/ports.h"
#include "support/random_draw.h"

// Doubles enter long double arithmetic here on purpose.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

using Real = long double;

Real energy(Real C, Real d) { return d > 0.L ? .4L * C * d * d * std::sqrt(d) : 0.L; }
Real hertz(Real C, Real d) { return d > 0.L ? C * d * std::sqrt(d) : 0.L; }

/// Mean of Hertz's law between two depths. Where the depths differ by less than a tenth, Gauss's
/// five points give it with a relative error of 1e-18.
Real mean_of(Real C, Real d, Real e) {
  const Real way = d - e;
  if (std::fabs(way) > .1L * std::fmax(std::fabs(d), std::fabs(e)))
    return (energy(C, d) - energy(C, e)) / way;
  const Real a = std::sqrt(5.L - 2.L * std::sqrt(10.L / 7.L)) / 3.L;
  const Real b = std::sqrt(5.L + 2.L * std::sqrt(10.L / 7.L)) / 3.L;
  const Real wa = (322.L + 13.L * std::sqrt(70.L)) / 900.L;
  const Real wb = (322.L - 13.L * std::sqrt(70.L)) / 900.L;
  const Real mid = e + .5L * way;
  Real sum = 128.L / 225.L * hertz(C, mid);
  for (const Real side : {-1.L, 1.L})
    sum += wa * hertz(C, mid + side * .5L * way * a) + wb * hertz(C, mid + side * .5L * way * b);
  return .5L * sum;
}

/// A port's law, as ports.h states it.
Real law_force(const PortLaw& law, Real d) {
  if (law.mean) return mean_of(law.hertz, d, law.from);
  if (law.bilateral) return law.slope * d + law.jump;
  if (!(d > 0.L)) return 0.L;
  if (law.hertz > 0.) return hertz(law.hertz, d);
  const Real part = law.jump > 0. ? std::fmin(1.L, d / kJumpDepth) : 1.L;
  return std::fmax(0.L, law.slope * d + law.jump * part);
}

/// Solves d + w f(d) = free by halving: f rises, so d lies between free and free - w f(free).
Real depth_by_bisection(const PortLaw& law, Real w, Real free) {
  const Real there = free - w * law_force(law, free);
  Real low = std::fmin(free, there), high = std::fmax(free, there);
  for (int i = 0; i < 80; ++i) {
    const Real middle = .5L * (low + high);
    (middle + w * law_force(law, middle) > free ? high : low) = middle;
  }
  return .5L * (low + high);
}

/// Some ports as a step may meet them.
struct Problem {
  int n;
  std::vector<double> W, free, start;
  std::vector<PortLaw> law;
  double condition, least;  // largest eigenvalue of W over the least; the least, m/N
};

PortLaw random_law(Draw& draw) {
  PortLaw law{0., 0., 0.};
  const double kind = draw.between(0., 4.);
  if (kind < 2.) {
    law.hertz = draw.of_any_size(1e9, 1e12);
    law.mean = kind < 1.;
    if (law.mean) law.from = draw.between(-1., 1.) * draw.of_any_size(1e-8, 1e-4);
    return law;
  }
  law.slope = draw.of_any_size(1e5, 1e11);
  if (draw.chance(.5)) law.jump = draw.between(-1e4, 1e4);
  law.bilateral = kind < 3.;
  return law;
}

/// Random ports; W is A A' of a random A plus a part of the identity, times a random size.
Problem random_problem(Draw& draw, int n) {
  Problem p{n, {}, {}, {}, {}, 1., 0.};
  const double size = draw.of_any_size(1e-12, 1e-6), own = draw.of_any_size(1e-2, 1.);
  Eigen::MatrixXd A(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) A(i, j) = draw.between(-1., 1.);
  const Eigen::MatrixXd W = size * (A * A.transpose() + own * Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(W).eigenvalues();
  p.condition = values[n - 1] / values[0];
  p.least = values[0];
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) p.W.push_back(i <= j ? W(i, j) : W(j, i));
    p.law.push_back(random_law(draw));
    p.free.push_back(draw.between(-.5, 1.) * draw.of_any_size(1e-8, 1e-3));
    p.start.push_back(draw.chance(.5) ? 0. : draw.of_any_size(1., 1e6));
  }
  return p;
}

/// Results of the solve and of the slow way.
struct Found {
  PortResult result;
  std::vector<double> f, d;
  std::vector<Real> slow_f, slow_d;
  Real left;   // last change of the slow way, m
  Real scale;  // largest |free| + sum |W| f; kPortTolerance is relative to it
};

/// The slow way solves port after port by bisection under the others' forces until nothing moves.
/// It descends a convex function along its coordinates.
Found solve_both_ways(const Problem& p) {
  const auto n = static_cast<std::size_t>(p.n);
  Found x{
      {},  p.start, std::vector<double>(n), std::vector<Real>(n, 0.L), std::vector<Real>(n, 0.L),
      0.L, 0.L};
  x.result = solve_ports(p.n, p.W.data(), p.law.data(), p.free.data(), x.f.data(), x.d.data());
  for (int sweep = 0; sweep < 20000; ++sweep) {
    Real moved = 0.L;
    x.scale = 0.L;
    for (std::size_t i = 0; i < n; ++i) {
      Real free = p.free[i], size = std::fabs(free);
      for (std::size_t j = 0; j < n; ++j) {
        if (j != i) free -= p.W[i * n + j] * x.slow_f[j];
        size += std::fabs(p.W[i * n + j] * x.slow_f[j]);
      }
      const Real d = depth_by_bisection(p.law[i], p.W[i * n + i], free);
      moved = std::fmax(moved, std::fabs(d - x.slow_d[i]));
      x.slow_d[i] = d;
      x.slow_f[i] = (free - d) / p.W[i * n + i];
      x.scale = std::fmax(x.scale, size);
    }
    x.left = moved;
    if (moved <= 1e-18L * x.scale) break;
  }
  return x;
}

/// Bound of the residual of d + W f = free: the tolerance of the solve, or what the solve reports
/// if that is larger; twice that for the sums' own round-off.
Real left_by(const Found& x) {
  const Real wanted = static_cast<Real>(kPortTolerance) * x.scale;
  return 2.L * std::fmax(wanted, static_cast<Real>(x.result.residual));
}

/// Round-off of the laws' terms, which may cancel, m.
Real round_off(const Problem& p, const Found& x) {
  Real most = 0.L;
  for (std::size_t i = 0; i < x.d.size(); ++i) {
    Real sum = 0.L;
    for (std::size_t j = 0; j < x.d.size(); ++j)
      sum += std::fabs(p.W[i * x.d.size() + j]) *
             (std::fabs(p.law[j].slope * x.d[j]) + std::fabs(p.law[j].jump));
    most = std::fmax(most, sum);
  }
  return 2.2e-16L * most;
}

}  // namespace

TEST_CASE("one port's solve agrees with bisection", "[differential][contact]") {
  // f rises in d + w f = free, so neither d nor w f errs by more than the residual. The solve
  // reaches 1e-12 of |free| + w f, or the round-off of a law whose terms cancel.
  double worst = 0.;
  int capped = 0;
  for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
    Draw draw(seed);
    const Problem p = random_problem(draw, 1);
    const Found x = solve_both_ways(p);
    if (x.result.status != PortStatus::converged && x.result.residual > 4.L * round_off(p, x))
      ++capped;
    const Real off =
        std::fmax(std::fabs(x.d[0] - x.slow_d[0]), p.W[0] * std::fabs(x.f[0] - x.slow_f[0]));
    worst = std::max(worst, static_cast<double>(off / left_by(x)));
    CAPTURE(seed, p.law[0].hertz, p.law[0].slope, p.law[0].jump, p.law[0].mean, p.law[0].from);
    if (!(off <= left_by(x))) FAIL_CHECK(static_cast<double>(off) << " m off");
  }
  CAPTURE(worst);
  CHECK(capped == 0);
}

TEST_CASE("the solve of coupled ports agrees with bisection of one port after the other",
          "[differential][contact]") {
  // With the residual r of d + W f = free and laws that rise, df' W df <= df' r. So |df| <= |r| /
  // least eigenvalue of W and |dd| <= |r| (1 + condition of W); |r| is at most sqrt n times its
  // largest entry.
  double worst = 0., slowest = 0.;
  int capped = 0, capped_means = 0, means = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Draw draw(seed);
    const Problem p = random_problem(draw, draw.whole(2, 4));
    const Found x = solve_both_ways(p);
    const bool mean =
        std::any_of(p.law.begin(), p.law.end(), [](const PortLaw& law) { return law.mean; });
    means += mean ? 1 : 0;
    if (x.result.status != PortStatus::converged && x.result.residual > 4.L * round_off(p, x))
      ++(mean ? capped_means : capped);
    const Real bound = std::sqrt(static_cast<Real>(p.n)) * (1.L + p.condition) * left_by(x);
    Real off = 0.L;  // forces are scaled so that depths and forces share one bound
    for (std::size_t i = 0; i < x.d.size(); ++i) {
      off = std::fmax(off, std::fabs(x.d[i] - x.slow_d[i]));
      off = std::fmax(off, std::fabs(x.f[i] - x.slow_f[i]) * p.least * (1.L + p.condition));
    }
    worst = std::max(worst, static_cast<double>(off / bound));
    slowest = std::max(slowest, static_cast<double>(x.left / x.scale));
    CAPTURE(seed, p.n, p.condition, x.result.iterations, x.result.residual);
    if (!(off <= bound)) FAIL_CHECK(static_cast<double>(off) << " m off");
  }
  CAPTURE(worst, slowest, capped, capped_means, means);
  CHECK(slowest < 1e-15);
  // Eight iterations do not solve one of 9600 cases without means, as ports.cpp says.
  CHECK(capped <= 1);
  // Newton's method is not globalised for coupled means. Some cases, whose stiffnesses over
  // compliances spread over ten decades, stay unsolved and are reported so.
  CHECK(20 * capped_means < means);
}
