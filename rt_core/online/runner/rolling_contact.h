#pragma once
#include <cmath>

#include "online/math/dual.h"
#include "online/math/sine.h"
#include "online/runner/rolling_creep.h"

namespace railstep {

// A wheel on its rail. Its geometry depends on four of the wheelset's motions alone: y, z, roll and
// yaw. T is double, or a Dual over these four.

inline constexpr BodyMotion kPlaced[4] = {BodyMotion::y, BodyMotion::z, BodyMotion::roll,
                                          BodyMotion::yaw};
using Placed = Dual<4>;

namespace tread_contact {

template <typename T>
struct Vector {
  T x, y, z;
};
template <typename T>
Vector<T> operator*(const T& f, const Vector<T>& a) noexcept {
  return {f * a.x, f * a.y, f * a.z};
}
template <typename T>
T dot(const Vector<T>& a, const Vector<T>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
struct CosineSine {
  T cosine, sine;
};
/// Within 3e-17 up to 0.1 rad, 3e-10 up to 0.5 rad.
inline CosineSine<double> turned(double angle) noexcept {
  const double square = angle * angle;
  return {cosine_series(square, 8), angle * sinc_series(square, 8)};
}
template <int n>
CosineSine<Dual<n>> turned(const Dual<n>& angle) noexcept {
  const CosineSine<double> at = turned(angle.value);
  return {dual::chain(at.cosine, -at.sine, angle), dual::chain(at.sine, at.cosine, angle)};
}

/// The axle of a wheelset that yaws and then rolls.
template <typename T>
struct Axle {
  T ahead_x, ahead_y;  // axis across it that does not roll, level
  Vector<T> along;

  Axle(const T& roll, const T& yaw) noexcept {
    const CosineSine<T> r = turned(roll), h = turned(yaw);
    ahead_x = h.cosine;
    ahead_y = h.sine;
    along = {-(h.sine * r.cosine), h.cosine * r.cosine, r.sine};
  }
};

/// A cone about the axle of a wheelset, and the crown's centre line, which runs along x.
template <typename T>
struct ConeOnCrown {
  const RollingContact& c;
  double radius, side;  // side: 1 of the left wheel, -1 of the right
  double cosine, sine;  // of the cone's half angle
  T y, z;               // from the wheelset's centre to the line
  const Vector<T>& axle;

  ConeOnCrown(const RollingContact& contact, double wheel_radius, double of_side, const T& u_y,
              const T& u_z, const Vector<T>& of_axle) noexcept
      : c(contact),
        radius(wheel_radius),
        side(of_side),
        cosine(1. / std::sqrt(1. + c.slope * c.slope)),
        sine(c.slope * cosine),
        y(side * (c.half_distance + c.crown_radius * sine) - u_y),
        z((-c.crown_radius * cosine - radius) - u_z),
        axle(of_axle) {}

  /// A point of the line, from the wheelset's centre: its part along the axle and across it.
  struct Point {
    T x, along, far;
    Vector<T> across;
  };
  Point point(const T& x) const noexcept {
    using std::sqrt;
    const T along = dot({x, y, z}, axle);
    const Vector<T> across = {x - along * axle.x, y - along * axle.y, z - along * axle.z};
    return {x, along, sqrt(dot(across, across)), across};
  }
  /// x of the point of the line that is nearest to the cone. The distance of the line from the axle
  /// is the root of level (x - vertex)^2 + least. At the nearest point it grows along the axle as
  /// the cone does.
  T nearest() const noexcept {
    using std::sqrt;
    const T along = y * axle.y + z * axle.z, square = axle.x * axle.x;
    const T level = 1. - square;
    const T vertex = along / level;
    const T least = (y * y + z * z) - along * vertex;
    const T steep = level * (level - (c.slope * c.slope) * square);
    return axle.x * (vertex - (side * c.slope) * sqrt(least / steep));
  }
};

}  // namespace tread_contact

/// Rows of a contact over the six motions of its wheelset: a unit force on the wheel at the contact
/// along the normal, along x and across, in the tangent plane, and a unit moment about the normal.
/// They also give the slip from the rates of the motions. Entries that are 0 are left out.
template <typename T>
struct WheelRows {
  T depth;     // penetration, m; its derivatives are the negative row of the normal
  T n_y, n_z;  // normal, from the rail to the wheel; across is (0, n_z, -n_y)
  T normal_roll, normal_yaw;
  T along_roll, along_spin, along_yaw;
  T across_roll, across_spin, across_yaw;
  T spin_roll, spin_spin;  // of the moment; n_z about z
  /// Penetration by a unit of roll of the rail's section, and slip across by a unit of its rate, m.
  /// The section rolls about the point from which it is placed: the centre of its crown, or with
  /// profiles its top. The moment on it is across_section times the force across on the wheel less
  /// normal_section times the normal force.
  double normal_section, across_section;
};

/// Fills rows whose normal is known.
/// @param arm  from the wheelset's centre to the contact
template <typename T>
void fill_rows(const tread_contact::Axle<T>& of, const tread_contact::Vector<T>& arm,
               WheelRows<T>& rows) noexcept {
  const auto& axle = of.along;
  // Motion of the contact by a unit of roll and of spin.
  const T rolled_x = of.ahead_y * arm.z, rolled_y = -(of.ahead_x * arm.z),
          rolled_z = of.ahead_x * arm.y - of.ahead_y * arm.x;
  const T spun_y = axle.z * arm.x - axle.x * arm.z, spun_z = axle.x * arm.y - axle.y * arm.x;
  rows.normal_roll = rows.n_y * rolled_y + rows.n_z * rolled_z;
  rows.normal_yaw = rows.n_y * arm.x;
  rows.along_roll = rolled_x;
  rows.along_spin = axle.y * arm.z - axle.z * arm.y;
  rows.along_yaw = -arm.y;
  rows.across_roll = rows.n_z * rolled_y - rows.n_y * rolled_z;
  rows.across_spin = rows.n_z * spun_y - rows.n_y * spun_z;
  rows.across_yaw = rows.n_z * arm.x;
  rows.spin_roll = rows.n_y * of.ahead_y;
  rows.spin_spin = rows.n_y * axle.y + rows.n_z * axle.z;
}

/// Treads that are cones.
/// @param side  1 of the left wheel, -1 of the right
/// Other parameters: motions of the wheelset over the rail.
template <typename T>
WheelRows<T> wheel_rows(const RollingContact& c, double radius, double side, const T& y, const T& z,
                        const T& roll, const T& yaw) noexcept {
  const tread_contact::Axle<T> of(roll, yaw);
  const auto& axle = of.along;
  const tread_contact::ConeOnCrown<T> pair(c, radius, side, y, z, axle);
  const auto p = pair.point(pair.nearest());
  WheelRows<T> rows;
  const T wheel = (radius + c.slope * c.half_distance) - (side * c.slope) * p.along;
  rows.depth = c.crown_radius - pair.cosine * (p.far - wheel);
  const T outwards = -pair.cosine / p.far;
  rows.n_y = outwards * p.across.y - (side * pair.sine) * axle.y;
  rows.n_z = outwards * p.across.z - (side * pair.sine) * axle.z;
  fill_rows(of, {p.x, pair.y + c.crown_radius * rows.n_y, pair.z + c.crown_radius * rows.n_z},
            rows);
  rows.normal_section = 0.;
  rows.across_section = c.crown_radius;
  return rows;
}

/// Forces at a contact: along its normal, N; of creep, along and across, N, and its moment, N m.
template <typename T>
struct ContactForces {
  T normal, along, across, moment;
};

/// How a rail moves under a wheel, m/s and rad/s: the point from which it is placed along y and z,
/// and its section about x.
struct RailRate {
  double y, z, roll;
};

/// Slip of a contact.
/// @param v      [6] rates of the wheelset's motions
/// @param speed  of the wheelset's frame, m/s
template <typename T>
Slip<T> slip_of(const WheelRows<T>& r, const double* v, double speed, double radius,
                const RailRate& rail) noexcept {
  const double spin = speed / radius + v[4];
  return {(speed + v[0]) + r.along_roll * v[3] + r.along_spin * spin + r.along_yaw * v[5],
          r.n_z * (v[1] - rail.y) - r.n_y * (v[2] - rail.z) + r.across_roll * v[3] +
              r.across_spin * spin + r.across_yaw * v[5] + r.across_section * rail.roll,
          r.spin_roll * v[3] + r.spin_spin * spin + r.n_z * v[5]};
}

/// Normal force of a contact in touch, N.
template <typename T>
T normal_force(const RollingContact& c, const T& depth) noexcept {
  using std::sqrt;
  return c.hertz * depth * sqrt(depth);
}

/// Over the six motions of the wheelset, N and N m.
template <typename T>
void generalise(const WheelRows<T>& r, const ContactForces<T>& f, T* force) noexcept {
  force[0] = f.along;
  force[1] = f.normal * r.n_y + f.across * r.n_z;
  force[2] = f.normal * r.n_z - f.across * r.n_y;
  force[3] = f.normal * r.normal_roll + f.along * r.along_roll + f.across * r.across_roll +
             f.moment * r.spin_roll;
  force[4] = f.along * r.along_spin + f.across * r.across_spin + f.moment * r.spin_spin;
  force[5] =
      f.normal * r.normal_yaw + f.along * r.along_yaw + f.across * r.across_yaw + f.moment * r.n_z;
}

/// Deviation of both railheads from straight, level lines under a wheelset, m, roll of their
/// sections, rad, and the part of their friction: [left, right]. Rates at which the frame pitches
/// and yaws on a design line, rad/s, and its place among the motions along x, m.
struct RailsUnder {
  double y[2] = {}, z[2] = {}, roll[2] = {}, grip[2] = {1., 1.};
  double frame_pitch = 0., frame_yaw = 0., frame_x = 0.;
};
/// Adds what the turning of a wheelset's frame makes to the rates of its material.
/// @param u, v  [6] motions of the wheelset, and their rates
inline void add_frame_rates(const RailsUnder& rails, double radius, const double* u,
                            double* v) noexcept {
  const double ahead = u[0] - rails.frame_x;
  v[0] += rails.frame_pitch * (radius + u[2]) - rails.frame_yaw * u[1];
  v[1] += rails.frame_yaw * ahead;
  v[2] -= rails.frame_pitch * ahead;
  v[4] += rails.frame_pitch;
  v[5] += rails.frame_yaw;
}
/// The motions of a wheelset over one of its rails. @param over  [6] out
inline void place_over_rail(const RailsUnder& rails, int side, const double* u,
                            double* over) noexcept {
  for (int k = 0; k < 6; ++k) over[k] = u[k];
  over[index_of(BodyMotion::y)] -= rails.y[side];
  over[index_of(BodyMotion::z)] -= rails.z[side];
}

/// Force of the rail on a wheel.
struct WheelForce {
  double depth;           // penetration, m; forces are 0 unless it is above 0
  double normal;          // N
  double on_section;      // moment on the rail's section, N m
  double generalised[6];  // over the wheelset's motions, N and N m; the first three are x, y, z
  double creep_power;     // W; of linear creep that keeps nothing not above 0
  bool slides;            // ContactCreep::slides()
  double creepage[3];     // State::creepage, if Rolling::keeps
  /// Place of the contact over the point about which the rail's section rolls, along y, m; the mean
  /// of patches by their normal forces.
  double rail_y = 0.;
};

/// Derivatives of the normal force and of the creep forces along and across, over kPlaced, over the
/// rates of the motions, and over the roll of the rail's section and its rate.
struct ContactSlopes {
  double by_motion[3][4], by_rate[3][6], by_section[3], by_section_rate[3];
  double spread[6][3];  // forces on the motions by a unit of each of the three
  double section[3];    // moment on the rail's section by the same
};

/// Fills all slopes but those over motions and the roll of the section.
void fill_rates_and_spread(const WheelRows<double>& r, const ContactCreep& creep,
                           ContactSlopes& slopes) noexcept;

/// The creepages that a state keeps of a contact that rolls slowly. Once creep has saturated they
/// do not grow further: otherwise the spring would have to be unloaded by as much. Spin counts as
/// if the wheel rolled ahead: the force across by it does not depend on the direction.
/// @param slip  with_creep_before()
inline void keep_creepage(const Rolling& rolling, const Slip<double>& slip,
                          const ContactCreep& creep, double* creepage) noexcept {
  const double part = creep.slides() ? ContactCreep::kSlides / creep.size : 1.,
               per = part * per_rolling(rolling.over);
  creepage[0] = per * slip.along;
  creepage[1] = per * slip.across;
  creepage[2] = (rolling.over < 0. ? -per : per) * slip.spin;
}

/// The force at a contact in touch whose creep is known.
inline WheelForce wheel_force(const WheelRows<double>& r, double normal, const Slip<double>& slip,
                              const Rolling& rolling, const ContactCreep& creep) noexcept {
  const double* const f = creep.force;
  const double on_section = f[1] * r.across_section - normal * r.normal_section;
  WheelForce force{r.depth, normal, on_section, {}, 0., creep.slides(), {}};
  if (rolling.keeps)
    keep_creepage(rolling, with_creep_before(slip, rolling), creep, force.creepage);
  force.rail_y = r.n_z * r.normal_section + r.n_y * r.across_section;
  force.creep_power = f[0] * slip.along + f[1] * slip.across + f[2] * slip.spin;
  generalise(r, ContactForces<double>{normal, f[0], f[1], f[2]}, force.generalised);
  return force;
}

/// @param side  1 of the left wheel, -1 of the right
/// @param u, v  [6] motions of the wheelset over the rail, and their rates
/// @param rail  rates of the rail
inline WheelForce wheel_force(const RollingContact& c, double radius, double side,
                              const Rolling& rolling, const double* u, const double* v,
                              const RailRate& rail) noexcept {
  const WheelRows<double> r = wheel_rows(c, radius, side, u[1], u[2], u[3], u[5]);
  if (!(r.depth > 0.)) return {r.depth, 0., 0., {}, 0., false, {}};
  const Slip<double> slip = slip_of(r, v, rolling.frame, radius, rail);
  const double normal = normal_force(c, r.depth);
  return wheel_force(r, normal, slip, rolling,
                     creep_on_rail(c.creep, c.creep.patch, side, {r.depth, normal}, slip, rolling,
                                   CreepWanted::force));
}

/// The same with derivatives.
WheelForce wheel_force(const RollingContact& c, double radius, double side, const Rolling& rolling,
                       const double* u, const double* v, const RailRate& rail,
                       ContactSlopes& slopes) noexcept;

}  // namespace railstep
