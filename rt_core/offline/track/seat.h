#pragma once
#include <array>
#include <optional>

namespace railstep {

/// Spring-dampers between one rail and its sleeper or the ground, at a bay border.
struct Support {
  std::array<double, 3> stiffness{};  // x, y, z, N/m
  std::array<double, 3> damping{};    // x, y, z, N s/m
  double roll_stiffness = 0.;         // N m/rad
  double roll_damping = 0.;           // N m s/rad
  double height_z = 0.;               // of the seat above the axis, m
  double half_spread = 0.;            // a pair of half springs at y = +- this, m
  double length = 0.;                 // along x, m: evenly spread over it, what is off the rail's
                                      // end moved under it; 0: a point
  bool unilateral = false;            // along z it presses and does not pull; a point then
  double gap = 0.;                    // m, by which it is short along z; above 0: unilateral

  bool one_sided() const { return unilateral || gap > 0.; }
  bool operator==(const Support&) const = default;
};

/// Elastic layer glued under one end of a sleeper, along z in series with its ballast. A scene
/// gives it; with_pads_joined() makes one bed of both, which is all that the track knows.
struct UnderSleeperPad {
  double stiffness = 0.;  // N/m; 0 without a pad
  double damping = 0.;    // N s/m

  bool operator==(const UnderSleeperPad&) const = default;
};

/// A spring that stands in series with part of a damper, so that this part's force relaxes.
struct Relaxing {
  double stiffness = 0.;  // N/m
  double damping = 0.;    // of that part, N s/m; 0 without such a part

  bool operator==(const Relaxing&) const = default;
};

/// Rigid sleeper under both rails on ballast, alike at both ends; its height is neglected. It moves
/// vertically and rolls; along x or y it moves only where its ballast has stiffness in that
/// direction, and pitches only where its ballast and pads have lengths (otherwise it is held
/// there).
struct Sleeper {
  double mass = 0.;                           // whole, kg
  double roll_inertia = 0.;                   // about x, also used about z, kg m2
  std::array<double, 3> ballast_stiffness{};  // x, y, z per end, N/m
  std::array<double, 3> ballast_damping{};    // x, y, z per end, N s/m
  double pitch_inertia = 0.;                  // about y, kg m2
  double ballast_length = 0.;                 // along x, m: evenly spread over it
  bool ballast_unilateral = false;            // as Ballast
  double ballast_gap = 0.;                    // m
  UnderSleeperPad under_pad{};                // under each end
  Relaxing relaxing{};                        // as Ballast
};

/// Spring-dampers between one end of a sleeper, under its rail, and the ground.
struct Ballast {
  std::array<double, 3> stiffness{};  // x, y, z, N/m
  std::array<double, 3> damping{};    // x, y, z, N s/m
  double length = 0.;                 // along x, m: evenly spread over it; 0: a point
  bool unilateral = false;            // along z it presses and does not pull; a point then
  double gap = 0.;                    // m, between it and the sleeper; above 0: unilateral
  Relaxing relaxing{};                // along z: a part of damping[2], none of one-sided ballast

  bool one_sided() const { return unilateral || gap > 0.; }
  bool operator==(const Ballast&) const = default;
};

/// A sleeper without its ballast.
struct SleeperBody {
  double mass = 0.;             // whole, kg
  double roll_inertia = 0.;     // about x, also used about z, kg m2
  double pitch_inertia = 0.;    // about y, kg m2
  std::array<bool, 3> moves{};  // along x (and about z), along y, about y; false: held

  bool operator==(const SleeperBody&) const = default;
};

/// Support of the rails at one bay border: pads on a sleeper, or on the ground.
struct Seat {
  std::array<Support, 2> pad{};        // under the left and the right rail
  std::optional<SleeperBody> sleeper;  // empty: the pads stand on the ground
  std::array<Ballast, 2> ballast{};    // under the sleeper's left and right end
  std::array<UnderSleeperPad, 2> under_pad{};

  bool operator==(const Seat&) const = default;
  /// Whether left and right are alike.
  bool symmetric() const { return pad[0] == pad[1] && ballast[0] == ballast[1]; }
};

/// A seat whose two sides are alike.
Seat seat_of(const Support& pad, const std::optional<Sleeper>& sleeper);

/// The same with pads under the sleeper and its ballast as one bed, in series: a spring, and a
/// damper of which a part acts through a spring of its own. One-sided ballast keeps no such spring.
Seat with_pads_joined(Seat seat);
Sleeper with_pads_joined(Sleeper sleeper);

}  // namespace railstep
