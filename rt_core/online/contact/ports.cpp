#include "online/contact/ports.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "online/math/dense.h"
#include "online/math/scalar.h"

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

/// [V(d) - V(e)] / (d - e) and its slope over d, for V = 2/5 C max(d, 0)^2.5. Without a difference
/// of similar numbers, by r = sqrt d, s = sqrt e:
///   0.4 C (r^4 + r^3 s + r^2 s^2 + r s^3 + s^4) / (r + s).
struct Mean {
  double force, slope;
};
Mean mean_at(double C, double d, double e) noexcept {
  if (!(d > 0.0) && !(e > 0.0)) return {0.0, 0.0};
  if (!(d > 0.0)) {
    const double force = 0.4 * C * e * e * std::sqrt(e) / (e - d);
    return {force, force / (e - d)};
  }
  const double r = std::sqrt(d);
  if (!(e > 0.0)) {
    const double force = 0.4 * C * d * d * r / (d - e);
    return {force, (C * d * r - force) / (d - e)};
  }
  const double s = std::sqrt(e), sum = r + s;
  return {0.4 * C * (d * d + d * r * s + d * e + r * s * e + e * e) / sum,
          0.2 * C * (3.0 * d * r + 6.0 * d * s + 4.0 * r * e + 2.0 * s * e) / (sum * sum)};
}

double force_at(const PortLaw& law, double d) noexcept {
  if (law.mean) return mean_at(law.hertz, d, law.from).force;
  if (law.bilateral) return law.slope * d + law.jump;
  if (!(d > 0.0)) return 0.0;
  if (law.hertz > 0.0) return law.hertz * d * std::sqrt(d);
  const double part = law.jump > 0.0 && d < kJumpDepth ? d / kJumpDepth : 1.0;
  return larger(0.0, law.slope * d + law.jump * part);
}

/// df/dd of a port with a force.
double stiffness_at(const PortLaw& law, double d) noexcept {
  if (law.mean) return mean_at(law.hertz, d, law.from).slope;
  if (law.bilateral) return law.slope;
  if (law.hertz > 0.0) return 1.5 * law.hertz * std::sqrt(d);
  return law.jump > 0.0 && d < kJumpDepth ? law.slope + law.jump / kJumpDepth : law.slope;
}

/// Whether the port takes part: it has a force, or a change of d makes one.
bool acts(const PortLaw& law, double force) noexcept { return law.bilateral || force > 0.0; }

/// Force at which a jump above 0 is complete.
double knee(const PortLaw& law) noexcept { return law.slope * kJumpDepth + law.jump; }

/// The penetration at which a mean law has a force. In closed form while the force is that of
/// `from` on the way out, else by Newton's method from above, which approaches a convex rising law
/// from one side.
double mean_depth(const PortLaw& law, double force) noexcept {
  const double e = law.from;
  if (!(force > 0.0)) return 0.0;
  const double held = e > 0.0 ? 0.4 * law.hertz * e * std::sqrt(e) : 0.0;  // at d = 0
  if (force <= held) return e - held * e / force;
  // f >= V'((d + e)/2) by convexity
  double d = 2.0 * penetration(force, law.hertz) - e;
  for (int i = 0; i < 6; ++i) {
    const Mean at = mean_at(law.hertz, d, e);
    d -= (at.force - force) / at.slope;
  }
  return d;
}

/// The penetration of a force > 0, or of any force of a bilateral port; for 0 the one at which
/// forces begin.
double depth_of(const PortLaw& law, double force) noexcept {
  if (law.mean) return mean_depth(law, force);
  if (law.bilateral) return (force - law.jump) / law.slope;
  if (law.hertz > 0.0) return penetration(force, law.hertz);
  if (law.jump > 0.0 && force <= knee(law)) return force / knee(law) * kJumpDepth;
  return (force - law.jump) / law.slope;
}

/// Penetration of a single port under d_free > 0, or under any d_free if bilateral. For a contact
/// it is exact for small and large w C sqrt(d) and 14 % low between; for a spring it is exact.
double lone_depth(const PortLaw& law, double d_free, double w) noexcept {
  if (law.bilateral) return (d_free - w * law.jump) / (1.0 + w * law.slope);
  if (law.hertz > 0.0) {
    const double root = cube_root(w * law.hertz * std::sqrt(d_free));
    return d_free / (1.0 + root * root);
  }
  const double first = d_free / (1.0 + w * knee(law) / kJumpDepth);
  if (law.jump > 0.0 && first < kJumpDepth) return first;
  const double second = (d_free - w * law.jump) / (1.0 + w * law.slope);
  return second < d_free ? second : d_free;
}

/// Start of the search for a mean law's penetration: near that of a single port, by three Newton
/// steps from where the contact was; if it was open, as for an ordinary law.
double mean_start(const PortLaw& law, double d_free, double w) noexcept {
  double d = d_free;
  if (law.from > 0.0) {
    if (!(d > 0.0) || d > law.from) d = law.from;
  } else {
    if (!(d > 0.0)) return d;
    const double root = cube_root(0.4 * w * law.hertz * std::sqrt(d));
    d = d / (1.0 + root * root);
  }
  for (int i = 0; i < 3; ++i) {
    const Mean at = mean_at(law.hertz, d, law.from);
    d -= ((d + w * at.force) - d_free) / (1.0 + w * at.slope);
  }
  return d;
}

/// The problem, and one iterate with the quantities that follow from it. Sums over W, which is
/// symmetric, take a row for all ports at once, so that no sum waits for itself.
struct Problem {
  int n;
  const double* W;
  const PortLaw* law;
  const double* d_free;
};

struct Point {
  double d[kPorts], f[kPorts], F[kPorts];  // m, N, d + W f - d_free in m
  double residual, scale;                  // max |F|; scale of its rounding
};

/// @param size  [n] scratch: the caller has memory that it does not need now, and the stack is
/// short
void evaluate(const Problem& p, Point& x, double* size) noexcept {
  x.residual = 0.0;
  x.scale = 0.0;
  double* const sum = x.F;
  for (int i = 0; i < p.n; ++i) {
    x.f[i] = force_at(p.law[i], x.d[i]);
    sum[i] = 0.0;
    size[i] = std::fabs(p.d_free[i]);
  }
  for (int j = 0; j < p.n; ++j) {
    const double* const own = p.W + j * p.n;
    const double force = x.f[j];
#pragma omp simd
    for (int i = 0; i < p.n; ++i) {
      const double term = own[i] * force;
      sum[i] += term;
      size[i] += std::fabs(term);
    }
  }
  for (int i = 0; i < p.n; ++i) {
    // A port without force has its gap in closed form.
    if (!acts(p.law[i], x.f[i]) && force_at(p.law[i], p.d_free[i] - sum[i]) == 0.0)
      x.d[i] = p.d_free[i] - sum[i];
    x.F[i] = x.d[i] + sum[i] - p.d_free[i];
    // Written so that NaN counts as large.
    if (!(std::fabs(x.F[i]) <= x.residual)) x.residual = std::fabs(x.F[i]);
    if (size[i] > x.scale) x.scale = size[i];
  }
}

/// Gradient of the convex function along the step in f between two points, at x: negative while it
/// decreases.
double slope(const Problem& p, const Point& x, const Point& from, const Point& to) noexcept {
  double sum = 0.0;
  for (int i = 0; i < p.n; ++i)
    sum += (acts(p.law[i], x.f[i]) ? x.F[i] : x.F[i] - x.d[i] + depth_of(p.law[i], 0.0)) *
           (to.f[i] - from.f[i]);
  return sum;
}

/// delta = -(I + W K)^-1 F, K = df/dd, by the symmetric I + sqrt(K) W sqrt(K). If this cannot be
/// solved, the coupling between ports is neglected.
SmallSolve newton_step(const Problem& p, const Point& x, const double* K, double* delta) noexcept {
  double S[kPorts], t[kPorts], A[kPorts * kPorts];
  for (int i = 0; i < p.n; ++i) S[i] = std::sqrt(K[i]);
  for (int i = 0; i < p.n; ++i) {
    t[i] = -S[i] * x.F[i];
    const double* const own = p.W + i * p.n;
    double* const row = A + i * p.n;
#pragma omp simd
    for (int j = i; j < p.n; ++j) row[j] = S[i] * own[j] * S[j];
    row[i] += 1.0;
  }
  const SmallSolve solve = solve_small(A, t, p.n);
  if (solve != SmallSolve::solved)
    for (int i = 0; i < p.n; ++i) t[i] = -S[i] * x.F[i] / (1.0 + K[i] * p.W[i * p.n + i]);
  for (int i = 0; i < p.n; ++i) delta[i] = -x.F[i];
  for (int j = 0; j < p.n; ++j) {
    const double* const own = p.W + j * p.n;
#pragma omp simd
    for (int i = 0; i < p.n; ++i) delta[i] -= own[i] * S[j] * t[j];
  }
  return solve;
}

/// The next penetrations: back from Newton's step to the law, on the line along which a single port
/// yields. This is exact for a spring. For a contact, the step of a single port ends above the
/// solution in d and below it in f, by p : 1 with p = W_ii K_i; weighted by 1 : p the quadratic
/// errors cancel.
void advance(const Problem& p, const Point& x, const double* K, const double* delta,
             double* d) noexcept {
  for (int i = 0; i < p.n; ++i) {
    const double w = p.W[i * p.n + i], next = x.d[i] + delta[i];
    const double force = x.f[i] + K[i] * delta[i];
    if (p.law[i].mean) {  // convex: Newton's own step approaches it from one side
      d[i] = next;
    } else if (K[i] > 0.0 && p.law[i].hertz > 0.0) {
      const double weight = w * K[i];
      const double by_force = force > 0.0 ? penetration(force, p.law[i].hertz) : 0.0;
      d[i] = (next + weight * by_force) / (1.0 + weight);
    } else {
      const double free = next + w * force;
      d[i] = acts(p.law[i], free) ? lone_depth(p.law[i], free, w) : free;
    }
  }
}

/// Slope beyond the minimum, over the slope at the start, above which a step is shortened. It only
/// guards against wild steps: an ordinary line search (0.5 here) costs iterations, since a step
/// that passes the minimum on its way to the right active set is good. In 9600 random cases 0.5
/// left 193 unsolved after 8 iterations, 30 left 6, and 1000 and no guard at all left 1.
constexpr double kOvershoot = 1000.0;

/// One globalised iteration x -> next. Returns how its linear system was solved.
SmallSolve iterate(const Problem& p, const Point& x, Point& next) noexcept {
  double K[kPorts], delta[kPorts];
  for (int i = 0; i < p.n; ++i)
    K[i] = acts(p.law[i], x.f[i]) ? stiffness_at(p.law[i], x.d[i]) : 0.0;
  const SmallSolve solve = newton_step(p, x, K, delta);
  advance(p, x, K, delta, next.d);
  evaluate(p, next, delta);
  for (int halving = 0; halving < 3; ++halving) {
    const double before = slope(p, x, x, next), after = slope(p, next, x, next);
    if (!(before < 0.0) || !(after > -kOvershoot * before)) break;
    // Far beyond the minimum of the convex function on this line: back to the secant's zero.
    const double part = before / (before - after);
    for (int i = 0; i < p.n; ++i) {
      const double force = x.f[i] + part * (next.f[i] - x.f[i]);
      next.d[i] = acts(p.law[i], force) ? depth_of(p.law[i], force)
                  : next.d[i] < 0.0     ? next.d[i]
                                        : 0.0;
    }
    evaluate(p, next, delta);
  }
  return solve;
}

bool is_law(const PortLaw& law) noexcept {
  if (law.mean && !(std::isfinite(law.from) && law.hertz > 0.0 && !law.bilateral)) return false;
  if (!std::isfinite(law.hertz) || !std::isfinite(law.slope) || !std::isfinite(law.jump))
    return false;
  if (law.bilateral) return law.slope > 0.0;
  return law.hertz > 0.0 || (law.hertz == 0.0 && law.slope > 0.0);
}

bool usable(const Problem& p) noexcept {
  if (p.n < 0 || p.n > kPorts) return false;
  for (int i = 0; i < p.n; ++i) {
    if (!std::isfinite(p.d_free[i]) || !is_law(p.law[i])) return false;
    if (!(p.W[i * p.n + i] >= 0.0)) return false;
  }
  double off[4] = {};  // each difference is 0, but for infinities and NaN
  const int count = p.n * p.n;
  for (int k = 0; k < count; ++k) off[k % 4] += p.W[k] - p.W[k];
  return (off[0] + off[1]) + (off[2] + off[3]) == 0.0;
}

/// Starts from the last step's forces. A port without force starts as if it were alone in the shape
/// under these forces.
void start(const Problem& p, const double* last, Point& x, double* size) noexcept {
  double* const free = x.d;
  for (int i = 0; i < p.n; ++i) {
    x.f[i] = std::isfinite(last[i]) && acts(p.law[i], last[i]) ? last[i] : 0.0;
    free[i] = p.d_free[i];
  }
  for (int j = 0; j < p.n; ++j) {
    const double* const own = p.W + j * p.n;
#pragma omp simd
    for (int i = 0; i < p.n; ++i) free[i] -= own[i] * x.f[j];
  }
  for (int i = 0; i < p.n; ++i) {
    const double w = p.W[i * p.n + i];
    x.d[i] = p.law[i].mean            ? mean_start(p.law[i], p.d_free[i], w)
             : acts(p.law[i], x.f[i]) ? depth_of(p.law[i], x.f[i])
             : free[i] > 0.0          ? lone_depth(p.law[i], free[i], w)
                                      : free[i];
  }
  evaluate(p, x, size);
}

bool done(const Point& x) noexcept { return x.residual <= kPortTolerance * x.scale; }

}  // namespace

PortForce port_force(const PortLaw& law, double d) noexcept {
  const double force = force_at(law, d);
  return {force, acts(law, force) ? stiffness_at(law, d) : 0.0};
}

double port_depth(const PortLaw& law, double force) noexcept { return depth_of(law, force); }

PortResult solve_ports(int n, const double* W, const PortLaw* law, const double* d_free, double* f,
                       double* d, int cap) noexcept {
  const Problem p{n, W, law, d_free};
  if (!usable(p)) {
    for (int i = 0; i < n && i < kPorts; ++i) f[i] = d[i] = 0.0;
    return {PortStatus::bad_input, 0, 0.0};
  }
  cap = cap < 0 ? 0 : cap > kPortSweeps ? kPortSweeps : cap;
  Point points[3];
  Point *x = points, *best = points + 1, *next = points + 2;
  best->residual = std::numeric_limits<double>::infinity();  // none yet
  best->scale = 0.0;
  start(p, f, *x, next->F);
  int iterations = 0;
  bool indefinite = false;
  while (!done(*x) && iterations < cap) {
    if (iterate(p, *x, *next) == SmallSolve::indefinite) indefinite = true;
    Point* const free = x->residual < best->residual ? best : x;
    if (free == best) best = x;
    x = next;
    next = free;
    ++iterations;
  }
  if (x->residual < best->residual || done(*x)) best = x;
  if (!done(*best)) {  // without any force all numbers are finite
    for (int i = 0; i < n; ++i) next->d[i] = 0.0;
    evaluate(p, *next, f);
    if (!(best->residual < next->residual)) best = next;
  }
  for (int i = 0; i < n; ++i) {
    f[i] = best->f[i];
    d[i] = best->d[i];
  }
  const PortStatus status = indefinite    ? PortStatus::indefinite
                            : done(*best) ? PortStatus::converged
                                          : PortStatus::cap_reached;
  return {status, iterations, best->residual};
}

}  // namespace railstep
