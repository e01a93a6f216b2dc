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
inline Seat seat_of(const Support& pad, const std::optional<Sleeper>& sleeper) {
  Seat seat;
  seat.pad = {pad, pad};
  if (!sleeper) return seat;
  const std::array<double, 3>& k = sleeper->ballast_stiffness;
  seat.sleeper =
      SleeperBody{sleeper->mass,
                  sleeper->roll_inertia,
                  sleeper->pitch_inertia,
                  {k[0] > 0., k[1] > 0., pad.length > 0. && sleeper->ballast_length > 0.}};
  const Ballast ballast{k,
                        sleeper->ballast_damping,
                        sleeper->ballast_length,
                        sleeper->ballast_unilateral,
                        sleeper->ballast_gap,
                        sleeper->relaxing};
  seat.ballast = {ballast, ballast};
  seat.under_pad = {sleeper->under_pad, sleeper->under_pad};
  return seat;
}

/// Spring k, damper c of ballast under a pad K, C become those of the bed that both are in series:
///   (K + s C)(k + s c)/(K + k + s (C + c)) = k0 + s c0 - (s r)^2/(a + s r),
///   k0 = K k/(K + k), c0 = (C k^2 + c K^2)/(K + k)^2,
///   r = (K c - k C)^2/((C + c)(K + k)^2), a = r (K + k)/(C + c):
/// a spring, and a damper of which the part r acts through a spring a. One-sided ballast keeps no
/// such spring, which changes its stiffness by at most r/c0 min(1, omega r/a).
inline void join_pad(const UnderSleeperPad& pad, bool one_sided, double& k, double& c,
                     Relaxing& relaxing) {
  constexpr double kNothing = 1e-9;  // of c0: less relaxes nowhere
  if (pad.stiffness == 0.) return;
  const double sum = pad.stiffness + k, dampers = pad.damping + c, on_pad = pad.stiffness / sum,
               on_ballast = k / sum, uneven = on_pad * c - on_ballast * pad.damping;
  k = pad.stiffness * on_ballast;
  c = pad.damping * on_ballast * on_ballast + c * on_pad * on_pad;
  const double part = dampers > 0. ? uneven * uneven / dampers : 0.;
  if (!one_sided && part > kNothing * c) relaxing = {part * sum / dampers, part};
}

inline Seat with_pads_joined(Seat seat) {
  for (const std::size_t side : {0u, 1u}) {
    Ballast& own = seat.ballast[side];
    join_pad(seat.under_pad[side], own.one_sided(), own.stiffness[2], own.damping[2], own.relaxing);
  }
  seat.under_pad = {};
  return seat;
}

inline Sleeper with_pads_joined(Sleeper own) {
  join_pad(own.under_pad, own.ballast_unilateral || own.ballast_gap > 0., own.ballast_stiffness[2],
           own.ballast_damping[2], own.relaxing);
  own.under_pad = {};
  return own;
}

}  // namespace railstep
