// Laws of a contact patch: time of one force with its derivatives, beside its error. The normal
// law's is over that of 129 strips, and over Hertz; that of a wheel on profiles, whose zones are
// found first, over patches of 64 strips about places found offline; a creep law's is the distance
// from CONTACT's forces over the limit, root mean square of the cases without spin and of those
// with pure spin up to 0.7.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "offline/profile/contact_tables.h"
#include "online/patch/creep.h"
#include "online/patch/strip_patch.h"
#include "support/creep_rows.h"
#include "support/wheel_pair.h"

namespace railstep {
namespace {

constexpr double kRadius = .46, kCrown = .3;          // m
constexpr double kModulus = 210e9 / (1. - .09);       // N/m2
constexpr double kHertz = 1.0412e-4, kForce = 100e3;  // approach, m, and force, N, by Hertz
constexpr double kLeastDepth = kLeastPatchDepth;

std::vector<double> gap_of(int strips, double width) {
  std::vector<double> gap;
  const int middle = strips / 2;
  for (int i = 0; i < strips; ++i) {
    const double y = (i - middle) * width;
    gap.push_back(y * y / (2. * kCrown));
  }
  return gap;
}

StripPatch on_crown(const std::vector<double>& gap, double width) {
  const auto strips = static_cast<int>(gap.size());
  StripPatch patch{gap.data(), strips, .5 * (strips - 1), {}, width, kRadius, kModulus};
  patch.collocation = collocation_of(patch, kHertz);
  return patch;
}

PatchForce force_of(int strips, double approach) {
  const double width = 2. * std::sqrt(2. * kCrown * kVirtualPart * kHertz) / (strips - 1);
  const std::vector<double> gap = gap_of(strips, width);
  return patch_force(on_crown(gap, width), approach);
}

void normal(benchmark::State& bench) {
  const auto strips = static_cast<int>(bench.range(0));
  const double width = 2. * std::sqrt(2. * kCrown * kVirtualPart * kHertz) / (strips - 1);
  const std::vector<double> gap = gap_of(strips, width);
  const StripPatch patch = on_crown(gap, width);
  double approach = kHertz;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(approach);
    benchmark::DoNotOptimize(patch_force(patch, approach));
  }
  const double force = force_of(strips, kHertz).normal;
  bench.counters["error"] = force / force_of(kMostPatchStrips, kHertz).normal - 1.;
  bench.counters["against_hertz"] = force / kForce - 1.;
}
BENCHMARK(normal)->ArgName("strips")->Arg(9)->Arg(17)->Arg(33)->Arg(65)->Arg(129);

/// Zones of the right wheel under 60 kN and the forces of their patches, over `loaded()`.
void wheel_zones(benchmark::State& bench) {
  const WheelRail profiles = s1002_on_60e1();
  const Elastic steel;
  const ContactTables tables(profiles, steel);
  const double shift = 1e-3 * static_cast<double>(bench.range(0)), load = 6e4;
  const WheelsetLoaded exact = loaded(profiles, steel, shift, load);
  WheelsetPlace at{shift, exact.right.height, exact.roll, 0.};
  double upright = 0.;
  int zones = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(at);
    WheelZone zone[kMostZones];
    zones = find_zones(tables.pair(), at, kLeastDepth, zone);
    upright = 0.;
    for (int i = 0; i < zones; ++i)
      upright += patch_force(patch_of(zone[i]), zone[i].depth).normal * zone[i].cosine;
    benchmark::DoNotOptimize(upright);
  }
  bench.counters["zones"] = zones;
  bench.counters["error"] = upright / load - 1.;
}
BENCHMARK(wheel_zones)->ArgName("shift_mm")->DenseRange(0, 7);

CreepForce row_force(CreepLaw law, int strips, const CreepRow& row) {
  return creep_force(law, strips, normalised_patch(row.ratio, kalker(row.ratio, .3)),
                     normalised_creepages(row.x, row.e, row.p));
}

double error_of(CreepLaw law, int strips, bool spin) {
  double sum = 0.;
  int count = 0;
  for (const CreepRow& row : kCreepRows) {
    if ((row.p != 0.) != spin || row.p > 1.) continue;
    const CreepForce force = row_force(law, strips, row);
    sum += std::pow(force.x - row.contact_x, 2) + std::pow(force.y - row.contact_y, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

void creep_law(benchmark::State& bench, CreepLaw law, int strips, CreepWanted wanted) {
  const CreepPatch patch = normalised_patch(.7, kalker(.7, .3));
  Creepages<double> creepages = normalised_creepages(.8, .5, .2);
  for (auto _ : bench) {
    benchmark::DoNotOptimize(creepages);
    benchmark::DoNotOptimize(creep_force(law, strips, patch, creepages, wanted));
  }
  bench.counters["no_spin_error"] = error_of(law, strips, false);
  bench.counters["spin_error"] = error_of(law, strips, true);
}
BENCHMARK_CAPTURE(creep_law, she, CreepLaw::she, 0, CreepWanted::slopes);
BENCHMARK_CAPTURE(creep_law, she_force, CreepLaw::she, 0, CreepWanted::force);
BENCHMARK_CAPTURE(creep_law, polach, CreepLaw::polach, 0, CreepWanted::slopes);
BENCHMARK_CAPTURE(creep_law, polach_force, CreepLaw::polach, 0, CreepWanted::force);
BENCHMARK_CAPTURE(creep_law, fastsim_5, CreepLaw::fastsim, 5, CreepWanted::slopes);
BENCHMARK_CAPTURE(creep_law, fastsim_5_force, CreepLaw::fastsim, 5, CreepWanted::force);
BENCHMARK_CAPTURE(creep_law, fastsim_10, CreepLaw::fastsim, 10, CreepWanted::slopes);
BENCHMARK_CAPTURE(creep_law, fastsim_10_force, CreepLaw::fastsim, 10, CreepWanted::force);
BENCHMARK_CAPTURE(creep_law, fastsim_20, CreepLaw::fastsim, 20, CreepWanted::slopes);
BENCHMARK_CAPTURE(creep_law, fastsim_20_force, CreepLaw::fastsim, 20, CreepWanted::force);

void coefficients(benchmark::State& bench) {
  double ratio = .7;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(ratio);
    benchmark::DoNotOptimize(kalker(ratio, .28));
  }
}
BENCHMARK(coefficients);

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
