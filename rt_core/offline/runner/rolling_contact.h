#pragma once
#include <cmath>

#include "offline/runner/runner.h"

namespace railstep {

/// Force of a rail on a wheel, in the track's axes.
template <typename T>
struct WheelForce {
  T normal;          // N
  T creep[2];        // along and across the rail, N
  T on_wheel[3];     // sum, N
  T generalised[6];  // over the wheelset's motions, N and N m
};

namespace tread_contact {

template <typename T>
struct Vector {
  T x, y, z;
};
template <typename T>
Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
Vector<T> operator*(const T& f, const Vector<T>& a) {
  return {f * a.x, f * a.y, f * a.z};
}
template <typename T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Axes of a wheelset that do not spin.
template <typename T>
struct Axes {
  Vector<T> ahead, axle;
};
template <typename T>
Axes<T> axes_of(const T* u) {
  using std::cos;
  using std::sin;
  const T sr = sin(u[3]), cr = cos(u[3]), sy = sin(u[5]), cy = cos(u[5]);
  return {{cy, sy, T(0.)}, {-sy * cr, cy * cr, sr}};
}

/// Where a wheel touches its rail.
template <typename T>
struct Touch {
  Vector<T> normal, arm;  // unit, from the rail to the wheel; from the wheelset's centre, m
  T depth;                // penetration, m
};

/// Closest approach of a cone about the axle and the crown's centre line, which runs along x.
/// @param side  1 of the left wheel, -1 of the right
template <typename T>
Touch<T> touch(const RollingContact& c, double radius, double side, const T* u,
               const Axes<T>& axes) {
  using std::sqrt;
  const double cosine = 1. / std::sqrt(1. + c.slope * c.slope), sine = c.slope * cosine;
  const Vector<T> from = {T(0.), T(side * (c.half_distance + c.crown_radius * sine)) - u[1],
                          T(-c.crown_radius * cosine - radius) - u[2]};
  Vector<T> r = from, across = from;
  T x = T(0.), along = T(0.), far = T(0.);
  for (int i = 0; i < 8; ++i) {  // Newton, quadratic from centimetres off
    r.x = x;
    along = dot(r, axes.axle);
    across = r + T(-along) * axes.axle;
    far = sqrt(dot(across, across));
    const T slope = across.x / far + side * c.slope * axes.axle.x;
    const T sine_x = across.x / far;
    x = x - slope * far / (1. - axes.axle.x * axes.axle.x - sine_x * sine_x);
  }
  const T wheel = radius - side * c.slope * (along - side * c.half_distance);
  const T distance = (far - wheel) * cosine;
  const Vector<T> normal = T(-cosine / far) * across + T(-side * sine) * axes.axle;
  return {normal, r + T(c.crown_radius) * normal, c.crown_radius - distance};
}

}  // namespace tread_contact

/// Force of the rail on one wheel of a wheelset that runs at a speed.
/// @param u, v  [6] motions of the wheelset and their rates
template <typename T>
WheelForce<T> wheel_force(const RollingContact& c, double radius, double side, double speed,
                          const T* u, const T* v) {
  using std::sqrt;
  using tread_contact::Axes, tread_contact::Touch, tread_contact::Vector;
  using tread_contact::cross, tread_contact::dot, tread_contact::touch;
  const Axes<T> axes = tread_contact::axes_of(u);
  const Touch<T> at = touch(c, radius, side, u, axes);
  const Vector<T> up = {T(0.), T(0.), T(1.)}, ahead = {T(1.), T(0.), T(0.)};
  const Vector<T> lateral = {T(0.), at.normal.z, -at.normal.y};
  const Vector<T> turning = v[3] * axes.ahead + v[5] * up + T(speed / radius + v[4]) * axes.axle;
  const Vector<T> centre = {speed + v[0], v[1], v[2]};
  const Vector<T> slip = centre + cross(turning, at.arm);
  const T xi_x = slip.x / speed, xi_y = dot(slip, lateral) / speed,
          xi_s = dot(turning, at.normal) / speed;
  WheelForce<T> f;
  f.normal = at.depth > 0. ? T(c.hertz * at.depth * sqrt(at.depth)) : T(0. * at.depth);
  f.creep[0] = -c.kalker[0] * xi_x;
  f.creep[1] = -c.kalker[1] * xi_y - c.kalker[2] * xi_s;
  const T moment = c.kalker[2] * xi_y - c.kalker[3] * xi_s;
  const Vector<T> sum = f.normal * at.normal + f.creep[1] * lateral + f.creep[0] * ahead;
  const Vector<T> torque = cross(at.arm, sum) + moment * at.normal;
  f.on_wheel[0] = f.generalised[0] = sum.x;
  f.on_wheel[1] = f.generalised[1] = sum.y;
  f.on_wheel[2] = f.generalised[2] = sum.z;
  f.generalised[3] = dot(torque, axes.ahead);
  f.generalised[4] = dot(torque, axes.axle);
  f.generalised[5] = torque.z;
  return f;
}

}  // namespace railstep
