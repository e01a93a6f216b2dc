// Rings of bays in Floquet modes, compared with a long track of full order, as CSV on stdout for
// docs/endless.md. Columns are the error of the deflection under a load at 30 m/s that oscillates
// at a frequency, over its peak, and the cost of a step under two constant loads.
#include <chrono>
#include <cstdio>
#include <vector>

#include "endless_scene.h"

namespace railstep {
namespace {

constexpr double kForce = -50e3;                          // N
constexpr double kStep = 4e-5, kEnd = .4, kSettled = .3;  // s; errors count after kSettled
constexpr double kFrequencies[] = {0., 20., 50., 100., 200., 500., 1000.};  // Hz

MovingLoad load_at(double start, double hz, int rail = 0) {
  MovingLoad load{.rail = rail,
                  .start = start,
                  .speed = kSpeed,
                  .stop = std::numeric_limits<double>::infinity(),
                  .force = kForce};
  for (int n = 0; hz > 0. && n * kStep <= kEnd + kStep; ++n) {
    load.table.push_back(n * kStep);
    load.table.push_back(std::sin(2. * M_PI * hz * n * kStep));
  }
  return load;
}

std::vector<double> deflections(const PackedModel& packed) {
  Run run(packed);
  std::vector<double> found;
  for (int n = 1; n <= std::lround(kEnd / kStep); ++n) {
    const double z = run.frame().load_deflection[0];
    if (n * kStep > kSettled) found.push_back(z);
  }
  return found;
}

std::vector<double> reference(double hz, int finer) {
  const Track track = track_of(200, 8, 1);
  const PackedModel packed(track, {.loads = {load_at(54., hz)}},
                           {.scheme = generalised_alpha(kStep / finer, .6),
                            .steps_per_frame = finer,
                            .residual_points = 8});
  return deflections(packed);
}

/// Best of many blocks of a bay's steps under a constant load on either rail, us per step.
double step_us(int bays, int modes) {
  using Clock = std::chrono::steady_clock;
  const Track ring = ring_of(bays, 2);
  const PackedModel packed(ring, {.loads = {load_at(0., 0., 0), load_at(0., 0., 1)}},
                           ring_options(bays, modes, 1e-3));
  Run run(packed);
  double best = 1e9;
  for (int block = 0; block < 2000; ++block) {
    const auto start = Clock::now();
    for (int n = 0; n < 20; ++n) run.frame();
    best = std::min(best,
                    std::chrono::duration<double, std::micro>(Clock::now() - start).count() / 20.);
  }
  return best;
}

void table() {
  std::vector<std::vector<double>> want;
  std::printf("bays,modes_per_bay,unknowns,step_us");
  for (const double hz : kFrequencies) std::printf(",error_%g_hz", hz);
  std::printf("\nreference,,,");
  for (const double hz : kFrequencies) {
    want.push_back(reference(hz, 4));
    std::printf(",%.1e", error_over_peak(reference(hz, 2), want.back()));
  }
  std::printf("\n");
  for (const int bays : {16, 24, 32, 40, 64})
    for (const int modes : {1, 2, 3, 4, 6}) {
      const Track ring = ring_of(bays, 1);
      std::vector<double> errors;
      int unknowns = 0;
      for (std::size_t i = 0; i < want.size(); ++i) {
        const PackedModel packed(ring, {.loads = {load_at(0., kFrequencies[i])}},
                                 ring_options(bays, modes, kStep));
        unknowns = packed.model().unknowns;
        errors.push_back(error_over_peak(deflections(packed), want[i]));
      }
      std::printf("%d,%d,%d,%.2f", bays, modes, unknowns, step_us(bays, modes));
      for (const double e : errors) std::printf(",%.1e", e);
      std::printf("\n");
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace railstep

int main() { railstep::table(); }
