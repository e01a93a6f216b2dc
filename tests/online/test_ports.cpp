#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "online/contact/ports.h"

// The references use long double on purpose; clang warns of these promotions.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

using Real = long double;

struct PortCase {
  int n;
  std::vector<double> W;
  std::vector<PortLaw> law;
  std::vector<double> d_free;
};

/// Which laws a random case has.
enum class Laws { contacts, springs, both, pulling };  // pulling: all kinds, half of them pull

double log_uniform(double low, double high, std::mt19937& random) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>()(random));
}

/// W = B B' of a random rank (so often singular) plus, half the time, a small diagonal; sizes are
/// about 1e-11 m/N to `softest`. A wheel on a rail has w C sqrt(d) of 0.1 to 10; here it runs from
/// 1e-5 to 1e3 for 1e-8 m/N and to 1e4 for 1e-7 m/N.
PortCase random_case(int n, double softest, std::mt19937& random, Laws laws = Laws::contacts) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> coin(0, 1), rank(std::min(n, 1), n);
  PortCase c{n, std::vector<double>(static_cast<std::size_t>(n * n), 0.0), {}, {}};
  const int columns = rank(random);
  std::vector<double> B(static_cast<std::size_t>(n * columns));
  for (double& b : B) b = normal(random);
  const double compliance = log_uniform(1e-11, softest, random);
  const double own = coin(random) ? 0.1 * compliance : 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = 0.0;
      const double *left = B.data() + i * columns, *right = B.data() + j * columns;
      for (int k = 0; k < columns; ++k) sum += left[k] * right[k];
      c.W.data()[i * n + j] = compliance * sum / columns + (i == j ? own : 0.0);
    }
  for (int i = 0; i < n; ++i) {
    const bool mixed = laws == Laws::both || laws == Laws::pulling;
    const bool spring = laws == Laws::springs || (mixed && coin(random));
    if (spring) {
      const double jump = (coin(random) ? 1 : -1) * log_uniform(1e1, 1e5, random);
      c.law.push_back({0.0, log_uniform(1e6, 1e10, random), coin(random) ? jump : 0.0});
    } else {
      c.law.push_back({log_uniform(1e9, 1e12, random), 0.0, 0.0});
    }
    if (laws == Laws::pulling && coin(random))
      c.law.back() = {0.0, log_uniform(1e6, 1e10, random),
                      (coin(random) ? 1 : -1) * log_uniform(1e1, 1e5, random), true};
    c.d_free.push_back((coin(random) ? 1 : -1) * log_uniform(1e-6, 1e-2, random));
  }
  return c;
}

Real force_of(const PortLaw& law, Real d) {
  if (law.bilateral) return law.slope * d + law.jump;
  if (d <= 0) return 0;
  if (law.hertz > 0.) return law.hertz * d * std::sqrt(d);
  const Real part = law.jump > 0. ? std::min<Real>(1, d / kJumpDepth) : 1;
  return std::max(law.slope * d + law.jump * part, Real{0});
}

/// Root of d + w f(d) = d_free by bisection, in long double.
Real bisect(Real w, const PortLaw& law, Real d_free) {
  if (law.bilateral) return (d_free - w * law.jump) / (1 + w * law.slope);
  if (d_free <= 0) return d_free;
  Real low = 0, high = d_free;
  for (int i = 0; i < 200; ++i) {
    const Real middle = (low + high) / 2;
    (middle + w * force_of(law, middle) < d_free ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Gauss-Seidel on the convex function: each port in turn is solved by bisection, which converges
/// for every semidefinite W. Returns no forces if 20000 sweeps did not settle them.
std::vector<Real> gauss_seidel(const PortCase& c) {
  const auto n = static_cast<std::size_t>(c.n);
  std::vector<Real> f(n, 0);
  for (int sweep = 0; sweep < 20000; ++sweep) {
    Real change = 0, largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      Real others = c.d_free[i];
      for (std::size_t j = 0; j < n; ++j)
        if (j != i) others -= c.W[i * n + j] * f[j];
      const Real force = force_of(c.law[i], bisect(c.W[i * n + i], c.law[i], others));
      change = std::max(change, std::abs(force - f[i]));
      largest = std::max(largest, std::abs(force));
      f[i] = force;
    }
    if (change <= 1e-17L * largest) return f;
  }
  return {};
}

}  // namespace

TEST_CASE("a single port agrees with bisection in long double", "[ports]") {
  std::mt19937 random(1);
  int most = 0;
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const PortCase c = random_case(1, 1e-7, random);
    double f = 0.0, d = 0.0;
    const PortResult got = solve_ports(1, c.W.data(), c.law.data(), c.d_free.data(), &f, &d);
    REQUIRE(got.status == PortStatus::converged);
    most = std::max(most, got.iterations);
    const double want = static_cast<double>(bisect(c.W[0], c.law[0], c.d_free[0]));
    // d + w C d^1.5 has a slope of at least 1, and its residual is at most 1e-12 of twice d_free.
    CHECK(std::abs(d - want) <= 2e-12 * std::abs(c.d_free[0]));
    worst = std::max(worst, std::abs(d - want) / std::abs(c.d_free[0]));
  }
  INFO("most iterations " << most << ", largest error over d_free " << worst);
  CHECK(most <= 4);
}

/// max |d + W f - d_free| of an answer, in long double; checks the laws on the way.
Real true_residual(const PortCase& c, const std::vector<double>& f, const std::vector<double>& d) {
  const auto n = static_cast<std::size_t>(c.n);
  Real worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Real sum = static_cast<Real>(d[i]) - c.d_free[i];
    for (std::size_t j = 0; j < n; ++j) sum += static_cast<Real>(c.W[i * n + j]) * f[j];
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

/// The length that residuals are measured against: max |d_free_i| + sum_j |W_ij| f_j.
template <typename T>
double length(const PortCase& c, const std::vector<T>& f) {
  const auto n = static_cast<std::size_t>(c.n);
  Real scale = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Real size = std::abs(c.d_free[i]);
    for (std::size_t j = 0; j < n; ++j) size += std::abs(c.W[i * n + j] * f[j]);
    scale = std::max(scale, size);
  }
  return static_cast<double>(scale);
}

TEST_CASE("coupled ports agree with Gauss-Seidel in long double", "[ports]") {
  const Laws laws = GENERATE(Laws::contacts, Laws::springs, Laws::both, Laws::pulling);
  std::mt19937 random(2);
  int most = 0, compared = 0, histogram[kPortSweeps + 1] = {};
  double worst = 0.0;
  for (int i = 0; i < 9600; ++i) {
    const PortCase c = random_case(1 + i % 8, 1e-8, random, laws);
    const auto n = static_cast<std::size_t>(c.n);
    std::vector<double> f(n, 0.0), d(n);
    const PortResult got =
        solve_ports(c.n, c.W.data(), c.law.data(), c.d_free.data(), f.data(), d.data());
    REQUIRE(got.status == PortStatus::converged);
    ++histogram[got.iterations];
    most = std::max(most, got.iterations);
    // The sum of at most 9 terms is rounded within 9 eps of the length.
    CHECK(std::abs(static_cast<double>(true_residual(c, f, d)) - got.residual) <=
          9 * 0x1p-52 * length(c, f));
    const std::vector<Real> want = gauss_seidel(c);
    if (want.empty()) continue;
    ++compared;
    for (std::size_t k = 0; k < n; ++k) {
      // Compares the force and, for Hertz's law, also the penetration.
      const Real by_force = std::abs(want[k] - static_cast<Real>(f[k])) * c.W[k * n + k];
      worst = std::max(worst, static_cast<double>(by_force) / length(c, want));
      if (!(c.law[k].hertz > 0.)) continue;
      const double exact = static_cast<double>(std::pow(std::cbrt(want[k] / c.law[k].hertz), 2));
      worst = std::max(worst, std::abs(std::max(d[k], 0.0) - exact) / length(c, want));
    }
  }
  for (int k = 0; k <= kPortSweeps; ++k) UNSCOPED_INFO(k << " iterations: " << histogram[k]);
  INFO("most iterations " << most << ", compared " << compared << ", largest error " << worst);
  // (f - g)'(d(f) - d(g)) <= (f - g)'residual: weighted by the contact stiffnesses, d errs by no
  // more than the residual, 1e-12. Stiffnesses differ by up to (1e12/1e9) sqrt(d ratio), whose root
  // (some 30) enters when the worst port is the softest.
  CHECK(worst <= 30e-12);
  CHECK(compared > 9000);
}

TEST_CASE("any number of ports up to the cap is solved: the laws hold and no residual is left",
          "[ports]") {
  // The problem is convex: forces that meet its equations and laws are the answer.
  const Laws laws = GENERATE(Laws::contacts, Laws::springs, Laws::both, Laws::pulling);
  std::mt19937 random(7);
  int most = 0;
  for (int i = 0; i < 3 * (kPorts + 1); ++i) {
    const PortCase c = random_case(i % (kPorts + 1), 1e-8, random, laws);
    const auto n = static_cast<std::size_t>(c.n);
    std::vector<double> f(n, 0.0), d(n);
    const PortResult got =
        solve_ports(c.n, c.W.data(), c.law.data(), c.d_free.data(), f.data(), d.data());
    INFO(c.n << " ports, residual " << got.residual << " of " << length(c, f));
    REQUIRE(got.status == PortStatus::converged);
    most = std::max(most, got.iterations);
    // The sum of n + 1 terms is rounded within (n + 1) eps of the length.
    CHECK(static_cast<double>(true_residual(c, f, d)) <=
          (kPortTolerance + (c.n + 1) * 0x1p-52) * length(c, f));
    for (std::size_t k = 0; k < n; ++k) {
      const double want = static_cast<double>(force_of(c.law[k], d[k]));
      const double terms = c.law[k].slope * std::abs(d[k]) + std::abs(c.law[k].jump);
      CHECK(std::abs(f[k] - want) <= 4 * 0x1p-52 * (std::abs(want) + terms));
    }
  }
  INFO("most iterations " << most);
  CHECK(most <= kPortSweeps);
}

TEST_CASE("compliances that no structure can have are reported", "[ports]") {
  // W_01 is beyond sqrt(W_00 W_11): two ports push each other apart by themselves.
  const double W[4] = {1e-8, 3e-8, 3e-8, 1e-8}, d_free[2] = {1e-3, 1e-3};
  const PortLaw law[2] = {{1e11, 0., 0.}, {1e11, 0., 0.}};
  double f[2] = {}, d[2];
  const PortResult got = solve_ports(2, W, law, d_free, f, d);
  CHECK(got.status == PortStatus::indefinite);
  CHECK((std::isfinite(f[0]) && std::isfinite(f[1])));
}

TEST_CASE("an extreme case is solved or reports its residual", "[ports]") {
  std::mt19937 random(3);
  int capped = 0;
  for (int i = 0; i < 9600; ++i) {
    const PortCase c = random_case(1 + i % 8, 1e-7, random);
    const auto n = static_cast<std::size_t>(c.n);
    for (int cap : {0, 2, 8}) {
      std::vector<double> f(n, 0.0), d(n);
      const PortResult got =
          solve_ports(c.n, c.W.data(), c.law.data(), c.d_free.data(), f.data(), d.data(), cap);
      CHECK(got.iterations <= cap);
      CHECK((got.status == PortStatus::converged) ==
            (got.residual <= kPortTolerance * length(c, f)));
      CHECK(std::abs(static_cast<double>(true_residual(c, f, d)) - got.residual) <=
            9 * 0x1p-52 * length(c, f));
      for (std::size_t k = 0; k < n; ++k) CHECK((std::isfinite(f[k]) && f[k] >= 0.0));
      if (cap == 8 && got.status == PortStatus::cap_reached) ++capped;
    }
  }
  UNSCOPED_INFO("cap of 8 reached in " << capped << " of 9600");
  CHECK(capped < 96);  // one in a hundred; with more, the cap and not the method would decide
}

TEST_CASE("a start from the answer needs no iteration, and a start near it needs fewer",
          "[ports]") {
  std::mt19937 random(4);
  int cold = 0, warm = 0;
  for (int i = 0; i < 2000; ++i) {
    PortCase c = random_case(1 + i % 8, 1e-8, random);
    const auto n = static_cast<std::size_t>(c.n);
    std::vector<double> f(n, 0.0), d(n), again;
    const auto solve = [&] {
      return solve_ports(c.n, c.W.data(), c.law.data(), c.d_free.data(), f.data(), d.data());
    };
    REQUIRE(solve().status == PortStatus::converged);
    again = f;
    CHECK(solve().iterations == 0);
    for (double& x : c.d_free) x *= 1.01;
    f = again;
    warm += solve().iterations;
    std::fill(f.begin(), f.end(), 0.0);
    cold += solve().iterations;
  }
  INFO("1 % more penetration: " << warm << " iterations warm, " << cold << " cold");
  CHECK(warm < cold);
}

TEST_CASE("a single spring and damper is solved in one iteration from zero, in four from any start",
          "[ports]") {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    const PortCase c = random_case(1, 1e-7, random, Laws::springs);
    for (const double start : {0.0, 1e2, 1e6}) {
      double f = start, d = 0.0;
      const PortResult got = solve_ports(1, c.W.data(), c.law.data(), c.d_free.data(), &f, &d);
      REQUIRE(got.status == PortStatus::converged);
      CHECK(got.iterations <= (start > 0.0 ? 4 : 1));
      const double want = static_cast<double>(bisect(c.W[0], c.law[0], c.d_free[0]));
      CHECK(std::abs(d - want) <= 2e-12 * std::abs(c.d_free[0]));
    }
  }
}

TEST_CASE("bonded ports hold their penetration at zero and pull where they must", "[ports]") {
  // W f = d_free except for 1e15 N/m, which is 1e-6 of the softest W and 1e-4 of the hardest here.
  std::mt19937 random(6);
  for (int i = 0; i < 1000; ++i) {
    PortCase c = random_case(1 + i % 8, 1e-8, random);
    const auto n = static_cast<std::size_t>(c.n);
    for (std::size_t k = 0; k < n; ++k) {
      c.law[k] = {0.0, 1e15, 0.0, true};
      c.W[k * n + k] += 1e-9;
    }
    std::vector<double> f(n, 0.0), d(n);
    const PortResult got =
        solve_ports(c.n, c.W.data(), c.law.data(), c.d_free.data(), f.data(), d.data());
    REQUIRE(got.status == PortStatus::converged);
    CHECK(got.iterations <= 2);  // linear: one, and one for its rounding
    for (std::size_t k = 0; k < n; ++k) {
      // The penetration that is left is f / 1e15.
      CHECK(std::abs(d[k] - f[k] / 1e15) <= 1e-12 * length(c, f));
      CHECK(std::abs(d[k]) <= 1e-6 * length(c, f));
    }
  }
}

TEST_CASE("a row of one-sided supports is solved within the cap, step after step", "[ports]") {
  // 40 seats under a stiff beam: compliance falls with distance, a load wanders over them and lifts
  // some. Each answer is the start of the next solve.
  const int n = 40;
  std::vector<double> W(n * n), d_free(n), f(n, 0.0), d(n);
  std::vector<PortLaw> law(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double s = std::abs(i - j) * .6 / .9;
      W.data()[n * i + j] = 2e-8 * std::exp(-s) * (std::cos(s) + std::sin(s));
    }
  int most = 0, opened = 0, turns = 0;
  for (int step = 0; step < 800; ++step) {
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double s = std::abs(.05 * step - i) * .6 / .9;
      const double load = 8e4 * std::exp(-s) * (std::cos(s) + std::sin(s)) + 1e4;
      d_free[k] = 2e-8 * load - (i % 7 == 3 ? 3e-4 : 0.);  // some hang
      law[k] = {0., 5e7, 8e4 * (d[k] > 0. ? -.05 : .05)};
    }
    const PortResult got = solve_ports(n, W.data(), law.data(), d_free.data(), f.data(), d.data());
    CHECK(got.status == PortStatus::converged);
    most = std::max(most, got.iterations);
    turns += got.iterations;
    for (const double force : f) opened += force == 0.0 ? 1 : 0;
  }
  INFO("most iterations " << most << ", mean " << turns / 800. << ", open " << opened);
  CHECK(opened > 800);
  CHECK(most <= kPortSweeps);
}

TEST_CASE("an input that is not a number gives no force and is reported", "[ports]") {
  const double bad = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (double x : {bad, inf, -inf})
    for (int place = 0; place < 10; ++place) {
      double in[10] = {1e-9, 1e-10, 1e-10, 1e-9, 1e-4, 1e-4, 1e11, 0.0, 0.0, 0.0};
      in[place] = x;
      const PortLaw law[2] = {{in[6], in[7], in[8]}, {0.0, 1e8, in[9]}};
      double f[2] = {1.0, 1.0}, d[2];
      CHECK(solve_ports(2, in, law, in + 4, f, d).status == PortStatus::bad_input);
      for (int k = 0; k < 2; ++k) CHECK((f[k] == 0.0 && d[k] == 0.0));
    }
  // Invalid laws are refused. An invalid start is ignored; it is not an error.
  for (const PortLaw none : {PortLaw{0., 0., 0.}, PortLaw{-1e9, 1e6, 0.}, PortLaw{0., -1e6, 0.}}) {
    const double W = 1e-9, d_free = 1e-4;
    double f = 1.0, d = 0.0;
    CHECK(solve_ports(1, &W, &none, &d_free, &f, &d).status == PortStatus::bad_input);
  }
  const double W = 1e-9, d_free = 1e-4;
  const PortLaw C = {1e11, 0.0, 0.0};
  for (double start : {bad, inf, -1.0}) {
    double f = start, d = bad, cold = 0.0, d_cold;
    CHECK(solve_ports(1, &W, &C, &d_free, &f, &d).status == PortStatus::converged);
    CHECK(solve_ports(1, &W, &C, &d_free, &cold, &d_cold).status == PortStatus::converged);
    CHECK((f == cold && d == d_cold));
  }
  // Too large to square: the result is still finite.
  const double huge = 1e300;
  const PortLaw hard = {huge, 0.0, 0.0};
  double f = 0.0, d = 0.0;
  CHECK(solve_ports(1, &huge, &hard, &huge, &f, &d).status == PortStatus::cap_reached);
  CHECK((std::isfinite(f) && std::isfinite(d)));
  double many[(kPorts + 1) * (kPorts + 1)] = {}, forces[kPorts + 1] = {}, depths[kPorts + 1] = {};
  const PortLaw laws[kPorts + 1] = {};
  CHECK(solve_ports(kPorts + 1, many, laws, many, forces, depths).status == PortStatus::bad_input);
}
