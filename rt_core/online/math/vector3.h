#pragma once

namespace railstep {

struct Vector3 {
  double x, y, z;
};
inline Vector3 vector3(const double* v) noexcept { return {v[0], v[1], v[2]}; }

inline Vector3 operator+(Vector3 a, Vector3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3 operator-(Vector3 a, Vector3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3 operator*(double s, Vector3 a) noexcept { return {s * a.x, s * a.y, s * a.z}; }

inline double dot(Vector3 a, Vector3 b) noexcept { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
inline Vector3 cross(Vector3 a, Vector3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double dot(const double* a, const double* b) noexcept { return dot(vector3(a), vector3(b)); }
/// c may be a or b.
inline void cross(const double* a, const double* b, double* c) noexcept {
  const Vector3 product = cross(vector3(a), vector3(b));
  c[0] = product.x;
  c[1] = product.y;
  c[2] = product.z;
}

}  // namespace railstep
