#include "contest.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace railstep {

namespace {

/// Processor time of the thread, us; time that other programs take is left out.
double computed_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// us per frame.
double timed(const std::function<double()>& frame, int frames) {
  volatile double seen = 0.;
  const double start = computed_us();
  for (int i = 0; i < frames; ++i) seen = frame();
  const double end = computed_us();
  static_cast<void>(seen);
  return (end - start) / frames;
}

/// Quantile of sorted values. @param q  0..1
double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - std::floor(at)) * (sorted[above] - sorted[below]);
}

void print_number(const char* format, double value) {
  std::printf(",");
  if (!std::isnan(value)) std::printf(format, value);
}

}  // namespace

void hold_contest(std::vector<Contestant>& all, int rounds) {
  std::vector<int> frames;
  for (const Contestant& c : all) {
    timed(c.frame, 20);  // warm
    const int enough = static_cast<int>(std::ceil(2000. / timed(c.frame, 20)));
    frames.push_back(c.passage > 0 ? c.passage : std::max(20, enough));
  }
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i].us.push_back(timed(all[i].frame, frames[i]));
}

void print_head() {
  std::printf(
      "peer,scene,elements,step_s,us_per_ms,error,reference_error,us_low,us_high,unknowns,"
      "flops_per_ms,error_from_start\n");
}

void print_rows(const std::vector<Contestant>& all) {
  for (const Contestant& c : all) {
    std::vector<double> us = c.us;
    std::sort(us.begin(), us.end());
    std::printf("%s,%s,%d", c.peer.c_str(), c.scene.c_str(), c.elements);
    print_number("%g", c.step > 0. ? c.step : std::nan(""));
    print_number("%.3g", quantile(us, .5));
    print_number("%.2e", c.error);
    print_number("%.1e", c.reference_error);
    print_number("%.3g", quantile(us, .25));
    print_number("%.3g", quantile(us, .75));
    std::printf(",%d", c.unknowns);
    print_number("%.0f", c.flops);
    print_number("%.2e", c.error_from_start);
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace railstep
