// Mass and stiffness of one element, with the error of a cantilever of two elements.
#include <benchmark/benchmark.h>

#include <cmath>

#include "offline/analysis/statics.h"
#include "offline/element/matrices.h"

namespace railstep {
namespace {

/// Rounded constants of 60E1; the centroid is on the axis, the shear centre where the load acts.
BeamSection section() {
  return {.area = 76.7e-4,
          .inertia_y = 30.38e-6,
          .inertia_z = 5.123e-6,
          .torsion = 2.2e-6,
          .shear_factor_y = .45,
          .shear_factor_z = .4};
}

/// Tip of a 2 m cantilever under an end load against Timoshenko's P L^3 / 3 E I + P L / k G A.
double tip_error(int axial_points) {
  Track track;
  track.section = section();
  track.unknowns = Unknowns::vertical;
  track.rails = 1;
  track.bay_length = 4.;
  track.elements_per_bay = 4;
  track.ends = {RailEnd::clamped, RailEnd::clamped};
  track.rule.axial_points = axial_points;
  // It is half of a clamped beam under a force in its middle: L = 2 m, half the force, no rotation
  // at the end.
  const Statics statics(track);
  const double got = statics.flexibility({0, 2., 0., 0., 2}, {0, 2., 0., 0., 2});
  const BeamSection s = section();
  const Material m{};
  const double G = m.young / (2. * (1. + m.poisson));
  const double want =
      std::pow(4., 3) / (192. * m.young * s.inertia_y) + 4. / (4. * s.shear_factor_z * G * s.area);
  return std::abs(got / want - 1.);
}

void matrices(benchmark::State& run) {
  const int points = static_cast<int>(run.range(0));
  for (auto _ : run)
    benchmark::DoNotOptimize(
        element_matrices(section(), beam_law(section(), {}, {.axial_points = points}), .6));
  run.counters["error"] = tip_error(points);
}

BENCHMARK(matrices)->ArgName("axial_points")->Arg(2)->Arg(3);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
