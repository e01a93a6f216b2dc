// Elastic force and tangent of one nonlinear element by the fast and the general kernel, each with
// its largest difference from the general one. Blocks of calls take turns with blocks of a
// yardstick, a chain of 512 additions. `ratio` is the median of their ratios, on which a slow
// minute of the machine has no effect; `best_us` is the quickest block. The batch uses the kernels
// of this processor.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "measure.h"
#include "offline/element/matrices.h"
#include "offline/element/straight_beam.h"
#include "online/beam/kernels.h"
#include "online/beam/straight_nodes.h"

namespace railstep {
namespace {

constexpr double kLength = .6;  // m
constexpr int kElements = 16;   // of a batch

BeamSection rail() {  // section F of the reference numbers
  const Rectangles<double> parts{{.1380985536, .02522171327, .07720505094},
                                 {.020996636, .13308941227, .03165145173}};
  return {.area = 8700e-6,
          .inertia_y = 39.0e-6,
          .inertia_z = 6.0e-6,
          .torsion = 1.9514e-6,
          .shear_factor_y = .4796,
          .shear_factor_z = .4721,
          .shear_centre_z = -.0391,
          .moments = moments(parts)};
}

BeamSection rectangle() {
  const double h = .190, b = .0682315;
  return {.area = h * b,
          .inertia_y = b * h * h * h / 12.,
          .inertia_z = h * b * b * b / 12.,
          .torsion = h * b * b * b / 3. * (1. - .63 * b / h),
          .shear_factor_y = 5. / 6.,
          .shear_factor_z = 5. / 6.,
          .moments = rectangle_moments(h, b)};
}

/// A row of elements bent and stretched by about 1e-2, and the results of both kernels.
struct Row {
  Beam general;
  StraightBeam straight;
  std::vector<double> q, force, tangent;

  explicit Row(const BeamSection& section)
      : general(beam_element(beam_law(section, {}), straight_nodes(kLength))),
        straight(straight_beam(beam_law(section, {}), kLength)),
        q(9 * (2 * kElements + 1)),
        force(q.size()),
        tangent(static_cast<std::size_t>(straight_groups(kElements) * kStraightGroup)) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const std::size_t node = i / 9;
      q[i] = .01 * std::sin(7. * static_cast<double>(i * i));
      if (i % 9 == 0) q[i] += .5 * kLength * static_cast<double>(node);
      if (i % 9 == 4 || i % 9 == 8) q[i] += 1.;
    }
  }
  const double* element(int e) const { return q.data() + 18 * e; }
};

struct Differences {
  double force, tangent;
};

/// Largest difference of the single and the batch form from the general kernel, over the largest
/// entry of all elements.
Differences differences(Row& row) {
  double force_peak = 0., tangent_peak = 0., force_gap = 0., tangent_gap = 0.;
  kernels_in_use().space.tangents(row.straight, kElements, row.q.data(), nullptr, row.force.data(),
                                  row.tangent.data());
  for (int e = 0; e < kElements; ++e) {
    std::array<double, 27> F{}, f{};
    std::array<double, 729> K{}, k{};
    beam_tangent(row.general, row.element(e), F.data(), K.data());
    straight_tangent(row.straight, row.element(e), f.data(), k.data());
    for (std::size_t i = 0; i < 27; ++i) {
      force_peak = std::max(force_peak, std::abs(F[i]));
      force_gap = std::max(force_gap, std::abs(F[i] - f[i]));
    }
    for (int i = 0; i < 729; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double batch = straight_entry(row.tangent.data(), e, i / 27, i % 27);
      tangent_peak = std::max(tangent_peak, std::abs(K[at]));
      tangent_gap = std::max({tangent_gap, std::abs(K[at] - k[at]), std::abs(K[at] - batch)});
    }
  }
  return {force_gap / force_peak, tangent_gap / tangent_peak};
}

/// A number that counts its operations.
struct Counted {
  static inline long operations = 0;
  Counted& operator+=(const Counted&) { return count(); }
  Counted& operator-=(const Counted&) { return count(); }
  Counted& operator+=(double) { return count(); }
  Counted& operator-=(double) { return count(); }
  Counted& operator*=(double) { return count(); }
  friend Counted operator+(Counted a, const Counted&) { return a.count(); }
  friend Counted operator-(Counted a, const Counted&) { return a.count(); }
  friend Counted operator*(Counted a, const Counted&) { return a.count(); }
  friend Counted operator*(double, Counted a) { return a.count(); }
  friend Counted operator-(Counted a) { return a; }

 private:
  Counted& count() {
    ++operations;
    return *this;
  }
};

/// Additions and multiplications of one element, as written in the kernel; the tangent's without
/// the mirrored half.
long flops(bool with_tangent) {
  using namespace straight;
  Counted q[27], even[15], odd[15], V[15], s[15], stress[15], F[15];
  std::vector<Counted> K(9 * kMatrices);
  const StraightBeam beam{};
  Counted::operations = 0;
  split<Spatial>(1., q, q + 9, q + 18, even, odd);
  for (int point = 0; point < 2; ++point) {
    strains<Spatial>(V, s);
    stresses<Spatial>(beam, s, stress);
    vector_forces<Spatial>(stress, V, F);
    if (with_tangent) vector_tangent<Spatial>(beam, stress, V, K.data());
  }
  gather<Spatial>(1., even, odd, q, q + 9, q + 18);
  if (with_tangent)
    unrolled<kUpperPairs>([&](auto pair) {
      for (int c = 0; c < 9; ++c)
        benchmark::DoNotOptimize(
            node_pairs<pair>({}, K.data(), K.data(), [c](int matrix) { return 9 * matrix + c; }));
    });
  // V, its forces and its tangent at the two points take a sum and a difference each.
  return Counted::operations + 2 * (15 + 15 + (with_tangent ? 9 * kProducts : 0));
}

using Section = BeamSection();

void force(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 128, 1, [&] {
    straight_force(row.straight, row.q.data(), row.force.data());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = differences(row).force;
  run.counters["flops"] = static_cast<double>(flops(false));
}

void tangent(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 32, 1, [&] {
    straight_tangent(row.straight, row.q.data(), row.force.data(), row.tangent.data());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = differences(row).tangent;
  run.counters["flops"] = static_cast<double>(flops(true));
}

void forces_of_16(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 16, kElements, [&] {
    kernels_in_use().space.forces(row.straight, kElements, row.q.data(), nullptr, row.force.data());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = differences(row).force;
  run.counters["flops"] = static_cast<double>(flops(false));
}

void tangents_of_16(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 8, kElements, [&] {
    kernels_in_use().space.tangents(row.straight, kElements, row.q.data(), nullptr,
                                    row.force.data(), row.tangent.data());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = differences(row).tangent;
  run.counters["flops"] = static_cast<double>(flops(true));
}

void general_force(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 32, 1, [&] {
    beam_force(row.general, row.q.data(), row.force.data());
    benchmark::ClobberMemory();
  });
}

void general_tangent(benchmark::State& run, Section* section) {
  Row row(section());
  measure(run, 2, 1, [&] {
    beam_tangent(row.general, row.q.data(), row.force.data(), row.tangent.data());
    benchmark::ClobberMemory();
  });
}

#define RAILSTEP_BEAM(kernel)                              \
  BENCHMARK_CAPTURE(kernel, rail, &rail)->UseManualTime(); \
  BENCHMARK_CAPTURE(kernel, rectangle, &rectangle)->UseManualTime()
RAILSTEP_BEAM(force);
RAILSTEP_BEAM(tangent);
RAILSTEP_BEAM(forces_of_16);
RAILSTEP_BEAM(tangents_of_16);
RAILSTEP_BEAM(general_force);
RAILSTEP_BEAM(general_tangent);
#undef RAILSTEP_BEAM

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
