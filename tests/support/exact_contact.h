#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>

namespace railstep::exact {

// Cones of wheels on circles of railheads and creep on them, with nothing linearised but the
// law of creep. Written apart from rt_core. Derivatives are complex steps. Axes as in railstep.

using Complex = std::complex<double>;
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

// Eigen's products of complex vectors conjugate.
template <typename T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Axes of a wheelset: ahead and level, and along the axle to the left.
template <typename T>
Vector3<T> ahead(const T& yaw) {
  using std::cos;
  using std::sin;
  return {cos(yaw), sin(yaw), T(0)};
}
template <typename T>
Vector3<T> axle(const T& roll, const T& yaw) {
  using std::cos;
  using std::sin;
  return {-sin(yaw) * cos(roll), cos(yaw) * cos(roll), sin(roll)};
}

/// Flanges are cones of 70 degrees on round gauge corners. With them creep has Shen, Hedrick and
/// Elkins' limit.
struct Flange {
  double friction;   // 0: no flanges, and creep is linear
  double clearance;  // m along y, of a centred and level wheelset
  double hertz;      // N/m^1.5
  // As railstep takes given coefficients: a wheel's, shared out by the normal forces, and force
  // turns towards the slip as it saturates. Otherwise those of a patch that grows with its force.
  bool shared;
};

constexpr double kRadius = .46, kHalfDistance = .75, kCrown = .3, kTreadHertz = 94125079189.525375,
                 kMeanLoad = 54546.;                                      // N, of kCreep
constexpr std::array<double, 4> kCreep = {9.25e6, 8.52e6, 1.95e4, 53.8};  // N, N, N m, N m2
/// The gauge corner's circle, from the contact of a centred wheelset: inwards and upwards, m.
constexpr double kCornerRadius = 13e-3, kCornerIn = 20.371867186408487e-3,
                 kCornerUp = -17.545352271402063e-3;

/// A cone, which has the radius kRadius at wheel_y, on a circle of the rail.
struct Surface {
  double slope, wheel_y, radius, rail_y, rail_z, hertz;
};

inline Surface tread_surface(double slope) {
  const double cosine = 1. / std::sqrt(1. + slope * slope);
  return {
      slope,      kHalfDistance, kCrown, kHalfDistance + kCrown * slope * cosine, -kCrown * cosine,
      kTreadHertz};
}
inline Surface flange_surface(const Flange& flange) {
  const double angle = 70. * M_PI / 180., in = kCornerIn + kCornerRadius * std::sin(angle),
               up = kCornerUp + kCornerRadius * std::cos(angle), slope = std::tan(angle);
  return {slope,         kHalfDistance - in - flange.clearance - up / slope,
          kCornerRadius, kHalfDistance - kCornerIn,
          kCornerUp,     flange.hertz};
}

template <typename T>
struct Touch {
  Vector3<T> arm, normal;  // from the wheelset's centre; away from the rail
  T force;                 // N, normal
};

/// @param side  1 left, -1 right
/// @param c, e  the wheelset's centre and its axle
template <typename T>
Touch<T> touch(const Surface& s, double side, const Vector3<T>& c, const Vector3<T>& e) {
  using std::sqrt;
  const double g = s.slope, cg = 1. / std::sqrt(1. + g * g), sg = g * cg;
  T place = c[0];
  Vector3<T> r, across;
  T along, far;
  for (int i = 0; i < 9; ++i) {
    r = Vector3<T>{place, T(side * s.rail_y), T(s.rail_z)} - c;
    along = dot<T>(r, e);
    across = r - along * e;
    far = sqrt(dot<T>(across, across));
    const T slope = across[0] / far + side * g * e[0];
    if (i == 8) break;
    place -= slope * far / (1. - e[0] * e[0] - (across[0] / far) * (across[0] / far));
  }
  const T depth = s.radius - (far - (kRadius - side * g * (along - side * s.wheel_y))) * cg;
  const Vector3<T> n = -(cg / far * across + side * sg * e);
  return {r + s.radius * n, n, std::real(depth) > 0. ? T(s.hertz * depth * sqrt(depth)) : T(0)};
}

/// Creep of a patch: forces along and across, and the moment about the normal, on the wheel.
template <typename T>
struct Creep {
  T x, y, moment;
};

/// @param part  of the wheel's normal force that the patch has
template <typename T>
Creep<T> creep_force(const Flange& flange, const T& normal, const T& part, const T& slip_x,
                     const T& slip_y, const T& spin) {
  using std::pow;
  using std::sqrt;
  const bool limited = flange.friction > 0.;
  const T load = normal / kMeanLoad;
  const T size = !limited        ? T(1)
                 : flange.shared ? part
                                 : T(pow(load, 2. / 3.)),
          arm = !limited        ? T(1)
                : flange.shared ? part
                                : load,
          square = !limited        ? T(1)
                   : flange.shared ? part
                                   : T(pow(load, 4. / 3.));
  Creep<T> f{-kCreep[0] * size * slip_x, -kCreep[1] * size * slip_y - kCreep[2] * arm * spin,
             kCreep[2] * arm * slip_y - kCreep[3] * square * spin};
  if (!limited) return f;
  const T linear = sqrt(f.x * f.x + f.y * f.y), u = linear / (flange.friction * normal);
  const bool slides = std::real(u) > 3.;
  const T left = slides ? 1. / u : 1. - u / 3. + u * u / 27.;
  if (flange.shared) {
    const T turned = slides ? T(1) : u * u / 9.;
    const double half = .5 * (kCreep[0] - kCreep[1]);
    f.x += turned * half * part * slip_x;
    f.y -= turned * half * part * slip_y;
  }
  const T per = left * linear / sqrt(f.x * f.x + f.y * f.y);
  return {per * f.x, per * f.y, left * f.moment};
}

}  // namespace railstep::exact
