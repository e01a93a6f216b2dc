#include "offline/contact/hertz.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "offline/math/hertz_depth.h"
#include "offline/math/refuse.h"

namespace railstep {
namespace {

void require(bool holds, MessageId id, double got, const char* what, const char* expected) {
  if (!holds)
    refuse(id, std::string(what) + " is " + std::to_string(got) + "; expected " + expected);
}

/// Functions of m that give the axes. ratio = (E/k^2 - K)/(K - E) falls from infinity at k = 0 to 1
/// at k = 1.
struct Shape {
  double K, K_less_E, ratio;
};

Shape shape(double m) {
  const auto [K, E] = elliptic_integrals(m);
  // Near a circle numerator and denominator vanish like pi m/4: series, off by O(m^2).
  if (m < 1e-5) {
    const double half_pi = std::numbers::pi / 2.0;
    return {K, half_pi * m * (0.5 + m * (3.0 / 16.0)), 1.0 + 0.75 * m};
  }
  return {K, K - E, (E / (1.0 - m) - K) / (K - E)};
}

/// m = 1 - k^2 of the ratio of curvatures >= 1, by bisection in log k.
double find_modulus(double ratio) {
  if (ratio == 1.0) return 0.0;
  double low = std::log(1e-7), high = 0.0;  // log k
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (shape(-std::expm1(2.0 * middle)).ratio > ratio ? low : high) = middle;
  }
  return -std::expm1(low + high);
}

}  // namespace

EllipticIntegrals elliptic_integrals(double m) {
  double a = 1.0, b = std::sqrt(1.0 - m), sum = m, weight = 1.0;
  // c_n^2 2^n, c_0^2 = m; quadratic convergence: m = 1 - 1e-14 needs 7 rounds.
  for (int i = 0; i < 12; ++i) {
    const double c = 0.5 * (a - b), mean = 0.5 * (a + b);
    weight *= 2.0;
    sum += weight * c * c;
    b = std::sqrt(a * b);
    a = mean;
  }
  const double K = std::numbers::pi / (2.0 * a);
  return {K, K * (1.0 - 0.5 * sum)};
}

HertzContact hertz_contact(double wheel_radius, double crown_radius, double young, double poisson,
                           double load) {
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(positive(wheel_radius), "E-CONTACT-01", wheel_radius, "the wheel radius",
          "a length above 0 m");
  require(positive(crown_radius), "E-CONTACT-02", crown_radius, "the crown radius",
          "a length above 0 m");
  require(positive(young), "E-CONTACT-03", young, "Young's modulus", "a number of Pa above 0");
  require(poisson > -1.0 && poisson <= 0.5, "E-CONTACT-04", poisson, "Poisson's ratio",
          "above -1, at most 0.5");
  require(positive(load), "E-CONTACT-05", load, "the load", "a force above 0 N");
  const double along = 0.5 / wheel_radius, across = 0.5 / crown_radius;
  const double small = std::min(along, across), ratio = std::max(along, across) / small;
  require(ratio <= 1e6, "E-CONTACT-06", ratio, "the ratio of wheel and crown radius",
          "at most 1e6 (beyond it the contact is a line)");

  const double m = find_modulus(ratio);
  const Shape s = shape(m);
  const double modulus = young / (2.0 * (1.0 - poisson * poisson));
  // (K - E)/m tends to pi/4 for a circle.
  const double per_m = m > 0.0 ? s.K_less_E / m : std::numbers::pi / 4.0;
  const double longer = std::cbrt(3.0 * load * per_m / (2.0 * std::numbers::pi * modulus * small));
  const double shorter = longer * std::sqrt(1.0 - m);
  HertzContact out{};
  out.peak_pressure = 1.5 * load / (std::numbers::pi * longer * shorter);
  out.approach = out.peak_pressure * shorter * s.K / modulus;
  out.constant = load / (out.approach * std::sqrt(out.approach));
  out.half_along = along > across ? shorter : longer;
  out.half_across = along > across ? longer : shorter;
  out.stiffness = 1.5 * load / out.approach;
  return out;
}

double hertz_constant(double wheel_radius, double crown_radius, double young, double poisson) {
  constexpr double kAnyLoad = 1e3;  // N
  return hertz_contact(wheel_radius, crown_radius, young, poisson, kAnyLoad).constant;
}

double contact_depth(const ContactLaw& contact, double force) {
  return contact.hertz > 0. ? hertz_depth(force, contact.hertz) : force / contact.stiffness;
}

}  // namespace railstep
