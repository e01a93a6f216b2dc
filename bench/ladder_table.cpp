// Condensed models of one rail of 40 ballasted bays, compared with full order refined in mesh and
// step, as CSV on stdout for docs/condensation.md. A load of 50 kN at 30 m/s is constant or
// oscillates at 200 Hz or 1 kHz. Columns are errors over the peak, of the deflection under the
// load, of the force of a pad and of the displacement of its sleeper; and the cost of a step.
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "endless_scene.h"
#include "offline/start/start.h"
#include "online/track/track_sensor.h"

namespace railstep {
namespace {

constexpr int kBays = 40, kSeat = 20;
constexpr double kFrame = 1e-3, kStep = 1e-4, kForce = 50e3;       // s, N
constexpr int kFrames = 500, kSettled = 200;                       // errors count after kSettled
constexpr std::array<double, 3> kFrequencies = {0., 200., 1000.};  // Hz

/// Deflection under the load, force of the pad and displacement of the sleeper of kSeat, by frame.
using Rows = std::array<std::vector<double>, 3>;

Traffic passing(double hz) {
  const Functional gap{.rail = {{{0, kSeat * .6, 0., 0., 2}, 1.}}, .sleeper = {{0, kSeat, 2, -1.}}};
  MovingLoad load{.start = 4.5, .speed = kSpeed, .stop = 24.};
  (hz > 0. ? load.amplitude : load.force) = -kForce;
  load.frequency = hz;
  return {.loads = {load},
          .track_sensors = {{.displacement = -200e6, .velocity = -20e3, .track = gap},
                            {.displacement = 1., .track = {.sleeper = {{0, kSeat, 2, 1.}}}}}};
}

Rows rows_of(const Track& track, double hz, PackOptions options, double step) {
  options.steps_per_frame = static_cast<int>(std::lround(kFrame / step));
  PackedModel packed(track, passing(hz), options);
  packed.set_start(start_in_equilibrium(track, packed, 0.));
  Run run(packed);
  Rows rows;
  for (int frame = 1; frame <= kFrames; ++frame) {
    run.frame();
    double track_sensor[2];
    read_track_sensors(packed.model(), run.state(), run.outputs(), track_sensor);
    if (frame <= kSettled) continue;
    rows[0].push_back(run.outputs().load_deflection[0]);
    rows[1].push_back(track_sensor[0]);
    rows[2].push_back(track_sensor[1]);
  }
  return rows;
}

PackOptions full_order(double step) { return {.scheme = generalised_alpha(step, .6)}; }

struct Rung {
  const char* name;
  std::optional<ReductionKind> kind;
  double per_bay;  // modes or coordinates; nodes of guyan and irs
};

PackOptions options_of(const Rung& rung, bool residual) {
  PackOptions options{.scheme = held_force(kStep, .6), .residual_flexibility = residual};
  if (!rung.kind) options.scheme = generalised_alpha(kStep, .6);
  if (rung.kind)
    options.reduction = Reduction{
        .kind = *rung.kind,
        .limit = {static_cast<int>(rung.per_bay * kBays), std::numeric_limits<double>::infinity()},
        .nodes_per_bay = std::max(1, static_cast<int>(rung.per_bay)),
        .expansion_hz = {20., 84., 356., 1500.}};
  return options;
}

/// Best of many blocks of steps of 1 ms, us per step.
double step_us(const Track& track, PackOptions options) {
  using Clock = std::chrono::steady_clock;
  options.scheme = options.reduction ? held_force(1e-3, .6) : generalised_alpha(1e-3, .6);
  Traffic traffic = passing(0.);
  traffic.loads[0].speed = 0.;
  const PackedModel packed(track, traffic, options);
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
  std::printf("kind,per_bay,residual,coordinates,step_flops,step_us");
  for (const double hz : kFrequencies)
    for (const char* output : {"deflection", "pad", "sleeper"})
      std::printf(",%s_%g_hz", output, hz);
  std::printf("\nreference,,,,,");
  std::array<Rows, 3> want;
  for (std::size_t i = 0; i < want.size(); ++i) {
    want[i] = rows_of(track_of(kBays, 16, 1), kFrequencies[i], full_order(6.25e-6), 6.25e-6);
    const Rows half = rows_of(track_of(kBays, 8, 1), kFrequencies[i], full_order(1.25e-5), 1.25e-5);
    for (std::size_t c = 0; c < 3; ++c) std::printf(",%.1e", error_over_peak(half[c], want[i][c]));
  }
  std::printf("\n");
  const Track track = track_of(kBays, 4, 1);
  const Rung rungs[] = {{"full", {}, 0.},
                        {"modal", ReductionKind::modal, .5},
                        {"modal", ReductionKind::modal, 1.},
                        {"modal", ReductionKind::modal, 2.},
                        {"modal", ReductionKind::modal, 4.},
                        {"guyan", ReductionKind::guyan, 1.},
                        {"guyan", ReductionKind::guyan, 2.},
                        {"guyan", ReductionKind::guyan, 4.},
                        {"irs", ReductionKind::irs, 1.},
                        {"irs", ReductionKind::irs, 2.},
                        {"craig-bampton", ReductionKind::craig_bampton, 1.},
                        {"craig-bampton", ReductionKind::craig_bampton, 2.},
                        {"craig-bampton", ReductionKind::craig_bampton, 4.},
                        {"krylov", ReductionKind::krylov, 1.},
                        {"krylov", ReductionKind::krylov, 2.},
                        {"krylov", ReductionKind::krylov, 4.},
                        {"complex-modes", ReductionKind::complex_modes, 2.},
                        {"complex-modes", ReductionKind::complex_modes, 4.}};
  for (const Rung& rung : rungs)
    for (const bool residual : {true, false}) {
      const PackedModel packed(track, passing(0.), options_of(rung, residual));
      int kept = 0;
      for (const PackedLine& own : packed.lines())
        kept += rung.kind ? kept_coordinates(own.basis, own.modes) : own.line.unknowns();
      std::printf("%s,%g,%s,%d,%lld,%.2f", rung.name, rung.per_bay, residual ? "yes" : "no", kept,
                  static_cast<long long>(packed.model().cost.flops),
                  step_us(track, options_of(rung, residual)));
      for (std::size_t i = 0; i < want.size(); ++i) {
        const Rows got = rows_of(track, kFrequencies[i], options_of(rung, residual), kStep);
        for (std::size_t c = 0; c < 3; ++c)
          std::printf(",%.1e", error_over_peak(got[c], want[i][c]));
      }
      std::printf("\n");
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace railstep

int main() { railstep::table(); }
