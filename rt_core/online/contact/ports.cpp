#include "online/contact/ports.h"

#include <cmath>
#include <cstring>

#include "online/math/dense.h"

namespace railstep {
namespace {

/// Cube root of x >= 0 within 2 ulp, without libm: a third of the exponent bits, then Halley.
double cube_root(double x) noexcept {
  if (!(x > 0x1p-1000)) return 0.0;
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = bits / 3 + 0x2A9F7893782DA1CEu;  // within 4 % (Kahan's start)
  double c;
  std::memcpy(&c, &bits, sizeof c);
  for (int i = 0; i < 3; ++i) {  // 4e-2 -> 4e-5 -> 6e-14 -> rounding
    const double cube = c * c * c;
    c *= (cube + 2.0 * x) / (2.0 * cube + x);
  }
  return c;
}

double penetration(double force, double C) noexcept {
  const double root = cube_root(force / C);
  return root * root;
}

/// The problem, and one iterate with all that follows from it.
struct Problem {
  int n;
  const double *W, *C, *d_free;
};

struct Point {
  double d[kPorts], f[kPorts], F[kPorts];  // m, N, d + W f - d_free in m
  double residual, scale;                  // max |F|; what its rounding is measured against
};

void evaluate(const Problem& p, Point& x) noexcept {
  x.residual = 0.0;
  x.scale = 0.0;
  for (int i = 0; i < p.n; ++i) x.f[i] = x.d[i] > 0.0 ? p.C[i] * x.d[i] * std::sqrt(x.d[i]) : 0.0;
  for (int i = 0; i < p.n; ++i) {
    double sum = 0.0, size = std::fabs(p.d_free[i]);
    for (int j = 0; j < p.n; ++j) {
      const double term = p.W[i * p.n + j] * x.f[j];
      sum += term;
      size += std::fabs(term);
    }
    // A port out of contact has its gap in closed form.
    if (!(x.d[i] > 0.0) && p.d_free[i] - sum <= 0.0) x.d[i] = p.d_free[i] - sum;
    x.F[i] = x.d[i] + sum - p.d_free[i];
    // Written so that NaN counts as large.
    if (!(std::fabs(x.F[i]) <= x.residual)) x.residual = std::fabs(x.F[i]);
    if (size > x.scale) x.scale = size;
  }
}

/// Gradient of the convex function along a step in f, at x: negative while it goes down.
double slope(const Problem& p, const Point& x, const double* step) noexcept {
  double sum = 0.0;
  for (int i = 0; i < p.n; ++i) sum += (x.d[i] > 0.0 ? x.F[i] : x.F[i] - x.d[i]) * step[i];
  return sum;
}

/// A lone port's penetration: exact for w C sqrt(d) small and large, 14 % low between.
double lone_penetration(double d_free, double w, double C) noexcept {
  const double root = cube_root(w * C * std::sqrt(d_free));
  return d_free / (1.0 + root * root);
}

/// delta = -(I + W K)^-1 F, K = df/dd, through the symmetric I + sqrt(K) W sqrt(K).
void newton_step(const Problem& p, const Point& x, const double* K, double* delta) noexcept {
  double S[kPorts], t[kPorts], A[kPorts * kPorts];
  for (int i = 0; i < p.n; ++i) S[i] = std::sqrt(K[i]);
  for (int i = 0; i < p.n; ++i) {
    t[i] = -S[i] * x.F[i];
    for (int j = 0; j < p.n; ++j)
      A[i * p.n + j] = S[i] * p.W[i * p.n + j] * S[j] + (i == j ? 1.0 : 0.0);
  }
  if (!solve_small(A, t, p.n))  // W is not semidefinite: neglect the coupling
    for (int i = 0; i < p.n; ++i) t[i] = -S[i] * x.F[i] / (1.0 + K[i] * p.W[i * p.n + i]);
  for (int i = 0; i < p.n; ++i) {
    delta[i] = -x.F[i];
    for (int j = 0; j < p.n; ++j) delta[i] -= p.W[i * p.n + j] * S[j] * t[j];
  }
}

/// The next penetrations. In d the step of a lone port ends above the answer, in f below, by
/// p : 1 with p = W_ii K_i; weighted by 1 : p the quadratic errors cancel.
void advance(const Problem& p, const Point& x, const double* K, const double* delta,
             double* d) noexcept {
  for (int i = 0; i < p.n; ++i) {
    const double w = p.W[i * p.n + i];
    if (K[i] > 0.0) {
      const double weight = w * K[i];
      const double force = x.f[i] + K[i] * delta[i];
      const double by_force = force > 0.0 ? penetration(force, p.C[i]) : 0.0;
      d[i] = (x.d[i] + delta[i] + weight * by_force) / (1.0 + weight);
    } else {
      const double next = x.d[i] + delta[i];  // free penetration of an entering port
      d[i] = next > 0.0 ? lone_penetration(next, w, p.C[i]) : next;
    }
  }
}

/// Slope behind the minimum, over the slope at the start, that calls for a shorter step. A guard
/// against wild steps only: an ordinary line search (0.5 here) costs iterations, since a step that
/// passes the minimum on its way to the right active set is a good one. In 9600 random cases 0.5
/// left 193 unsolved after 8 iterations, 30 left 6, 1000 and no guard at all left 1.
constexpr double kOvershoot = 1000.0;

/// One globalised iteration x -> next.
void iterate(const Problem& p, const Point& x, Point& next) noexcept {
  double K[kPorts], delta[kPorts], step[kPorts];
  for (int i = 0; i < p.n; ++i) K[i] = x.d[i] > 0.0 ? 1.5 * p.C[i] * std::sqrt(x.d[i]) : 0.0;
  newton_step(p, x, K, delta);
  advance(p, x, K, delta, next.d);
  evaluate(p, next);
  for (int halving = 0; halving < 3; ++halving) {
    for (int i = 0; i < p.n; ++i) step[i] = next.f[i] - x.f[i];
    const double before = slope(p, x, step), after = slope(p, next, step);
    if (!(before < 0.0) || !(after > -kOvershoot * before)) return;
    // Far past the minimum of the convex function on this line: back to the secant's zero.
    const double part = before / (before - after);
    for (int i = 0; i < p.n; ++i) {
      const double force = x.f[i] + part * step[i];
      next.d[i] = force > 0.0 ? penetration(force, p.C[i]) : next.d[i] < 0.0 ? next.d[i] : 0.0;
    }
    evaluate(p, next);
  }
}

bool usable(const Problem& p) noexcept {
  if (p.n < 0 || p.n > kPorts) return false;
  for (int i = 0; i < p.n; ++i) {
    if (!std::isfinite(p.d_free[i]) || !std::isfinite(p.C[i]) || !(p.C[i] > 0.0)) return false;
    if (!(p.W[i * p.n + i] >= 0.0)) return false;
    for (int j = 0; j < p.n; ++j)
      if (!std::isfinite(p.W[i * p.n + j])) return false;
  }
  return true;
}

/// From the last step's forces; a port that had none starts as if alone in the shape they make.
void start(const Problem& p, const double* last, Point& x) noexcept {
  for (int i = 0; i < p.n; ++i) x.f[i] = std::isfinite(last[i]) && last[i] > 0.0 ? last[i] : 0.0;
  for (int i = 0; i < p.n; ++i) {
    double free = p.d_free[i];
    for (int j = 0; j < p.n; ++j) free -= p.W[i * p.n + j] * x.f[j];
    x.d[i] = x.f[i] > 0.0 ? penetration(x.f[i], p.C[i])
             : free > 0.0 ? lone_penetration(free, p.W[i * p.n + i], p.C[i])
                          : free;
  }
  evaluate(p, x);
}

bool done(const Point& x) noexcept { return x.residual <= kPortTolerance * x.scale; }

}  // namespace

PortResult solve_ports(int n, const double* W, const double* C, const double* d_free, double* f,
                       double* d, int cap) noexcept {
  const Problem p{n, W, C, d_free};
  if (!usable(p)) {
    for (int i = 0; i < n && i < kPorts; ++i) f[i] = d[i] = 0.0;
    return {PortStatus::bad_input, 0, 0.0};
  }
  cap = cap < 0 ? 0 : cap > kPortSweeps ? kPortSweeps : cap;
  Point x{}, best{}, next{};
  evaluate(p, best);  // no force at all is always finite
  start(p, f, x);
  int iterations = 0;
  while (!done(x) && iterations < cap) {
    iterate(p, x, next);
    if (x.residual < best.residual) best = x;
    x = next;
    ++iterations;
  }
  if (x.residual < best.residual || done(x)) best = x;
  for (int i = 0; i < n; ++i) {
    f[i] = best.f[i];
    d[i] = best.d[i];
  }
  return {done(best) ? PortStatus::converged : PortStatus::cap_reached, iterations, best.residual};
}

}  // namespace railstep
