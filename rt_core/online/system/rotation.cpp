#include "online/system/rotation.h"

#include <cstdint>

#include "online/math/pi.h"
#include "online/math/scalar.h"
#include "online/math/sine.h"

namespace railstep {

namespace {

/// q0 (w, v), normalised to unit length.
void product(const double* q0, double w, const double* v, double* q1) noexcept {
  const double a = q0[0], b = q0[1], c = q0[2], d = q0[3];
  const double q[4] = {
      ((a * w - b * v[0]) - c * v[1]) - d * v[2], ((a * v[0] + b * w) + c * v[2]) - d * v[1],
      ((a * v[1] - b * v[2]) + c * w) + d * v[0], ((a * v[2] + b * v[1]) - c * v[0]) + d * w};
  const double length = square_root((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]));
  for (int k = 0; k < 4; ++k) q1[k] = q[k] / length;
}

}  // namespace

CosSinc cos_sinc(double x_squared) noexcept {
  return {cosine_series(x_squared, 24), sinc_series(x_squared, 24)};
}

CosSin cos_sin(double angle) noexcept {
  const double revolutions = angle / (2. * kPi);
  if (!(revolutions > -1e15 && revolutions < 1e15))
    return {revolutions - revolutions, revolutions - revolutions};  // no angle: NaN
  const double whole = static_cast<double>(
      static_cast<std::int64_t>(revolutions < 0. ? revolutions - .5 : revolutions + .5));
  const double x = (revolutions - whole) * (2. * kPi);
  const CosSinc at = cos_sinc(x * x);
  return {at.cos, at.sinc * x};
}

void rotated(const double* q0, const double* rotation, double* q1) noexcept {
  const CosSinc half = cos_sinc(.25 * dot(rotation, rotation));
  const double v[3] = {.5 * half.sinc * rotation[0], .5 * half.sinc * rotation[1],
                       .5 * half.sinc * rotation[2]};
  product(q0, half.cos, v, q1);
}

void rotated_by_mean(const double* q0, const double* rotation, double* q1) noexcept {
  const double v[3] = {.5 * rotation[0], .5 * rotation[1], .5 * rotation[2]};
  product(q0, 1., v, q1);
}

void rotation_matrix(const double* q, double* R) noexcept {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  R[0] = 1. - 2. * (y * y + z * z);
  R[1] = 2. * (x * y - w * z);
  R[2] = 2. * (x * z + w * y);
  R[3] = 2. * (x * y + w * z);
  R[4] = 1. - 2. * (x * x + z * z);
  R[5] = 2. * (y * z - w * x);
  R[6] = 2. * (x * z - w * y);
  R[7] = 2. * (y * z + w * x);
  R[8] = 1. - 2. * (x * x + y * y);
}

}  // namespace railstep
