#include "build/build_endless.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "build/build.h"
#include "offline/analysis/decay_length.h"

namespace railstep {

namespace {

/// Bays up to the foremost load or wheel of the traffic.
std::int64_t bays_taken(const Scene& scene) {
  double last = 0.;  // m; all starts are at 0 or ahead
  for (const LoadScene& load : scene.loads) last = std::max(last, load.start);
  for (const WheelsetScene& w : scene.wheelsets) last = std::max(last, w.start);
  for (const VehicleScene& v : scene.vehicles)
    for (const Vehicle::Wheel& wheel : v.vehicle.wheels)
      last = std::max(last, v.start + wheel.place);
  for (const RailVehicleScene& v : scene.rail_vehicles)
    for (const RunnerBody& body : v.runner.bodies)
      if (body.is_wheelset()) last = std::max(last, v.start + body.centre[0]);
  return static_cast<std::int64_t>(last / scene.track.bay) + 1;
}

}  // namespace

int bays_behind(const Scene& scene) {
  return static_cast<int>(std::max<std::int64_t>(0, scene.track.bays - bays_taken(scene)) / 2);
}

std::vector<std::string> longer_window(const Scene& scene) {
  if (!scene.track.endless) return {};
  const double decay = decay_length(track_of(scene)) / scene.track.bay;  // bays
  if (!(decay < 1e6)) return {};  // nothing holds the track, which is refused elsewhere
  // A decay length behind the traffic and before it, and a bay on either side that it shares.
  const std::int64_t wanted =
      bays_taken(scene) + 2 * (static_cast<std::int64_t>(std::ceil(decay)) + 1);
  if (wanted <= scene.track.bays) return {};
  return {fmt::format("track.bays={}", wanted)};
}

}  // namespace railstep
