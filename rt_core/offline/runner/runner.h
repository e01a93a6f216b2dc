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
  /// Its spring along z cannot pull, and presses once `clearance` is used up, m. A force element
  /// with its number has it in place of the linear stiffness.
  bool presses_only = false;
  double clearance = 0.;
  bool traced = false;  // its displacements and forces are published
};
/// The entries of an element that are published: those that have a force.
std::vector<int> traced_entries(const RunnerElement& element);

/// An element that is not linear in its one displacement, that of body `a` against body `b`: along
/// an axis of the track at a point, about it, or the elongation of the line between two points.
struct RunnerForceElement {
  enum class Along { axis, about_axis, line };
  std::string name;
  int a, b;  // bodies; one of them may be kGround
  Along along = Along::axis;
  std::array<double, 3> point_a{}, point_b{};  // at rest, as RunnerBody::centre; of an axis alike
  int axis = 0;                                // 0 x, 1 y, 2 z
  ElementLaw law = ElementLaw::spring;
  /// [n] place, value: m and N of a spring, m/s and N of a damper, rising; beyond its ends it goes
  /// on with `slope_before` and `slope_behind`.
  std::vector<double> curve = {};
  double slope_before = 0., slope_behind = 0.;
  double series = 0.;  // N/m, of a spring in series with a damper; 0: it is rigid
  double stiffness = 0., damping = 0., per_way = 0.;  // as of ForceElement
  /// t (s), value, t, value, ... of what ForceElement::value is; none: that of the input.
  std::vector<double> value = {};
  int input = -1;
  /// The linear element of the runner that presses the faces of friction together: the limit is
  /// then a coefficient. A spring without a curve: the element that presses only. -1: none.
  int pressed_by = -1;
  [[nodiscard]] bool is_brake() const { return per_way > 0.; }
};

/// A rail vehicle: rigid bodies in space on a suspension, with wheels on both rails.
struct Runner {
  std::vector<RunnerBody> bodies;
  std::vector<RunnerElement> elements;
  std::vector<RunnerForceElement> force_elements = {};
};

}  // namespace railstep
