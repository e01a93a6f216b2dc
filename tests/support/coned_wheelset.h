#pragma once
#include <cmath>

namespace railstep {

/// A wheelset of two cones on circular crowns, as a body in the plane across the rails. In its own
/// frame the treads are a V, whose legs touch the two circles. As the angle of a V on two points is
/// that of a circle's arc, its tip runs along a circle, and its axis passes through a point of it.
struct ConedWheelset {
  double radius, slope;              // m, tangent of the cones' angle
  double half_distance, crown = .3;  // of the contacts in the middle; the crowns' radius, m

  [[nodiscard]] double angle() const { return std::atan(slope); }
  /// Half the distance of the crowns' centres, m.
  [[nodiscard]] double half_chord() const { return half_distance + crown * std::sin(angle()); }
  /// Diameter of the circle of the V's tip, m.
  [[nodiscard]] double diameter() const { return 2. * half_chord() / std::sin(2. * angle()); }
  /// Roll per lateral displacement, 1/m.
  [[nodiscard]] double roll() const {
    return 1. / (diameter() - (radius + half_distance * slope + crown / std::cos(angle())));
  }
  /// Change of each rolling radius per lateral displacement.
  [[nodiscard]] double conicity() const { return half_chord() * roll(); }
  /// Second derivative of the height of the axle's middle by its lateral displacement, 1/m.
  [[nodiscard]] double height_bend() const { return (diameter() + 1. / roll()) * roll() * roll(); }
  /// Motion of the contacts across their plane, per lateral displacement and per v yaw.
  [[nodiscard]] double across() const {
    return std::cos(angle()) * (1. + radius * roll()) + half_distance * roll() * std::sin(angle());
  }
  [[nodiscard]] double across_by_yaw() const { return 1. / std::cos(angle()); }
};

/// The wheelset of a radius whose cones have a conicity.
inline ConedWheelset coned(double radius, double conicity, double half_distance) {
  ConedWheelset found{radius, 0., half_distance};
  double low = 0., high = .3;
  for (int i = 0; i < 60; ++i) {
    found.slope = .5 * (low + high);
    (found.conicity() > conicity ? high : low) = found.slope;
  }
  return found;
}

}  // namespace railstep
