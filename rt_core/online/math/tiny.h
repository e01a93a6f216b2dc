#pragma once

namespace railstep {

/// Smaller magnitudes are set to 0 in a state. Processors flush results below 2^-1022 to 0, but x86
/// tests the rounded result and ARM the exact one. Decaying numbers must stop well above that, for
/// the same bits on both and so that no subnormal number ever occurs.
inline constexpr double kTiny = 0x1p-960;

inline double without_tiny(double x) noexcept { return x < kTiny && x > -kTiny ? 0. : x; }

}  // namespace railstep
