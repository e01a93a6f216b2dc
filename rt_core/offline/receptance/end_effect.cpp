#include "offline/receptance/end_effect.h"

#include <algorithm>
#include <cmath>

#include "offline/receptance/full_order.h"
#include "offline/track/end_zone.h"

namespace railstep {

namespace {

constexpr int kLonger = 4;

Transfer moved(Transfer transfer, double x, int seats) {
  const auto move = [&](Functional& functional) {
    for (Functional::OnRail& point : functional.rail) point.at.x += x;
    for (Functional::OnSleeper& end : functional.sleeper) end.seat += seats;
  };
  move(transfer.force);
  for (Functional& read : transfer.reads) move(read);
  return transfer;
}

std::vector<std::complex<double>> curve(const Track& track, const Transfer& transfer,
                                        const std::vector<double>& hz) {
  FullOrderReceptance receptance(track, transfer);
  std::vector<std::complex<double>> values;
  values.reserve(hz.size());
  for (const double f : hz) values.push_back(receptance.at(f)[0]);
  return values;
}

}  // namespace

Track with_other_ends(const Track& track) {
  Track other = track;
  for (RailEnd& end : other.ends)
    if (end != RailEnd::non_reflecting)
      end = end == RailEnd::pinned ? RailEnd::free : RailEnd::pinned;
  return other;
}

LongerTrack with_longer_zones(const Track& track, const Transfer& transfer) {
  Track longer = track;
  longer.state.reset();
  const int added = (kLonger - 1) * track.end_zone_bays;
  const int before = track.ends[0] == RailEnd::non_reflecting ? added : 0;
  longer.bays += end_zones(track) * added;
  longer.end_zone_bays *= kLonger;
  longer.changed_seats.clear();
  for (int border = 0; border <= longer.bays; ++border) {
    const auto changed = track.changed_seats.find(std::clamp(border - before, 0, track.bays));
    if (changed != track.changed_seats.end()) longer.changed_seats[border] = changed->second;
  }
  for (RailJoint& joint : longer.joints) joint.x += before * track.bay_length;
  return {longer, moved(transfer, before * track.bay_length, before)};
}

std::vector<double> end_effect(const Track& track, const Transfer& transfer,
                               const std::vector<double>& hz,
                               const std::vector<std::complex<double>>& answer) {
  const LongerTrack other = with_longer_zones(with_other_ends(track), transfer);
  const std::vector<std::complex<double>> there = curve(other.track, other.transfer, hz);
  std::vector<std::complex<double>> here = answer;
  if (track.state) {
    Track straight = track;
    straight.state.reset();
    here = curve(straight, transfer, hz);
  }
  std::vector<double> change;
  for (std::size_t i = 0; i < hz.size(); ++i) {
    const double size = std::abs(here[i]);  // 0 between motions that nothing couples
    change.push_back(size > 0. ? std::abs(there[i] - here[i]) / size : 0.);
  }
  return change;
}

}  // namespace railstep
