#pragma once

namespace railstep {

inline constexpr double kTwoPi = 6.28318530717958647692;

/// Cosine and sine of 2 pi t, the same bits on every machine: the C library's are not.
/// |t| below 2^51; error below 2e-16.
struct CosineSine {
  double cosine, sine;
};
CosineSine cosine_sine(double t);

}  // namespace railstep
