#pragma once

namespace railstep {

/// Far above every number of a model or a state. Products of four numbers below it are far from
/// overflow.
inline constexpr double kMostNumber = 0x1p200;  // 1.6e60

/// False for infinities and NaN.
inline bool is_moderate(double x) noexcept { return x > -kMostNumber && x < kMostNumber; }
inline bool is_above_zero(double x) noexcept { return x > 0. && is_moderate(x); }
inline bool is_not_negative(double x) noexcept { return x >= 0. && is_moderate(x); }

}  // namespace railstep
