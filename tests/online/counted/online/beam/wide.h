#pragma once

// Stands in for the library's own header where every `double` counts (counted.h): the compiler's
// vectors hold plain numbers only.
#define RAILSTEP_KERNELS railstep
namespace railstep {

struct Two {
  double lane[2];

  constexpr double& operator[](int l) noexcept { return lane[l]; }
  constexpr double operator[](int l) const noexcept { return lane[l]; }
  friend constexpr Two operator+(Two a, Two b) noexcept { return {a[0] + b[0], a[1] + b[1]}; }
  friend constexpr Two operator-(Two a, Two b) noexcept { return {a[0] - b[0], a[1] - b[1]}; }
  friend constexpr Two operator*(Two a, Two b) noexcept { return {a[0] * b[0], a[1] * b[1]}; }
  friend constexpr Two operator/(Two a, Two b) noexcept { return {a[0] / b[0], a[1] / b[1]}; }
  friend constexpr Two operator+(Two a, double b) noexcept { return a + Two{b, b}; }
  friend constexpr Two operator*(Two a, double b) noexcept { return a * Two{b, b}; }
  friend constexpr Two operator*(double a, Two b) noexcept { return Two{a, a} * b; }
  friend constexpr Two operator/(double a, Two b) noexcept { return Two{a, a} / b; }
  constexpr Two& operator+=(Two b) noexcept { return *this = *this + b; }
  constexpr Two& operator-=(Two b) noexcept { return *this = *this - b; }
  constexpr Two& operator+=(double b) noexcept { return *this = *this + b; }
  constexpr Two& operator-=(double b) noexcept { return *this += -b; }
  constexpr Two& operator*=(Two b) noexcept { return *this = *this * b; }
  constexpr Two& operator*=(double b) noexcept { return *this = *this * b; }
  constexpr Two operator-() const noexcept { return {-lane[0], -lane[1]}; }
};
using Wide = Two;
inline constexpr int kWide = 2;

inline Wide load(const double* from) noexcept { return {from[0], from[1]}; }
inline void store(const Wide& x, double* to) noexcept {
  to[0] = x[0];
  to[1] = x[1];
}
inline void transpose(Wide* x) noexcept { std::swap(x[0][1], x[1][0]); }

}  // namespace railstep
