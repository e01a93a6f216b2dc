#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "endless.h"
#include "offline/pack/course.h"
#include "offline/track/functional.h"
#include "online/model/course.h"
#include "online/step/probe.h"

using namespace railstep;

namespace {

/// Deflection under a load, of a sleeper and force of its pad, over the passage of bays.
struct Passage {
  std::vector<double> deflection, sleeper, pad;
};

/// Probes on the seat: of the sleeper under the left rail, and what opens the pad, which moves by
/// stiffness and damping.
std::vector<Probe> seat_probes(const Track& track, int seat) {
  Functional sleeper;
  sleeper.sleeper.push_back({0, seat, 2, 1.});
  const Functional gap = pad_gap(track, 0, seat);
  return {{.displacement = 1., .track = sleeper},
          {.displacement = track.support.stiffness[2],
           .velocity = track.support.damping[2],
           .track = gap}};
}

double largest(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double error = 0., peak = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error = std::max(error, std::abs(a[i] - b[i]));
    peak = std::max(peak, std::abs(b[i]));
  }
  return error / peak;
}

void note(const ModelRun& run, Passage& passage) {
  double probes[2];
  read_probes(run.model(), run.state, run.outputs, probes);
  passage.deflection.push_back(run.outputs.load_deflection[0]);
  passage.sleeper.push_back(probes[0]);
  passage.pad.push_back(probes[1]);
}

/// Two bays of a load that has run for 60 on 200 bays; the sleeper is the last one passed.
Passage reference(int elements_per_bay, double dt, double behind) {
  const Track track = endless_track(200, elements_per_bay);
  Traffic traffic{.loads = {moving_load(30.)}};
  if (behind > 0.) traffic.loads.push_back(moving_load(30. - behind));
  Passage passage;
  for (const int bay : {0, 1}) {
    traffic.probes = seat_probes(track, 110 + bay);
    PackOptions options;
    options.scheme = generalised_alpha(dt, .6);
    options.residual_points = 8;
    ModelRun run(track, traffic, options);
    run.packed->set_start(start_in_equilibrium(track, *run.packed, 0.));
    reset(run.model(), run.state);
    const auto a_bay = static_cast<std::int64_t>(std::llround(.02 / dt));
    while (run.state.steps < (60 + bay + 1) * a_bay) {
      run.step();
      const bool whole = run.state.steps % (a_bay / 20) == 0;
      if (whole && run.state.steps >= (60 + bay) * a_bay && run.state.steps < (61 + bay) * a_bay)
        note(run, passage);
    }
  }
  return passage;
}

Passage passage_of(ModelRun& run, std::int64_t first, std::int64_t steps) {
  Passage passage;
  while (run.state.steps < first + steps) {
    run.step();
    if (run.state.steps >= first && run.state.steps < first + steps) note(run, passage);
  }
  CHECK(run.seen == Status::ok);
  return passage;
}

}  // namespace

TEST_CASE("a course goes whole bays in whole steps, and else what a wide integer says") {
  const Course twentieth = course_of(30. * 1e-3 / .6);
  CHECK(twentieth.period == 20);
  CHECK(twentieth.bays == 1);
  const Course odd = course_of(std::sqrt(2.) / 100.);
  CHECK(gone_at(odd, 1'000'000'000'000).bays == 14'142'135'623);
  for (const std::int64_t n : {0L, 7L, 19L}) {
    CHECK(gone_at(twentieth, n + 20'000'000).part == gone_at(twentieth, n).part);
    CHECK(gone_at(twentieth, n + 20'000'000).bays == 1'000'000);
  }
  CHECK_THROWS(course_of(1.));
  CHECK_THROWS(course_of(-.1));
}

TEST_CASE("a condensed ring moves under a load as a long track of a fine mesh does") {
  // the bound: 1e-3 of the peak
  const Passage want = reference(4, 2.5e-4, 0.);
  const Track ring = ring_of(endless_track(40, 2));
  Traffic traffic{.loads = {moving_load(0.)}};
  traffic.probes = seat_probes(ring, 20);
  ModelRun run(ring, traffic, ring_options(ring, 3));
  run.packed->set_start(start_in_equilibrium(ring, *run.packed, 0.));
  reset(run.model(), run.state);
  const Passage got = passage_of(run, 60 * 20, 40);
  const double deflection = largest(got.deflection, want.deflection),
               sleeper = largest(got.sleeper, want.sleeper), pad = largest(got.pad, want.pad);
  CAPTURE(deflection, sleeper, pad);
  CHECK(deflection < 1e-3);
  CHECK(sleeper < 1e-3);
  CHECK(pad < 1e-3);
}
