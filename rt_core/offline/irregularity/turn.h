#pragma once

namespace railstep {

/// Cosine and sine of 2 pi t, the same bits on every machine: the C library's are not.
/// |t| below 2^51; error below 2e-16.
struct Turn {
  double cosine, sine;
};
Turn turn(double t);

}  // namespace railstep
