#pragma once
#include <cmath>

namespace railstep {

/// A number with its first derivatives along n directions: forward automatic differentiation.
template <int n>
struct Dual {
  double value;
  double slope[n];

  Dual() noexcept = default;
  Dual(double constant) noexcept : value(constant), slope{} {}  // a number is a constant
  /// The number of direction k. @param rate  its derivative along it
  static Dual along(int k, double value, double rate = 1.) noexcept {
    Dual x(value);
    x.slope[k] = rate;
    return x;
  }
};

namespace dual {

/// f(x) with f'(x) = rate.
template <int n>
Dual<n> chain(double value, double rate, const Dual<n>& x) noexcept {
  Dual<n> y;
  y.value = value;
#pragma omp simd
  for (int k = 0; k < n; ++k) y.slope[k] = rate * x.slope[k];
  return y;
}

/// f(x, y) with the partial derivatives by_x and by_y.
template <int n>
Dual<n> chain(double value, double by_x, const Dual<n>& x, double by_y, const Dual<n>& y) noexcept {
  Dual<n> z;
  z.value = value;
#pragma omp simd
  for (int k = 0; k < n; ++k) z.slope[k] = by_x * x.slope[k] + by_y * y.slope[k];
  return z;
}

}  // namespace dual

template <int n>
Dual<n> operator-(const Dual<n>& x) noexcept {
  return dual::chain(-x.value, -1., x);
}
template <int n>
Dual<n> operator+(const Dual<n>& x, const Dual<n>& y) noexcept {
  return dual::chain(x.value + y.value, 1., x, 1., y);
}
template <int n>
Dual<n> operator+(const Dual<n>& x, double y) noexcept {
  return dual::chain(x.value + y, 1., x);
}
template <int n>
Dual<n> operator+(double x, const Dual<n>& y) noexcept {
  return y + x;
}
template <int n>
Dual<n> operator-(const Dual<n>& x, const Dual<n>& y) noexcept {
  return dual::chain(x.value - y.value, 1., x, -1., y);
}
template <int n>
Dual<n> operator-(const Dual<n>& x, double y) noexcept {
  return dual::chain(x.value - y, 1., x);
}
template <int n>
Dual<n> operator-(double x, const Dual<n>& y) noexcept {
  return dual::chain(x - y.value, -1., y);
}
template <int n>
Dual<n> operator*(const Dual<n>& x, const Dual<n>& y) noexcept {
  return dual::chain(x.value * y.value, y.value, x, x.value, y);
}
template <int n>
Dual<n> operator*(const Dual<n>& x, double y) noexcept {
  return dual::chain(x.value * y, y, x);
}
template <int n>
Dual<n> operator*(double x, const Dual<n>& y) noexcept {
  return y * x;
}
template <int n>
Dual<n> operator/(const Dual<n>& x, const Dual<n>& y) noexcept {
  const double quotient = x.value / y.value;
  return dual::chain(quotient, 1. / y.value, x, -quotient / y.value, y);
}
template <int n>
Dual<n> operator/(const Dual<n>& x, double y) noexcept {
  return dual::chain(x.value / y, 1. / y, x);
}
template <int n>
Dual<n> operator/(double x, const Dual<n>& y) noexcept {
  const double quotient = x / y.value;
  return dual::chain(quotient, -quotient / y.value, y);
}
/// The square root of x above 0.
template <int n>
Dual<n> sqrt(const Dual<n>& x) noexcept {
  const double root = std::sqrt(x.value);
  return dual::chain(root, .5 / root, x);
}
template <int n>
bool operator>(const Dual<n>& x, double y) noexcept {
  return x.value > y;
}

}  // namespace railstep
