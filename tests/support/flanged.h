#pragma once
#include <array>
#include <cmath>

#include "support/condensed_tracks.h"
#include "support/rigid_track.h"

namespace railstep {

/// The paper's wheelset with flanges of 70 degrees and 7 mm that meet section F's head.
inline constexpr double kFaceAngle = 70. * M_PI / 180., kHalfHead = .5 * .07720505094;
inline const Railhead kFlangedHead{.1007375, .3, .038, kHalfHead};

inline Wheelset flanged_wheelset(double stiffness, double damping) {
  Wheelset w = paper_wheelset(3.2);
  w.flange =
      Flange{.clearance = 7e-3, .angle = kFaceAngle, .stiffness = stiffness, .damping = damping};
  return w;
}

/// The same wheelset in a plane on rigid rails, without the program: y, z of the centre over its
/// height on unloaded rails, and roll. Treads are circles that roll on circles, flanges straight
/// faces against a point. Fourth-order Runge-Kutta.
struct PlaneWheelset {
  double radius = .148, crown = .3, half_gauge = .5, mass = 100., inertia = 8.3;
  double weight = 981., push = 0.;                       // N
  double hertz = 0.;                                     // of treads, N/m^1.5
  double stiffness = 0., damping = 0., face_hertz = 0.;  // of flanges
  using State = std::array<double, 6>;                   // y, z, roll and their rates

  /// Depth, its rate, and direction of the force of the left (side 1) or right (-1) tread or
  /// flange.
  struct Contact {
    double depth, rate, y, z, moment;
  };
  Contact tread(const State& q, double side) const {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    const double ay = side * half_gauge - q[0], az = -(crown + radius) - q[1];  // crown's centre
    return contact(q, radius + crown + (s * -ay + c * az), -s, c, c * ay + s * az);
  }
  Contact flange(const State& q, double side) const {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    const double ny0 = -side * std::sin(kFaceAngle), nz0 = std::cos(kFaceAngle);
    const double ny = c * ny0 - s * nz0, nz = s * ny0 + c * nz0;
    const double low = -(radius + .014), gauge = side * (half_gauge - kHalfHead);
    const double py0 = gauge - side * 7e-3;
    const double py = c * py0 - s * low, pz = s * py0 + c * low;  // of the face
    const double ay = gauge - q[0], az = low - q[1];              // of the rail's point
    return contact(q, ny * (ay - py) + nz * (az - pz), ny, nz, ay * nz - az * ny);
  }
  State rate(const State& q) const {
    double y = push, z = -weight, moment = 0.;
    for (const double side : {1., -1.}) {
      const Contact on[2] = {tread(q, side), flange(q, side)};
      for (const int i : {0, 1}) {
        const double d = std::max(on[i].depth, 0.), root = d * std::sqrt(d);
        const double force = i == 0 ? hertz * root : flange_force(on[i]);
        y += force * on[i].y;
        z += force * on[i].z;
        moment += force * on[i].moment;
      }
    }
    return {q[3], q[4], q[5], y / mass, z / mass, moment / inertia};
  }
  State step(const State& q, double dt) const {
    const State a = rate(q), b = rate(on(q, a, dt / 2.)), c = rate(on(q, b, dt / 2.)),
                d = rate(on(q, c, dt));
    State next = q;
    for (std::size_t i = 0; i < 6; ++i) next[i] += dt / 6. * (a[i] + 2. * b[i] + 2. * c[i] + d[i]);
    return next;
  }
  double flange_force(const Contact& at) const {
    if (at.depth <= 0.) return 0.;
    if (face_hertz > 0.) return face_hertz * at.depth * std::sqrt(at.depth);
    return std::max(0., stiffness * at.depth + damping * at.rate);
  }

 private:
  static Contact contact(const State& q, double depth, double ny, double nz, double moment) {
    return {depth, -(ny * q[3] + nz * q[4] + moment * q[5]), ny, nz, moment};
  }
  static State on(State q, const State& rate, double dt) {
    for (std::size_t i = 0; i < 6; ++i) q[i] += dt * rate[i];
    return q;
  }
};

}  // namespace railstep
