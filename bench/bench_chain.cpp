// Forces, tangents, factor and solve of a beam chain in space and in the plane, per call, each with
// its error. For forces and tangents this is the largest difference from the general element, for
// factor and solve that of the solution from a dense one in long double. Times are as in measure.h,
// with the kernels of this processor.
#include <Eigen/Cholesky>
#include <cmath>
#include <cstring>

#include "measure.h"
#include "offline/element/straight_beam.h"
#include "online/beam/kernels.h"

namespace railstep {
namespace {

constexpr double kLength = .5;       // m
constexpr double kMassFactor = 8e6;  // relative to the stiffness: 4 / dt2 for dt 1 ms, over 1/2

template <int W>
const RowKernels& row() {
  return W == 9 ? kernels_in_use().space : kernels_in_use().plane;
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

/// A chain clamped at its start and bent by about 1e-5, and the results of its calls.
template <int W>
struct Beams {
  BeamLaw law = beam_law(rectangle(), {});
  std::int32_t held[W];
  Chain chain;
  std::vector<double> q, d, force, tangents, scratch, factor, x;

  explicit Beams(int n) : chain{straight_beam(law, kLength), {}, held, W, n} {
    for (int i = 0; i < W; ++i) held[i] = i;
    const auto mass = chain_mass(rectangle(), law);
    std::copy(mass.begin(), mass.end(), chain.mass);
    const std::size_t size = std::size_t{W} * static_cast<std::size_t>(chain_nodes(n));
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t unknown = spatial(i % W);
      const double rest = unknown == 4 || unknown == 8 ? 1. : 0.;
      q.push_back(1e-5 * std::sin(7. * static_cast<double>(i * i)) + rest);
      const std::size_t node = i / W;
      if (unknown == 0) q.back() += .5 * kLength * static_cast<double>(node);
      d.push_back(1e-5 * std::sin(5. * static_cast<double>(i * i)));
      x.insert(x.end(), kChainSides, std::cos(3. * static_cast<double>(i * i)));
    }
    force.resize(size);
    tangents.resize(static_cast<std::size_t>(chain_tangent_doubles<W>(n)));
    scratch = tangents;
    factor.resize(static_cast<std::size_t>(chain_factor_doubles<W>(n)));
    forces(nullptr);
    set_tangents(nullptr);
    set_factor();
  }
  static std::size_t spatial(std::size_t i) {
    return W == 9 ? i : static_cast<std::size_t>(kPlanarOf[i]);
  }
  void forces(const double* half) {
    row<W>().forces(chain.beam, chain.elements, q.data(), half, force.data());
  }
  void set_tangents(const double* half) {
    row<W>().tangents(chain.beam, chain.elements, q.data(), half, force.data(), tangents.data());
  }
  /// chain_factor() overwrites its tangents, so it gets a copy each time.
  int set_factor() {
    copy();
    return row<W>().factor(chain, kMassFactor, 1., scratch.data(), factor.data());
  }
  void copy() { std::memcpy(scratch.data(), tangents.data(), tangents.size() * sizeof(double)); }

  /// Largest difference of forces and of the first elements' tangents from the general element,
  /// over the largest entry.
  std::pair<double, double> element_errors() {
    const Beam general = beam_element(law, straight_nodes(kLength));
    const auto entry = W == 9 ? straight_entry : planar_entry;
    std::vector<double> want(force.size());
    double K_peak = 0., K_gap = 0., F_peak = 0., F_gap = 0.;
    forces(nullptr);
    for (int e = 0; e < chain.elements; ++e) {
      std::vector<double> nodes(27), F(27), K(729);
      for (std::size_t i = 0; i < 3 * W; ++i)
        nodes[i / W * 9 + spatial(i % W)] = q[2 * W * static_cast<std::size_t>(e) + i];
      beam_tangent(general, nodes.data(), F.data(), K.data());
      for (std::size_t i = 0; i < 3 * W; ++i) {
        const std::size_t row = i / W * 9 + spatial(i % W);
        want[2 * W * static_cast<std::size_t>(e) + i] += F[row];
        for (std::size_t j = 0; j < 3 * W; ++j) {
          const double k = K[27 * row + j / W * 9 + spatial(j % W)];
          K_peak = std::max(K_peak, std::abs(k));
          K_gap = std::max(K_gap, std::abs(k - entry(tangents.data(), e, static_cast<int>(i),
                                                     static_cast<int>(j))));
        }
      }
    }
    for (std::size_t i = 0; i < want.size(); ++i) {
      F_peak = std::max(F_peak, std::abs(want[i]));
      F_gap = std::max(F_gap, std::abs(want[i] - force[i]));
    }
    return {F_gap / F_peak, K_gap / K_peak};
  }

  /// Largest difference of the four solutions from the dense one, over its largest entry. Slopes
  /// are multiplied by half the height, so all unknowns are in m.
  double solution_error() {
    using Long = long double;
    const Eigen::Index size = static_cast<Eigen::Index>(force.size());
    Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic> S(size, size);
    S.setZero();
    const auto M = element_matrices(rectangle(), law, kLength).mass;
    const auto entry = W == 9 ? straight_entry : planar_entry;
    const auto place = [](int i) {
      return i / W * 9 + static_cast<int>(spatial(static_cast<std::size_t>(i % W)));
    };
    for (int e = 0; e < chain.elements; ++e)
      for (int i = 0; i < 3 * W; ++i)
        for (int j = 0; j < 3 * W; ++j)
          S(2 * W * e + i, 2 * W * e + j) += static_cast<Long>(entry(tangents.data(), e, i, j) +
                                                               kMassFactor * M(place(i), place(j)));
    Eigen::Matrix<Long, Eigen::Dynamic, 1> b(size);
    for (Eigen::Index i = 0; i < size; ++i)
      b[i] = static_cast<Long>(x[static_cast<std::size_t>(4 * i)]);
    S.topRows(W).setZero();
    S.leftCols(W).setZero();
    S.topLeftCorner(W, W).setIdentity();
    b.head(W).setZero();
    const Eigen::Matrix<Long, Eigen::Dynamic, 1> want = S.ldlt().solve(b);
    std::vector<double> got = x;
    row<W>().solve(chain, factor.data(), got.data());
    Long gap = 0.L, peak = 0.L;
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index s = 0; s < kChainSides; ++s) {
        const Long scale = spatial(static_cast<std::size_t>(i % W)) > 2 ? .095L : 1.L;
        const Long difference =
            want[i] - static_cast<Long>(got[static_cast<std::size_t>(4 * i + s)]);
        gap = std::max(gap, scale * std::abs(difference));
        peak = std::max(peak, scale * std::abs(want[i]));
      }
    return static_cast<double>(gap / peak);
  }
};

int calls(int elements) { return elements > 16 ? 4 : 64; }

template <int W, bool kHalf>
void forces(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  measure(run, 4 * calls(beams.chain.elements), 1, [&] {
    beams.forces(kHalf ? beams.d.data() : nullptr);
    benchmark::ClobberMemory();
  });
  if (!kHalf) run.counters["error"] = beams.element_errors().first;
}

template <int W, bool kHalf>
void tangents(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  measure(run, calls(beams.chain.elements), 1, [&] {
    beams.set_tangents(kHalf ? beams.d.data() : nullptr);
    benchmark::ClobberMemory();
  });
  if (!kHalf) run.counters["error"] = beams.element_errors().second;
}

/// Time of the copy that the benchmark of the factor needs and a step does not.
template <int W>
void copy(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  measure(run, calls(beams.chain.elements), 1, [&] {
    beams.copy();
    benchmark::ClobberMemory();
  });
}

template <int W>
void factor(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  measure(run, calls(beams.chain.elements), 1, [&] {
    benchmark::DoNotOptimize(beams.set_factor());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = beams.solution_error();
}

/// Includes the copy of right-hand sides: solutions of solutions would soon be subnormal.
template <int W, int kSides>
void solve(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  std::vector<double> x(kSides == 1 ? beams.force.size() : beams.x.size());
  measure(run, calls(beams.chain.elements), 1, [&] {
    std::memcpy(x.data(), beams.x.data(), x.size() * sizeof(double));
    (kSides == 1 ? row<W>().solve_one : row<W>().solve)(beams.chain, beams.factor.data(), x.data());
    benchmark::ClobberMemory();
  });
  run.counters["error"] = beams.solution_error();
}

template <int W>
void inertia(benchmark::State& run) {
  Beams<W> beams(static_cast<int>(run.range(0)));
  measure(run, calls(beams.chain.elements), 1, [&] {
    row<W>().inertia(beams.chain, beams.q.data(), beams.force.data());
    benchmark::ClobberMemory();
  });
}

#define RAILSTEP_CHAIN(...) BENCHMARK(__VA_ARGS__)->Arg(4)->Arg(64)->UseManualTime()
RAILSTEP_CHAIN(forces<9, false>);
RAILSTEP_CHAIN(forces<9, true>);
RAILSTEP_CHAIN(forces<5, false>);
RAILSTEP_CHAIN(forces<5, true>);
RAILSTEP_CHAIN(tangents<9, false>);
RAILSTEP_CHAIN(tangents<9, true>);
RAILSTEP_CHAIN(tangents<5, false>);
RAILSTEP_CHAIN(tangents<5, true>);
RAILSTEP_CHAIN(copy<9>);
RAILSTEP_CHAIN(copy<5>);
RAILSTEP_CHAIN(factor<9>);
RAILSTEP_CHAIN(factor<5>);
RAILSTEP_CHAIN(solve<9, 4>);
RAILSTEP_CHAIN(solve<9, 1>);
RAILSTEP_CHAIN(solve<5, 4>);
RAILSTEP_CHAIN(solve<5, 1>);
RAILSTEP_CHAIN(inertia<9>);
RAILSTEP_CHAIN(inertia<5>);
#undef RAILSTEP_CHAIN

}  // namespace
}  // namespace railstep

BENCHMARK_MAIN();
