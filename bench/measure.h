#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace railstep {

/// Products of 512 numbers, 4 KiB, added one after the other: a chain that no vector shortens. It
/// takes 512 times the processor's latency of an addition.
class Yardstick {
 public:
  void once() {
    double sum = 0.;
    for (const double x : x_) sum += x * x;
    benchmark::DoNotOptimize(sum);
  }

 private:
  std::vector<double> x_ = std::vector<double>(512, 1.5);
};

/// Measures blocks of calls and of the yardstick in turns; a block of each is one iteration. One
/// call computes `elements`.
template <class Call>
void measure(benchmark::State& run, int calls, int elements, const Call& call) {
  using Clock = std::chrono::steady_clock;
  const auto us = [](Clock::duration d) {
    return std::chrono::duration<double, std::micro>(d).count();
  };
  Yardstick yardstick;
  double best = 1e9, best_yardstick = 1e9;
  std::vector<double> ratios;
  for (auto _ : run) {
    const auto start = Clock::now();
    for (int i = 0; i < calls; ++i) call();
    const auto middle = Clock::now();
    for (int i = 0; i < calls; ++i) yardstick.once();
    const auto end = Clock::now();
    const double own = us(middle - start) / (calls * elements), other = us(end - middle) / calls;
    best = std::min(best, own);
    best_yardstick = std::min(best_yardstick, other);
    ratios.push_back(own / other);
    run.SetIterationTime(1e-6 * us(end - start));
  }
  const auto mid = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), mid, ratios.end());
  run.counters["best_us"] = best;
  run.counters["yardstick_us"] = best_yardstick;
  run.counters["ratio"] = *mid;
}

}  // namespace railstep
