#pragma once
#include "online/math/vector3.h"

namespace railstep {

// Rotations without the C library's functions, whose last bits differ between machines. Matrices
// are [9], row after row; quaternions [w, x, y, z]; R rotates body axes into the ground's.

/// y = R x.
inline void rotate(const double* R, const double* x, double* y) noexcept {
  const double a = dot(R, x), b = dot(R + 3, x);
  y[2] = dot(R + 6, x);
  y[0] = a;
  y[1] = b;
}

/// y = R' x.
inline void rotate_back(const double* R, const double* x, double* y) noexcept {
  const double a = (R[0] * x[0] + R[3] * x[1]) + R[6] * x[2];
  const double b = (R[1] * x[0] + R[4] * x[1]) + R[7] * x[2];
  y[2] = (R[2] * x[0] + R[5] * x[1]) + R[8] * x[2];
  y[0] = a;
  y[1] = b;
}

/// cos x and sin(x) / x for |x| <= pi, by Taylor's series to x^24: 1e-15 at pi.
struct CosSinc {
  double cos, sinc;
};
CosSinc cos_sinc(double x_squared) noexcept;

/// cos and sin of any angle, rad, brought to [-pi, pi] first.
struct CosSin {
  double cos, sin;
};
CosSin cos_sin(double angle) noexcept;

/// q1 = q0 exp(rotation), a rotation vector in body axes of at most 2 pi; of unit length.
void rotated(const double* q0, const double* rotation, double* q1) noexcept;

/// q1 = q0 cay(rotation), by the angle 2 atan(|rotation| / 2), which is exact with the mean of both
/// ends' directions: R1 - R0 = [R0 rotation]x (R0 + R1) / 2.
void rotated_by_mean(const double* q0, const double* rotation, double* q1) noexcept;

void rotation_matrix(const double* q, double* R) noexcept;

}  // namespace railstep
