#include "run/speed_note.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "offline/analysis/critical_speed.h"

namespace railstep {
namespace {

constexpr double kNear = .8;  // of critical speed: deflections are 1.7 times the static ones

double fastest_of(const Scene& scene) {
  double most = fastest_wheel(scene);
  for (const LoadScene& load : scene.loads) most = std::max(most, std::abs(fastest(load)));
  return most;
}

}  // namespace

std::optional<Message> speed_note(const Scene& scene, const Track& track) {
  const double speed = fastest_of(scene);
  double slowest = HUGE_VAL;
  for (int rail = 0; rail < track.rails; ++rail)
    slowest = std::min(slowest, critical_speed(track, rail).value_or(HUGE_VAL));
  if (speed < kNear * slowest) return std::nullopt;
  return Message(
      "W-RUN-03",
      fmt::format("traffic at {:.4g} m/s runs at {:.3g} of the track's critical speed of {:.4g} "
                  "m/s: deflections depend on the dampers and on how far it has run",
                  speed, speed / slowest, slowest));
}

}  // namespace railstep
