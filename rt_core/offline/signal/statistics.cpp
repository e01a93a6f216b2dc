#include "offline/signal/statistics.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

namespace railstep {
namespace {

/// Integral over the distance from the first sample to each, by a rule over two samples.
template <typename Rule>
std::vector<double> integral_over(const std::vector<double>& distance,
                                  const std::vector<double>& values, Rule mean) {
  std::vector<double> sum(values.size(), 0.);
  for (std::size_t i = 1; i < values.size(); ++i)
    sum[i] = sum[i - 1] + (distance[i] - distance[i - 1]) * mean(values[i - 1], values[i]);
  return sum;
}

/// Means over windows of what `mean` is of a part of a straight line between two values.
template <typename Rule>
std::vector<double> window_means(const std::vector<double>& distance,
                                 const std::vector<double>& values, double length, double step,
                                 Rule mean) {
  std::vector<double> means;
  if (values.size() < 2) return means;
  const std::vector<double> sum = integral_over(distance, values, mean);
  const auto integral_to = [&](double at) {
    const auto next = std::upper_bound(distance.begin() + 1, distance.end() - 1, at);
    const auto i = static_cast<std::size_t>(next - distance.begin());
    const double part = (at - distance[i - 1]) / (distance[i] - distance[i - 1]),
                 value = values[i - 1] + part * (values[i] - values[i - 1]);
    return sum[i - 1] + (at - distance[i - 1]) * mean(values[i - 1], value);
  };
  const double first = distance.front(), slack = 1e-9 * length;
  for (int k = 0; first + step * k + length <= distance.back() + slack; ++k) {
    const double from = first + step * k, to = std::min(from + length, distance.back());
    means.push_back((integral_to(to) - integral_to(from)) / length);
  }
  return means;
}

constexpr double kBetweenLines = .05;  // Hz

std::vector<double> hann_window(std::size_t count) {
  std::vector<double> window(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double part = (static_cast<double>(i) + .5) / static_cast<double>(count);
    window[i] = .5 - .5 * std::cos(2. * std::numbers::pi * part);
  }
  return window;
}

/// Power of a line at `angle` a sample, over blocks of the window's length. The first and the last
/// block are at the ends, and neighbours overlap by half or more.
double line_power(const std::vector<double>& values, double mean, const std::vector<double>& window,
                  double angle) {
  const std::complex<double> turn = std::polar(1., angle);
  const std::size_t room = values.size() - window.size(), hop = window.size() / 2;
  const std::size_t hops = (room + hop - 1) / hop;
  double power = 0.;
  for (std::size_t block = 0; block <= hops; ++block) {
    const std::size_t first = hops == 0 ? 0 : room * block / hops;
    std::complex<double> sum = 0.;
    for (std::size_t i = 0; i < window.size(); ++i)
      sum = sum * turn + window[i] * (values[first + i] - mean);
    power += std::norm(sum);
  }
  return power;
}

}  // namespace

std::vector<double> sliding_mean(const std::vector<double>& distance,
                                 const std::vector<double>& values, double length, double step) {
  return window_means(distance, values, length, step,
                      [](double a, double b) { return .5 * (a + b); });
}

std::vector<double> sliding_rms(const std::vector<double>& distance,
                                const std::vector<double>& values, double length, double step) {
  std::vector<double> roots = window_means(distance, values, length, step, [](double a, double b) {
    return (a * a + a * b + b * b) / 3.;
  });
  for (double& root : roots) root = std::sqrt(std::max(0., root));
  return roots;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

double rms_of(const std::vector<double>& values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.) /
                   static_cast<double>(values.size()));
}

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = part * static_cast<double>(values.size() - 1), below = std::floor(at);
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), low, values.end());
  if (low + 1 == values.end()) return *low;
  return *low + (at - below) * (*std::min_element(low + 1, values.end()) - *low);
}

std::vector<double> block_rms(const std::vector<double>& values, double dt, double seconds) {
  const auto block = static_cast<std::size_t>(std::max(1., std::round(seconds / dt)));
  std::vector<double> roots;
  for (std::size_t first = 0; first + block <= values.size(); first += block) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(first);
    roots.push_back(rms_of({from, from + static_cast<std::ptrdiff_t>(block)}));
  }
  return roots;
}

double dominant_frequency(const std::vector<double>& values, double dt, double from_hz,
                          double to_hz) {
  double found = std::numeric_limits<double>::quiet_NaN(), most = 0., mean = 0.;
  const std::size_t n = values.size();
  if (n < 3) return found;
  for (const double value : values) mean += value / static_cast<double>(n);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (!(*high - *low > 1e-9 * std::fabs(mean))) return found;
  // The lines of a longer block are narrower than the grid, and a tone could lie between two.
  const double longest = std::max(3., std::round(1. / (kBetweenLines * dt)));
  const std::vector<double> window =
      hann_window(static_cast<std::size_t>(std::min(longest, static_cast<double>(n))));
  const double last = std::min(to_hz, .5 / dt) + 1e-9 * kBetweenLines;
  for (int k = 0; from_hz + kBetweenLines * k <= last; ++k) {
    const double hz = from_hz + kBetweenLines * k;
    const double power = line_power(values, mean, window, 2. * std::numbers::pi * hz * dt);
    if (!(power > most)) continue;
    most = power;
    found = hz;
  }
  return found;
}

}  // namespace railstep
