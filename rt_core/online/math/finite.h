#pragma once

namespace railstep {

inline bool is_finite(double x) noexcept { return x - x == 0.; }
inline bool is_above_zero(double x) noexcept { return x > 0. && is_finite(x); }
inline bool is_not_negative(double x) noexcept { return x >= 0. && is_finite(x); }

}  // namespace railstep
