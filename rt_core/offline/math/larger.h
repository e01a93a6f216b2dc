#pragma once

namespace railstep {

/// The larger of two numbers, or NaN if one of them is NaN. std::max(error, NaN) would return
/// `error`, which hides the NaN.
inline double larger(double a, double b) { return b > a || b != b ? b : a; }

}  // namespace railstep
