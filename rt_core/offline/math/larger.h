#pragma once

namespace railstep {

/// The larger one, or one that is not a number: std::max(error, NaN) is `error`, as if all was
/// well.
inline double larger(double a, double b) { return b > a || b != b ? b : a; }

}  // namespace railstep
