#pragma once

namespace railstep {

/// What no number of a model or of a state comes near. Products of four below it are far from where
/// they overflow.
inline constexpr double kMostNumber = 0x1p200;  // 1.6e60

/// Not of infinities and of what is no number.
inline bool is_moderate(double x) noexcept { return x > -kMostNumber && x < kMostNumber; }
inline bool is_above_zero(double x) noexcept { return x > 0. && is_moderate(x); }
inline bool is_not_negative(double x) noexcept { return x >= 0. && is_moderate(x); }

}  // namespace railstep
