#pragma once
#include <array>
#include <string>
#include <vector>

#include "online/model/runner_model.h"

namespace railstep {

/// A rigid body of a rail vehicle.
struct RunnerBody {
  std::string name;
  double mass;                    // kg
  std::array<double, 3> inertia;  // about x, y and z through its centre, kg m2
  std::array<double, 3> centre;   // at rest: x from the vehicle's origin, y, z over top of rail, m
  double radius = 0.;             // of a wheelset's wheels, m; 0: it has none
  [[nodiscard]] bool is_wheelset() const { return radius > 0.; }
};

/// The frame that goes along the track with the vehicle, in place of a body.
inline constexpr int kGround = -1;

/// A linear element of a suspension between two bodies. Deflections count from the loaded vehicle
/// at rest on straight, level track.
///
/// `mid_frame`: springs along and about three axes halfway between those of both bodies. They act
/// halfway between the points at which both bodies meet, which coincide at rest. So the stiffness
/// is symmetric and momentum is kept, with preloads too.
/// `line`: a spring along the line between a point of each body; only entry 0 counts.
/// `rod`: a rigid rod along that line, without stiffness or damping. It carries what it has to.
struct RunnerElement {
  enum class Kind { mid_frame, line, rod };
  std::string name;
  Kind kind;
  int a, b;                                // bodies; one of them may be kGround
  std::array<double, 3> point_a, point_b;  // at rest, as RunnerBody::centre
  std::array<double, 6> stiffness{};       // N/m, N/m, N/m, N m/rad, N m/rad, N m/rad
  std::array<double, 6> damping{};         // N s/m and N m s/rad
  std::array<double, 6> series{};          // of a spring in series with the damper; 0: it is rigid
  std::array<double, 6> preload{};  // force on `a` at rest, N and N m; of a line or rod its tension
};

/// A bump stop between two bodies: a spring along an axis of the track that presses once body `a`
/// has moved against `b` by more than a gap. Or the brake of wheelset `a`, whose moment acts
/// against `b`, with a limit by a table or an input.
struct RunnerStop {
  std::string name;
  int a, b;                        // bodies; one of them may be kGround
  std::array<double, 3> point;     // at rest, as RunnerBody::centre
  int axis;                        // 0 x, 1 y, 2 z; of a brake BodyMotion::pitch
  StopModel law;                   // its limit has no table
  std::vector<double> limit = {};  // of a brake: t (s), N m, t, N m, ...
};

/// A rail vehicle: rigid bodies in space on a suspension, with wheels on both rails.
struct Runner {
  std::vector<RunnerBody> bodies;
  std::vector<RunnerElement> elements;
  std::vector<RunnerStop> stops = {};
};

}  // namespace railstep
