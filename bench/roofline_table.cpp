// A step compared with the limits of the machine, as CSV for docs/roofline.md: first the machine's
// own rates, then models of the moving-load scene with 1 to 256 bays.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "peers/peer_moving_load.h"

using namespace railstep;

namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Keeps the compiler from removing a loop's result.
template <class T>
void keep(T& value) {
  asm volatile("" : "+m"(value) : : "memory");
}

/// Least time of a call over `blocks` blocks of 2 ms or more, s: the time on an undisturbed
/// machine.
template <class Call>
double least_time(int blocks, const Call& call) {
  double best = 1e9;
  std::int64_t calls = 1;
  for (int n = 0; n < blocks;) {
    const double start = seconds();
    for (std::int64_t i = 0; i < calls; ++i) call();
    const double took = seconds() - start;
    if (took < 2e-3) {
      calls *= 2;
      continue;
    }
    best = std::min(best, took / static_cast<double>(calls));
    ++n;
  }
  return best;
}

/// Rate of independent multiplications and additions, flops/s: seven chains of each in vectors.
double peak_flops() {
  constexpr int kLanes = 14, kIterations = 4096;
  double product[kLanes], sum[kLanes];
  std::fill(product, product + kLanes, 1.);
  std::fill(sum, sum + kLanes, 0.);
  const double time = least_time(50, [&] {
    double p[kLanes], s[kLanes];
    std::copy(product, product + kLanes, p);
    std::copy(sum, sum + kLanes, s);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
#pragma omp simd
      for (int i = 0; i < kLanes; ++i) p[i] *= .999999;
#pragma omp simd
      for (int i = 0; i < kLanes; ++i) s[i] += 1.25;
    }
    std::copy(s, s + kLanes, sum);
    std::fill(product, product + kLanes, p[0] + p[kLanes - 1] > 1e-300 ? 1. : 2.);
    keep(product);
    keep(sum);
  });
  return 2. * kLanes * kIterations / time;
}

/// Bytes per second read from an array of this size. Words are joined by OR, which takes less time
/// than the reading.
double read_rate(std::size_t bytes) {
  const std::vector<std::uint64_t> x(bytes / sizeof(std::uint64_t), 1);
  const double time = least_time(20, [&] {
    std::uint64_t all[16] = {};
    for (std::size_t at = 0; at + 16 <= x.size(); at += 16) {
#pragma omp simd
      for (std::size_t i = 0; i < 16; ++i) all[i] |= x[at + i];
    }
    keep(all);
  });
  return static_cast<double>(bytes) / time;
}

void print_model(const char* name, int bays, const MovingLoadOptions& options, int per_bay,
                 Unknowns unknowns, double flops_rate) {
  MovingLoadRun run(moving_load_track(bays, per_bay, 2, unknowns), options);
  const double time = least_time(60, [&] { (void)run.frame(); });
  const double rate = read_rate(std::max<std::size_t>(4096, static_cast<std::size_t>(run.bytes())));
  const double by_flops = run.flops() / flops_rate, by_bytes = run.bytes() / rate;
  std::printf("%s,%d,%.4g,%.0f,%.0f,%.3g,%.4g,%.4g,%.3g\n", name, bays, 1e6 * time, run.flops(),
              run.bytes(), run.flops() / run.bytes(), 1e6 * by_flops, 1e6 * by_bytes,
              std::max(by_flops, by_bytes) / time);
  std::fflush(stdout);
}

}  // namespace

int main() {
  const double flops = peak_flops();
  std::printf("rate,value\nflops per s,%.4g\n", flops);
  for (const std::size_t kib : {16u, 256u, 4096u, 65536u})
    std::printf("bytes per s of %zu KiB,%.4g\n", kib, read_rate(kib << 10));
  std::printf("\nmodel,bays,us,flops,bytes,flops_per_byte,us_of_flops,us_of_bytes,share\n");
  for (const int bays : {4, 16, 64, 256}) {
    print_model("full order, 2 unknowns a node", bays, {}, 1, Unknowns::vertical, flops);
    print_model("full order, 9 unknowns a node", bays, {}, 1, Unknowns::full, flops);
    Reduction one;
    one.limit = {bays, 1e9};
    print_model("condensed, 1 mode a bay", bays, {.reduction = one}, 2, Unknowns::vertical, flops);
  }
  return 0;
}
