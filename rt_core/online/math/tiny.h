#pragma once

namespace railstep {

/// What is below this in size is 0 in a state. Processors flush results below 2^-1022 to 0, but x86
/// looks at the rounded result and ARM at the exact one: what decays must stop well above that for
/// the same bits on both, and so that no subnormal number is ever met.
inline constexpr double kTiny = 0x1p-960;

inline double without_tiny(double x) noexcept { return x < kTiny && x > -kTiny ? 0. : x; }

}  // namespace railstep
