// A force near the critical speed of a rail on seats so close that they are a bed.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "model_run.h"
#include "offline/pack/scheme.h"
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

/// A table that grows from 0 to 1 by half a cosine over a time: what rings as a force appears
/// leaves it slowly near critical speed.
std::vector<double> soft(double time) {
  std::vector<double> rows;
  for (int i = 0; i <= 40; ++i) {
    rows.push_back(time * i / 40.);
    rows.push_back(.5 - .5 * std::cos(M_PI * i / 40.));
  }
  return rows;
}

/// Mean deflection under the force over the last 5 m of its way, over the static one.
double ratio_at(double speed, int bays) {
  const Track track = bed(bays);
  const double dt = .1 / speed / 3., way = track.length() - 20.;
  ModelRun run(track,
               {.loads = {{.start = 10.05,
                           .speed = speed,
                           .stop = track.length(),
                           .force = -1e5,
                           .table = soft(.8 * way / speed)}}},
               {.scheme = generalised_alpha(dt, .6)});
  double sum = 0.;
  int count = 0;
  while (run.time() * speed < way) {
    run.step();
    if (run.time() * speed < way - 5.) continue;
    sum += run.outputs.load_deflection[0];
    ++count;
  }
  const RailPoint middle{0, .5 * track.length() + .05, 0., 0., 2};
  return sum / count / (-1e5 * Statics(bed(bays)).flexibility(middle, middle));
}

}  // namespace

TEST_CASE("deflections below critical speed have their ratios to the static one", "[load]") {
  const double critical = 754.04;  // m/s, R9
  const double ratios[][2] = {{.25, 1.0329}, {.5, 1.1553}, {.75, 1.5138}, {.9, 2.2986}};
  for (const auto& [part, want] : ratios) {
    const double found = ratio_at(part * critical, part < .8 ? 600 : 1600);
    CAPTURE(part);
    UNSCOPED_INFO(part << " of critical speed: " << found);
    CHECK(std::abs(found / want - 1.) < .01);  // H14
  }
}
