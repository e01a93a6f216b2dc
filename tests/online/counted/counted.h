// Included before every source of a build of the online library that counts its arithmetic: each
// `double` becomes a number that counts. Headers of the standard library come first and keep their
// own doubles.
#pragma once
#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace counted {

/// Additions, subtractions, multiplications, divisions and square roots so far, one each. Changes
/// of sign, comparisons and conversions do not count, nor do constants that the compiler works out.
inline std::int64_t flops = 0;

class Number {
 public:
  Number() = default;
  template <typename T>
  requires std::is_arithmetic_v<T>
  constexpr Number(T value) noexcept : value_(static_cast<double>(value)) {}
  template <typename T>
  requires std::is_arithmetic_v<T>
  constexpr explicit operator T() const noexcept { return static_cast<T>(value_); }
  constexpr double plain() const noexcept { return value_; }

  friend constexpr Number operator+(Number a, Number b) noexcept {
    return did(a.value_ + b.value_);
  }
  friend constexpr Number operator-(Number a, Number b) noexcept {
    return did(a.value_ - b.value_);
  }
  friend constexpr Number operator*(Number a, Number b) noexcept {
    return did(a.value_ * b.value_);
  }
  friend constexpr Number operator/(Number a, Number b) noexcept {
    return did(a.value_ / b.value_);
  }
  constexpr Number& operator+=(Number b) noexcept { return *this = *this + b; }
  constexpr Number& operator-=(Number b) noexcept { return *this = *this - b; }
  constexpr Number& operator*=(Number b) noexcept { return *this = *this * b; }
  constexpr Number& operator/=(Number b) noexcept { return *this = *this / b; }
  constexpr Number operator-() const noexcept { return -value_; }

  friend constexpr bool operator==(Number a, Number b) noexcept { return a.value_ == b.value_; }
  friend constexpr bool operator!=(Number a, Number b) noexcept { return a.value_ != b.value_; }
  friend constexpr bool operator<(Number a, Number b) noexcept { return a.value_ < b.value_; }
  friend constexpr bool operator>(Number a, Number b) noexcept { return a.value_ > b.value_; }
  friend constexpr bool operator<=(Number a, Number b) noexcept { return a.value_ <= b.value_; }
  friend constexpr bool operator>=(Number a, Number b) noexcept { return a.value_ >= b.value_; }

  static constexpr Number did(double value) noexcept {
    if (!std::is_constant_evaluated()) ++flops;
    return value;
  }

 private:
  double value_;
};
static_assert(sizeof(Number) == sizeof(double) && std::is_trivially_copyable_v<Number>);

}  // namespace counted

/// In a namespace apart from Number, so that the sources call their own functions of these names.
namespace counted_functions {
inline counted::Number square_root(counted::Number x) noexcept {
  return counted::Number::did(std::sqrt(x.plain()));
}
inline counted::Number magnitude(counted::Number x) noexcept { return std::fabs(x.plain()); }
}  // namespace counted_functions

// Functions of the standard library that the online sources call.
namespace std {
inline counted::Number sqrt(counted::Number x) noexcept {
  return counted_functions::square_root(x);
}
inline counted::Number fabs(counted::Number x) noexcept { return counted_functions::magnitude(x); }
inline bool isfinite(counted::Number x) noexcept { return isfinite(x.plain()); }
template <>
struct numeric_limits<counted::Number> : numeric_limits<double> {};
}  // namespace std

#define RAILSTEP_NO_AVX2  // a vector register cannot hold such a number
#define __builtin_sqrt(x) counted_functions::square_root(x)
#define __builtin_fabs(x) counted_functions::magnitude(x)
#define double counted::Number
