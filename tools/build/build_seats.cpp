#include "build/build.h"
#include "offline/irregularity/random.h"

namespace railstep {
namespace {

void take_away(Missing what, std::size_t side, Seat& seat) {
  Support& pad = seat.pad[side];
  if (what == Missing::pad || what == Missing::sleeper) {
    pad.stiffness = pad.damping = {};
    pad.roll_stiffness = pad.roll_damping = 0.;
  }
  if (what == Missing::ballast || what == Missing::sleeper) {
    Ballast& ballast = seat.ballast[side];
    ballast.stiffness = ballast.damping = {};
  }
}

/// @param place  of the seat among the seats of the change, 0 to 1
void change_side(const SeatChange& change, int border, std::size_t side, double place, Seat& seat) {
  for (const SeatValue& value : change.values) {
    const double now = value.first + place * (value.last - value.first);
    double& number = value.of(seat, side);
    number = value.scales ? now * number : now;
  }
  seat.pad[side].unilateral = change.pad_unilateral.value_or(seat.pad[side].unilateral);
  seat.ballast[side].unilateral = change.ballast_unilateral.value_or(seat.ballast[side].unilateral);
  for (const SeatScatter& scatter : change.scatter) {
    const double factor = scatter_factor(change.seed, scatter.stream, border, side, scatter.width);
    for (const auto of : scatter.of) of(seat, side) *= factor;
  }
  take_away(change.missing, side, seat);
}

}  // namespace

double scatter_factor(std::uint64_t seed, std::uint64_t stream, int seat, std::size_t side,
                      double width) {
  const double even = uniform(seed, 4 * stream + side, static_cast<std::uint64_t>(seat));
  return 1. + width * (2. * even - 1.);
}

void change_seats(const std::vector<SeatChange>& changes, Track& track) {
  for (const SeatChange& change : changes)
    for (std::size_t i = 0; i < change.seats.size(); ++i) {
      const int border = change.seats[i];
      const double place =
          change.seats.size() < 2
              ? 0.
              : static_cast<double>(i) / static_cast<double>(change.seats.size() - 1);
      Seat seat = track.seat(border);
      for (const std::size_t side : {0u, 1u})
        if (change.sides[side]) change_side(change, border, side, place, seat);
      track.changed_seats[border] = seat;
    }
  // Sleepers are removed last, as the loop above may still change them.
  for (const SeatChange& change : changes)
    if (change.missing == Missing::sleeper)
      for (const int border : change.seats) track.changed_seats[border].sleeper.reset();
  for (auto& [border, seat] : track.changed_seats) seat = with_pads_joined(seat);
  if (track.sleeper) track.sleeper = with_pads_joined(*track.sleeper);
}

}  // namespace railstep
