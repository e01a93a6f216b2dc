#include "online/runner/element_law.h"

#include <cmath>

#include "online/math/decay.h"

namespace railstep {

namespace {

/// Friction against a displacement, its slope over it and its slope over the limit.
struct Friction {
  double force, slope, limit_slope;
};

struct Limit {
  double value, load_slope;  // N; N/m
};
Limit limit_of(const ForceElement& e, const ElementStep& at, double load) noexcept {
  if (e.loaded == 0) return {at.value, 0.};
  const double pressed = e.load_at_rest + e.load_stiffness * load;
  if (!(pressed > 0.)) return {0., 0.};
  return {at.value * pressed, at.value * e.load_stiffness};
}

double within(double force, double limit) noexcept {
  return force > limit ? limit : force < -limit ? -limit : force;
}

/// Return mapping: the spring and damper hold up to the limit.
Friction slider(const ForceElement& e, const ElementStep& at, double z, double limit) noexcept {
  const double held = e.stiffness * z + e.damping * (at.rate * z + at.rate_at_zero);
  if (held >= limit) return {limit, 0., 1.};
  if (held <= -limit) return {-limit, 0., -1.};
  return {held, e.stiffness + e.damping * at.rate, 0.};
}

/// dF/dz = k (1 - F sign / limit), in closed form over a way of the step in the sign's direction.
Friction exponential(const ForceElement& e, const ElementStep& at, double sign, double along,
                     double limit) noexcept {
  if (!(limit > 0.)) return {0., 0., 0.};
  const double before = within(at.memory[1], limit), way = along * e.stiffness / limit,
               left = decay(way), missing = sign * limit - before;
  if (!(left > 0.)) return {sign * limit, 0., sign};
  const double clipped = before != at.memory[1] ? (before < 0. ? -left : left) : 0.;
  return {sign * limit - missing * left, (limit - sign * before) / limit * e.stiffness * left,
          sign * (1. - left) - missing * left * way / limit + clipped};
}

/// A branch of Berg's friction: the force where the motion turned, and the way since then.
struct Branch {
  double from, way;
};
Branch branch_of(const ElementStep& at, double z) noexcept {
  const double since = at.memory[2];
  const bool goes_on = z * since >= 0. && since != 0.;
  return goes_on ? Branch{at.memory[1], since + z} : Branch{at.memory[3], z};
}
/// On a branch F = from + sign m t / (m / k + t), with m = limit - sign from and the way t. Its
/// limit is constant: under one that changes it could give back more than it took.
Friction berg(const ForceElement& e, const ElementStep& at, double z, double limit) noexcept {
  const Branch branch = branch_of(at, z);
  const double sign = branch.way < 0. ? -1. : 1., missing = limit - sign * branch.from,
               soft = missing / e.stiffness, all = soft + sign * branch.way;
  if (!(all > 0.)) return {branch.from, e.stiffness, 0.};
  return {branch.from + missing * branch.way / all, missing * soft / (all * all), 0.};
}

Friction friction(const ForceElement& e, const ElementStep& at, double z, double limit) noexcept {
  switch (e.law) {
    case ElementLaw::exponential:
      return z < 0. ? exponential(e, at, -1., -z, limit) : exponential(e, at, 1., z, limit);
    case ElementLaw::berg:
      return berg(e, at, z, limit);
    default:
      break;
  }
  return slider(e, at, z, limit);
}

// The z of q = z - compliance F(z) for each law.

/// A curve over rate z + rate_at_zero: each piece of it is straight in q, too.
double on_curve(const RisingCurve& curve, double rate, double rate_at_zero, double compliance,
                double q) noexcept {
  const auto z_at = [&](std::int32_t i) noexcept {
    return (curve.point[std::ptrdiff_t{3} * i] - rate_at_zero) / rate;
  };
  const auto q_at = [&](std::int32_t i) noexcept {
    return z_at(i) + compliance * curve.point[std::ptrdiff_t{3} * i + 1];
  };
  std::int32_t low = 0, high = curve.points;
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    (q_at(middle) <= q ? low : high) = middle;
  }
  const double beyond = q - q_at(low);
  const double slope =
      (beyond < 0. ? curve.slope_before : curve.point[std::ptrdiff_t{3} * low + 2]) * rate;
  return z_at(low) + beyond / (1. + compliance * slope);
}

double on_slider(const ForceElement& e, const ElementStep& at, double limit, double compliance,
                 double q) noexcept {
  const double slope = e.stiffness + e.damping * at.rate,
               z = (q - compliance * e.damping * at.rate_at_zero) / (1. + compliance * slope),
               held = slope * z + e.damping * at.rate_at_zero;
  return held > limit ? q - compliance * limit : held < -limit ? q + compliance * limit : z;
}

/// By Newton's method from below: along the way from the last force on the friction is concave.
double on_exponential(const ForceElement& e, const ElementStep& at, double limit, double compliance,
                      double q) noexcept {
  if (!(limit > 0.)) return q;
  constexpr int kCap = 24;
  const double before = within(at.memory[1], limit), sign = q < compliance * before ? -1. : 1.,
               beyond = sign * q - compliance * limit;
  double way = beyond > 0. ? beyond : 0.;
  for (int i = 0; i < kCap; ++i) {
    const Friction own = exponential(e, at, sign, way, limit);
    const double step =
        (sign * q - way - compliance * sign * own.force) / (1. + compliance * own.slope);
    if (!(step > 1e-15 * way)) break;
    way += step;
  }
  return sign * way;
}

/// On a branch way + compliance m way / (m / k + way) = reach, a quadratic.
double on_berg(const ForceElement& e, const ElementStep& at, double limit, double compliance,
               double q) noexcept {
  const double sign = q < compliance * at.memory[3] ? -1. : 1.;
  const Branch branch = branch_of(at, sign);
  const double since = sign * branch.way - 1., missing = limit - sign * branch.from,
               soft = missing / e.stiffness, reach = sign * (q - compliance * branch.from) + since,
               b = soft + compliance * missing - reach, root = std::sqrt(b * b + 4. * reach * soft);
  if (!(root > 0.) || !(reach > 0.)) return q - compliance * branch.from;
  const double way = b > 0. ? 2. * reach * soft / (b + root) : .5 * (root - b);
  return sign * (way - since);
}

double displacement_behind(const ForceElement& e, const ElementStep& at, double compliance,
                           double q, double load) noexcept {
  switch (e.law) {
    case ElementLaw::spring:
      return on_curve(e.curve, 1., 0., compliance, q);
    case ElementLaw::damper:
      return on_curve(e.curve, at.rate, at.rate_at_zero, compliance, q);
    case ElementLaw::actuator:
      return q + compliance * at.value;
    case ElementLaw::controlled:
      return (q - compliance * at.value * at.rate_at_zero) / (1. + compliance * at.value * at.rate);
    case ElementLaw::exponential:
      return on_exponential(e, at, limit_of(e, at, load).value, compliance, q);
    case ElementLaw::berg:
      return on_berg(e, at, limit_of(e, at, load).value, compliance, q);
    case ElementLaw::slider:
      break;
  }
  return on_slider(e, at, limit_of(e, at, load).value, compliance, q);
}

}  // namespace

ElementForce element_force(const ForceElement& e, const ElementStep& at, double z,
                           double load) noexcept {
  if (e.law == ElementLaw::spring) {
    const CurveValue own = curve_at(e.curve, z);
    return {-own.value, -own.slope, 0.};
  }
  if (e.law == ElementLaw::damper) {
    const CurveValue own = curve_at(e.curve, at.rate * z + at.rate_at_zero);
    return {-own.value, -own.slope * at.rate, 0.};
  }
  if (e.law == ElementLaw::actuator) return {at.value, 0., 0.};
  if (e.law == ElementLaw::controlled)
    return {-at.value * (at.rate * z + at.rate_at_zero), -at.value * at.rate, 0.};
  const Limit limit = limit_of(e, at, load);
  const Friction own = friction(e, at, z, limit.value);
  return {-own.force, -own.slope, -own.limit_slope * limit.load_slope};
}

ElementForce element_force_behind(const ForceElement& e, const ElementStep& at, double compliance,
                                  double q, double load) noexcept {
  const double z = displacement_behind(e, at, compliance, q, load);
  const ElementForce own = element_force(e, at, z, load);
  const double part = 1. / (1. - compliance * own.slope);
  return {own.force, part * own.slope, part * own.load_slope};
}

void keep_element(const ForceElement& e, const ElementStep& at, double z, double load,
                  double* memory) noexcept {
  if (!is_friction(e.law)) return;
  const double limit = limit_of(e, at, load).value;
  if (e.law == ElementLaw::slider) {
    const double most = limit / e.stiffness;
    if (z > most) memory[0] += z - most;
    if (z < -most) memory[0] += z + most;
    return;
  }
  const Friction own = friction(e, at, z, limit);
  const Branch branch = e.law == ElementLaw::berg ? branch_of(at, z) : Branch{0., 0.};
  memory[0] += z;
  if (e.law == ElementLaw::exponential) {
    memory[1] = own.force;
    return;
  }
  memory[1] = branch.from;
  memory[2] = branch.way;
  memory[3] = own.force;
}

}  // namespace railstep
