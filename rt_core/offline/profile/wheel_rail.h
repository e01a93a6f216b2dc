#pragma once
#include <optional>
#include <vector>

#include "offline/profile/running_surface.h"

namespace railstep {

/// A wheelset with two wheels of one profile on two rails of one profile.
struct WheelRail {
  RunningSurface wheel;  // growth of the radius over s, m: s from the tread datum outwards
  RunningSurface rail;   // right rail, y from the middle of the track outwards
  double half_distance;  // m, of the tread datums
  double radius;         // m, at the tread datum
};

/// Where one wheel touches.
struct WheelTouch {
  double on_wheel;  // s, m
  double on_rail;   // y outwards from the middle of the track, m
  double growth;    // of the rolling radius, m
  double angle;  // of the contact plane to the axle, rad, positive where the radius falls outwards
};

/// One wheel over its rail, both seen as the right ones.
class WheelOverRail {
 public:
  /// @param outwards  the wheelset's shift towards this wheel, m
  /// @param roll      rad, positive where it lifts this wheel
  WheelOverRail(const WheelRail& pair, double outwards, double roll);
  /// Height of the wheel's surface at s above the rail, the axle's middle at height 0, m; 1 m
  /// beside the rail.
  [[nodiscard]] double distance(double s) const;
  [[nodiscard]] WheelTouch touch_at(double s) const;
  /// The place on the wheel of least distance, m, and whether a profile ends there. Throws Refused
  /// where the wheel is beside its rail.
  struct Nearest {
    double s;
    bool at_edge;
  };
  [[nodiscard]] Nearest nearest() const;
  /// Distances at places from the first to the last of the wheel, 0.1 mm apart.
  struct Samples {
    double first, step;
    std::vector<double> distance;
    [[nodiscard]] double place(std::size_t i) const {
      return first + step * static_cast<double>(i);
    }
  };
  [[nodiscard]] Samples samples() const;

 private:
  [[nodiscard]] double place(double s, double growth) const;
  const WheelRail& pair_;
  double shift_, cosine_, sine_;
};

/// How a wheelset lies on its rails.
struct WheelsetTouch {
  double shift;   // m, to the right
  double roll;    // rad, positive with the right wheel up
  double height;  // m, of the axle's middle above the top of rail
  WheelTouch right, left;
  /// Difference of the rolling radii, right less left, m.
  [[nodiscard]] double radius_difference() const { return right.growth - left.growth; }
};

/// Rigid contact of a wheelset without yaw: each wheel touches at the least vertical distance.
/// @param with_roll  the wheelset rolls until both wheels touch; else it stays level, as EN 15302
///                   takes it, and each wheel touches where it would touch first
/// Throws Refused where a wheel is not above its rail or touches at the edge of a profile, and
/// where no roll of up to 0.03 rad brings both onto their rails.
WheelsetTouch touch(const WheelRail& pair, double shift, bool with_roll);

/// touch() at shifts from -range to range.
std::vector<WheelsetTouch> touches(const WheelRail& pair, double range, double spacing,
                                   bool with_roll);

/// A shift at which the contact of the right wheel jumps.
struct ContactJump {
  double shift;     // m, to 1 um
  double from, to;  // on the wheel, m
};
/// Jumps of the right contact by over 0.5 mm between neighbours of `rows`.
std::vector<ContactJump> jumps_of(const WheelRail& pair, const std::vector<WheelsetTouch>& rows,
                                  bool with_roll);

/// A radius difference over shifts, straight between points.
struct RadiusDifference {
  std::vector<double> shift, difference;  // m, of one length; shifts rise
};

/// Equivalent conicity, EN 15302: the cone on which a wheelset without mass has the wavelength that
/// it has on these profiles, y'' = -difference/(e r). Over the energy of the motion,
///   wavelength = 2 int dy / sqrt(2/(e r) (V(end) - V(y))),  V = int difference dy.
/// @param amplitude  m, half of the way between the turning points
/// @param distance   e of the contacts, m
/// @returns nothing where the wheelset has no such motion within the shifts
std::optional<double> equivalent_conicity(const RadiusDifference& of, double amplitude,
                                          double distance, double radius);

}  // namespace railstep
