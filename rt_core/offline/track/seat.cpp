#include "offline/track/seat.h"

namespace railstep {

Seat seat_of(const Support& pad, const std::optional<Sleeper>& sleeper) {
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

namespace {

/// Spring k, damper c of ballast under a pad K, C become those of the bed that both are in series:
///   (K + s C)(k + s c)/(K + k + s (C + c)) = k0 + s c0 - (s r)^2/(a + s r),
///   k0 = K k/(K + k), c0 = (C k^2 + c K^2)/(K + k)^2,
///   r = (K c - k C)^2/((C + c)(K + k)^2), a = r (K + k)/(C + c):
/// a spring, and a damper of which the part r acts through a spring a. One-sided ballast keeps no
/// such spring, which changes its stiffness by at most r/c0 min(1, omega r/a).
void join_pad(const UnderSleeperPad& pad, bool one_sided, double& k, double& c,
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

}  // namespace

Seat with_pads_joined(Seat seat) {
  for (const std::size_t side : {0u, 1u}) {
    Ballast& own = seat.ballast[side];
    join_pad(seat.under_pad[side], own.one_sided(), own.stiffness[2], own.damping[2], own.relaxing);
  }
  seat.under_pad = {};
  return seat;
}

Sleeper with_pads_joined(Sleeper own) {
  join_pad(own.under_pad, own.ballast_unilateral || own.ballast_gap > 0., own.ballast_stiffness[2],
           own.ballast_damping[2], own.relaxing);
  own.under_pad = {};
  return own;
}

}  // namespace railstep
