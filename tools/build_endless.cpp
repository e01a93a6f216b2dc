#include "build_endless.h"

#include <algorithm>
#include <cmath>

namespace railstep {

int bays_behind(const Scene& scene) {
  double last = 0.;  // m; all starts are at 0 or ahead
  for (const LoadScene& load : scene.loads) last = std::max(last, load.start);
  for (const WheelsetScene& w : scene.wheelsets) last = std::max(last, w.start);
  for (const VehicleScene& v : scene.vehicles)
    for (const Vehicle::Wheel& wheel : v.kind.vehicle.wheels)
      last = std::max(last, v.start + wheel.place);
  const auto taken = static_cast<std::int64_t>(last / scene.track.bay) + 1;
  return static_cast<int>(std::max<std::int64_t>(0, scene.track.bays - taken) / 2);
}

}  // namespace railstep
