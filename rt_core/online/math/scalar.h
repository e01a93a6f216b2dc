#pragma once

namespace railstep {

// Without the C library, whose calls the online side avoids where the compiler has its own.
inline double square_root(double x) noexcept { return __builtin_sqrt(x); }
inline double magnitude(double x) noexcept { return __builtin_fabs(x); }

/// The larger one; `a` if `b` is not a number.
inline double larger(double a, double b) noexcept { return b > a ? b : a; }

}  // namespace railstep
