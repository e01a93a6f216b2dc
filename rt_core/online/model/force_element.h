#pragma once
#include "online/math/search.h"
#include "online/model/suspended_model.h"

namespace railstep {

// Elements of a suspension whose force is not linear in one displacement.

/// A curve that does not fall, straight between its points and beyond the first and the last one.
struct RisingCurve {
  std::int32_t points;  // 0: no curve
  double slope_before;  // ahead of the first point
  const double* point;  // [points][3] place, value, and slope up to the next point
};
inline constexpr int kMostCurvePoints = 64;
struct CurveValue {
  double value, slope;
};
inline CurveValue curve_at(const RisingCurve& curve, double x) noexcept {
  const double* const at =
      curve.point + std::ptrdiff_t{3} * row_at(curve.point, 3, curve.points, x);
  const double slope = x < at[0] ? curve.slope_before : at[2];
  return {at[1] + slope * (x - at[0]), slope};
}

/// How the force of an element depends on its displacement.
enum class ElementLaw : std::int32_t {
  spring,       // a curve over the displacement
  damper,       // a curve over its rate
  actuator,     // a force by a table over time or an input
  controlled,   // a damper whose damping is that of a table over time or an input
  slider,       // Coulomb friction behind a spring: it holds up to its limit, then slides
  exponential,  // friction whose force nears its limit exponentially along the way (Dahl, Fancher)
  berg,         // friction whose force is a hyperbola from where the motion last turned (Berg)
};
inline constexpr int kElementLaws = 7;
inline constexpr bool is_friction(ElementLaw law) noexcept { return law >= ElementLaw::slider; }
/// Whether a law has a curve; the others have a value over time.
inline constexpr bool has_curve(ElementLaw law) noexcept {
  return law == ElementLaw::spring || law == ElementLaw::damper;
}
/// How many numbers a state keeps of an element: the displacement from which that of a step counts,
/// then of `exponential` its force; of `berg` the force where the motion last turned, the way since
/// then, and its force.
inline constexpr int memory_of(ElementLaw law) noexcept {
  return !is_friction(law)                ? 0
         : law == ElementLaw::slider      ? 1
         : law == ElementLaw::exponential ? 2
                                          : 4;
}
inline constexpr int kMostElementMemory = 4;

/// An element of one displacement between two bodies. Its force on the first one acts against the
/// displacement. The limit of a friction is a force, or, under a load, a coefficient: the load
/// follows from another displacement and is never below 0.
struct ForceElement {
  ElementLaw law;
  std::int32_t
      coordinate;       // its displacement among those of the runner's elements, before its load
  std::int32_t memory;  // the first of its numbers in State::element_memory
  RisingCurve curve;    // of springs N over m, of dampers N over m/s
  double stiffness;     // of friction that has not slid, N/m or N m/rad
  double damping;       // of a slider beside its spring, N s/m or N m s/rad
  double per_way;       // of a brake 1/radius of its wheels, 1/m; else 0
  /// The limit of friction, N or N m, or under a load its coefficient, or m; the force of an
  /// actuator along its displacement, N or N m; the damping of a controlled damper, N s/m or N m
  /// s/rad.
  BodyForce value;
  std::int32_t loaded;  // 0 or 1: whether it has a second displacement; 0 of `berg`
  /// The load of friction, N and N/m. A damper behind a spring has that spring's deflection as its
  /// second displacement: 0, and the stiffness of the spring.
  double load_at_rest, load_stiffness;
  double preload;  // N, the part of its force that is among the runner's `rest`
};
/// Brakes of wheelsets are sliders about the axle.
inline constexpr bool is_brake(const ForceElement& e) noexcept { return e.per_way > 0.; }

/// An element in a step.
struct ElementStep {
  const double* memory;       // memory_of() its law, in the state at the step's start
  double value;               // ForceElement::value
  double rate, rate_at_zero;  // the rate of a displacement z is rate z + rate_at_zero
};

}  // namespace railstep
