// A frame of 1 ms of a bogie on a track without end, with the error of its contact forces against a
// long track of full order refined in mesh and step.
#include <benchmark/benchmark.h>

#include <vector>

#include "endless_scene.h"
#include "measure.h"
#include "offline/start/start.h"

namespace railstep {
namespace {

constexpr double kStep = 50e-6;            // s
constexpr int kFrame = 20, kFrames = 700;  // steps of a frame; frames compared, 0.7 s
constexpr int kFirst = 400;                // first compared frame: the starts have decayed

/// A bogie over a rail of class 5 with waves of .3 m to 20 m: 1.5 to 100 Hz.
Traffic traffic(double x) {
  return bogie_over(x, find_spectra("fra_5")->of[static_cast<int>(Geometry::vertical)],
                    {.shortest = .3, .longest = 20., .length = 100., .patch = .012});
}

/// Contact forces of both wheels at the middle of each step, where the ring's held forces count.
/// @param finer  steps of the run per such step, 1 or even
std::vector<double> forces(const PackedModel& packed, int finer) {
  Run run(packed);
  std::vector<double> found;
  for (int n = 1; n <= kFrames * kFrame; ++n)
    for (int part = 1; part <= finer; ++part) {
      run.frame();
      if (n > kFirst * kFrame && part == (finer + 1) / 2)
        found.insert(found.end(), run.state().contact_force, run.state().contact_force + 2);
    }
  return found;
}

std::vector<double> full_order(int elements_per_bay, int finer) {
  const Track track = track_of(76, elements_per_bay, 1);  // 45.6 m
  PackedModel packed(track, traffic(12.), {.scheme = generalised_alpha(kStep / finer, .6)});
  packed.set_start(start_in_equilibrium(track, packed, 0.));
  return forces(packed, finer);
}

struct Reference {
  std::vector<double> force;
  double own_error, swing;  // swing: largest deviation from the mean, over the mean
};

const Reference& reference() {
  static const Reference made = [] {
    Reference r{full_order(8, 4), 0., 0.};
    r.own_error = error_over_peak(full_order(4, 2), r.force);
    double mean = 0.;
    for (const double f : r.force) mean += f / static_cast<double>(r.force.size());
    for (const double f : r.force) r.swing = std::max(r.swing, std::abs(f / mean - 1.));
    return r;
  }();
  return made;
}

/// Args are bays of the ring and modes per bay.
void frame_of_bogie(benchmark::State& run) {
  const int bays = static_cast<int>(run.range(0)), modes = static_cast<int>(run.range(1));
  const Track ring = ring_of(bays, 1);
  const auto packed = [&](int steps) {
    PackOptions options = ring_options(bays, modes, kStep);
    options.steps_per_frame = steps;
    return std::make_unique<PackedModel>(ring, traffic(0.), options);
  };
  const auto single = packed(1), framed = packed(kFrame);
  for (PackedModel* own : {single.get(), framed.get()})
    own->set_start(start_in_equilibrium(ring, *own, 0.));
  const std::vector<double> force = forces(*single, 1);
  Run timed(*framed);
  measure(run, 10, 1, [&] { benchmark::DoNotOptimize(timed.frame()); });
  run.counters["error"] = error_over_peak(force, reference().force);
  run.counters["reference_error"] = reference().own_error;
  run.counters["force_swing"] = reference().swing;
  run.counters["unknowns"] = framed->model().unknowns;
}

BENCHMARK(frame_of_bogie)
    ->ArgNames({"bays", "modes_per_bay"})
    ->ArgsProduct({{16, 24}, {1, 2, 3}})
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(2'000);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
