// A force near the critical speed of a rail on seats so close that they are a bed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "model_run.h"
#include "offline/pack/scheme.h"
#include "offline/pack/start.h"
#include "offline/track/statics.h"
#include "sections.h"

using namespace railstep;

namespace {

/// hard-cases.md R9 and H14: section F on 3e7 N/m each .6 m, as seats each .1 m.
Track bed(int bays) {
  Track t;
  t.section = section_f();
  t.section.shear_factor_z = .472;
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.bay_length = .1;
  t.elements_per_bay = 1;
  t.support.stiffness = {0., 0., 5e6};
  return t;
}

}  // namespace

TEST_CASE("deflections below critical speed have their ratios to the static one", "[load]") {
  const double critical = 754.04;  // m/s, R9
  const double ratios[][2] = {{.25, 1.0329}, {.5, 1.1553}, {.75, 1.5138}, {.9, 2.2986}};
  for (const auto& [part, want] : ratios) {
    const int bays = part < .8 ? 600 : 2000;
    const Track track = bed(bays);
    const double speed = part * critical, dt = .1 / speed / 8.;
    auto packed = std::make_unique<PackedModel>(
        track,
        Traffic{.loads = {{.start = 10.05, .speed = speed, .stop = track.length(), .force = -1e5}}},
        PackOptions{.scheme = generalised_alpha(dt, .6)});
    packed->set_start(start_in_equilibrium(track, *packed, 0.));
    ModelRun run(std::move(packed));
    publish_start(run.model(), run.state, run.outputs);
    const double still = run.outputs.load_deflection[0];
    double least = 0., most = -1e9;  // over a bay, once the start has radiated away
    const double end = (track.length() - 20.) / speed;
    double sum = 0.;
    int count = 0;
    while (run.time() < end) {
      run.step();
      if (run.time() < end - 10. / speed) continue;
      const double ratio = run.outputs.load_deflection[0] / still;
      least = std::min(least == 0. ? ratio : least, ratio);
      most = std::max(most, ratio);
      sum += ratio;
      ++count;
    }
    UNSCOPED_INFO(part << ": " << least << " to " << most << " mean " << sum / count);
    CHECK(std::abs(sum / count / want - 1.) < .01);  // H14
  }
}
