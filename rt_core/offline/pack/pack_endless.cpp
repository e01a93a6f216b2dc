#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "offline/analysis/decay_length.h"
#include "offline/analysis/statics.h"
#include "offline/math/refuse.h"
#include "offline/pack/pack.h"
#include "offline/pack/pack_progress.h"

namespace railstep {

namespace {

/// The one speed of all traffic, m/s. Rail vehicles on rigid rails have speeds of their own.
double speed_of(const Traffic& traffic, bool rigid) {
  std::vector<double> speeds;
  const auto add = [&](double speed, const std::vector<double>& table) {
    if (!table.empty())
      refuse("E-PACK-30",
             "traffic on a track without end has a table of speeds; expected one constant speed "
             "for all traffic");
    speeds.push_back(speed);
  };
  for (const MovingLoad& load : traffic.loads) add(load.speed, load.speeds);
  for (const Wheelset& set : traffic.wheelsets) add(set.speed, set.speeds);
  for (const RunningVehicle& vehicle : traffic.vehicles) add(vehicle.speed, vehicle.speeds);
  for (const RailVehicle& vehicle : traffic.rail_vehicles)
    if (!rigid) add(vehicle.speed, vehicle.speeds);
  for (const double speed : speeds)
    if (speed != speeds[0])
      refuse("E-PACK-31", "traffic on a track without end has the speeds " +
                              std::to_string(speeds[0]) + " and " + std::to_string(speed) +
                              " m/s; expected one speed for all traffic");
  return speeds.empty() ? 0. : speeds[0];
}

/// Places of the traffic, m, x = 0 included.
std::vector<double> places_of(const Traffic& traffic) {
  std::vector<double> places{0.};
  for (const MovingLoad& load : traffic.loads) places.push_back(load.start);
  for (const Wheelset& set : traffic.wheelsets) places.push_back(set.start);
  for (const RunningVehicle& own : traffic.vehicles)
    for (const Vehicle::Wheel& wheel : own.vehicle.wheels)
      places.push_back(own.start + wheel.place);
  for (const RailVehicle& own : traffic.rail_vehicles)
    for (const RunnerBody& body : own.runner.bodies)
      if (body.is_wheelset()) places.push_back(own.start + body.centre[0]);
  return places;
}

std::string too_short(const Track& track, double span, double decay) {
  std::ostringstream text;
  text << (track.ring ? "the ring" : "the window") << " of a track without end is "
       << track.length() << " m long; expected at least " << span << " m of traffic and "
       << (track.ring ? "" : "on either side of it ") << "a decay length of " << decay
       << " m: more track.bays";
  return text.str();
}

}  // namespace

void PackedModel::add_endless(const Track& track, const Traffic& traffic,
                              const PackOptions& options) {
  if (track.ring != options.reduction.has_value())
    refuse("E-PACK-32",
           "a track without end has the wrong form; expected a ring if it is condensed, and a "
           "window if it is in full order");
  const double bay = track.bay_length;
  const std::vector<double> places = places_of(traffic);
  const auto [lowest, highest] = std::minmax_element(places.begin(), places.end());
  const double first = *lowest, last = *highest;
  Endless& e = model_.endless;
  e = {track.bays, track.elements_per_bay, bay, options.endless->behind * bay,
       bay_progress(speed_of(traffic, track.rigid) * options.scheme.dt / bay)};
  // The traffic moves by up to a bay before the track is shifted. The ends of a window must stay at
  // rest; on a ring waves of the traffic must not reach it again.
  const double decay = decay_length(track), behind = e.origin + first,
               before = track.length() - (e.origin + last + bay);
  const bool room = track.ring ? behind + before >= decay && behind >= bay && before >= bay
                               : behind >= decay && before >= decay;
  if (!room)
    refuse(track.ring ? MessageId("E-PACK-33") : MessageId("E-PACK-51"),
           too_short(track, (last - first + bay), decay));
  if (!track.ring || !traffic.external_wheels.empty() || !traffic.held.empty()) return;
  // A ring's shapes and tables are read only near the traffic: from a bay behind it to a bay ahead
  // of where it moves to, and at the seats around a wheelset.
  const auto border = [&](double x) { return static_cast<int>(std::floor((e.origin + x) / bay)); };
  const bool rolls = track.unknowns != Unknowns::vertical &&
                     !(traffic.wheelsets.empty() && traffic.rail_vehicles.empty());
  const int spare = 1 + (rolls ? kPDeltaSeats / 2 : 0);
  const auto around = [&](double from, double to) {
    return Elements{std::max(border(from) - spare, 0) * track.elements_per_bay,
                    std::min(border(to) + 2 + spare, track.bays) * track.elements_per_bay};
  };
  met_ = around(first, last);
  is_met_.assign(is_met_.size(), false);
  for (const double x : places) {
    const Elements own = around(x, x);
    std::fill(is_met_.begin() + own.first, is_met_.begin() + own.last, true);
  }
  // The search for a wheelset's contact reads the whole motion of the rails' nodes.
  moves_along_ = !traffic.wheelsets.empty();
}

Track window_of(Track track) {
  track.ring = false;
  track.ends = {RailEnd::free, RailEnd::clamped};
  return track;
}

BayShift PackedModel::ring_shift(const RingModes& ring, int padded) {
  const auto n = static_cast<std::size_t>(padded);
  std::vector<std::int32_t> from(n, 0);
  std::vector<double> own(n, 0.), other(n, 0.);
  for (std::size_t k = 0; k < ring.partner.size(); ++k) {
    from[k] = ring.partner[k];
    own[k] = ring.cosine[static_cast<Eigen::Index>(k)];
    other[k] = ring.sine[static_cast<Eigen::Index>(k)];
  }
  return {keep(std::move(from)), keep(std::move(own)), keep(std::move(other)),
          keep(std::vector<double>(n, 0.))};
}

namespace {

/// For each unknown of a line the same one a bay ahead; itself in the last bay.
std::vector<std::int32_t> next_bay(const Track& track, const Line& line, std::size_t padded) {
  std::vector<std::int32_t> from(padded);
  for (std::size_t i = 0; i < padded; ++i) from[i] = static_cast<std::int32_t>(i);
  const auto link = [&](int here, int ahead) {
    if (here >= 0 && ahead >= 0) from[static_cast<std::size_t>(here)] = ahead;
  };
  const int per_bay = 2 * track.elements_per_bay;
  for (const int rail : {0, 1})
    for (int node = 0; node + per_bay < track.nodes(); ++node)
      for (int k = 0; k < 9; ++k)
        link(line.unknown(rail, node, k), line.unknown(rail, node + per_bay, k));
  for (std::size_t seat = 0; seat + 1 < line.sleeper_unknown_of.size(); ++seat)
    for (std::size_t motion = 0; motion < kSleeperMotions; ++motion)
      link(line.sleeper_unknown_of[seat][motion], line.sleeper_unknown_of[seat + 1][motion]);
  return from;
}

/// Displacements of a line at rest under its weight; padded.
Eigen::VectorXd rest_of(const Track& track, const Line& line, std::size_t padded, double gravity) {
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(padded));
  if (gravity == 0.) return rest;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(line.stiffness);
  rest.head(line.unknowns()) = factor.solve(weight(track, line, gravity));
  return rest;
}

}  // namespace

/// Displacements from rest under the weight are shifted; the bay that enters in front is at rest.
BayShift PackedModel::window_shift(const Track& track, const Line& line, int padded,
                                   double gravity) {
  const auto n = static_cast<std::size_t>(padded);
  std::vector<std::int32_t> from = next_bay(track, line, n);
  const Eigen::VectorXd rest = rest_of(track, line, n, gravity);
  std::vector<double> other(n, 0.), fill(n, 0.);
  for (std::size_t i = 0; i < n; ++i) {
    const bool moves = from[i] != static_cast<std::int32_t>(i);
    other[i] = moves ? 1. : 0.;
    fill[i] = rest[static_cast<Eigen::Index>(i)] - (moves ? rest[from[i]] : 0.);
  }
  return {keep(std::move(from)), keep(std::vector<double>(n, 0.)), keep(std::move(other)),
          keep(std::move(fill))};
}

}  // namespace railstep
