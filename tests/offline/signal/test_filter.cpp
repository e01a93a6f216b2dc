// Analogue filters and statistics of sampled signals against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "offline/signal/filter.h"
#include "offline/signal/statistics.h"
#include "online/math/pi.h"

using namespace railstep;

namespace {

using Complex = std::complex<double>;

std::vector<double> sampled(double (*signal)(double), double dt, int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = signal(dt * i);
  return values;
}

double sine_of_7_hz(double t) { return std::sin(14. * kPi * t); }

/// Largest difference from a filter's steady answer to that sine, after ten seconds, when the start
/// is gone.
double error_of(const AnalogueFilter& filter, double dt) {
  const int count = static_cast<int>(std::lround(12. / dt));
  const std::vector<double> found = filtered(filter, sampled(sine_of_7_hz, dt, count), dt);
  const Complex h = response(filter, 7.);
  double error = 0.;
  for (int i = 5 * count / 6; i < count; ++i)
    error = std::max(error, std::fabs(found[static_cast<std::size_t>(i)] -
                                      std::abs(h) * std::sin(14. * kPi * dt * i + std::arg(h))));
  return error;
}

}  // namespace

TEST_CASE("Butterworth's filters have their sizes", "[filter]") {
  for (const double hz : {.1, 1., 7., 20., 55., 300.}) {
    const double ratio = std::pow(hz / 20., 8);
    CHECK(std::abs(response(low_pass(20.), hz)) ==
          Approx(1. / std::sqrt(1. + ratio)).epsilon(1e-12));
    CHECK(std::abs(response(high_pass(20.), hz)) ==
          Approx(std::sqrt(ratio / (1. + ratio))).epsilon(1e-12));
    CHECK(std::abs(response(band_pass(2., 20.), hz)) ==
          Approx(std::sqrt(std::pow(hz / 2., 8) / (1. + std::pow(hz / 2., 8)) / (1. + ratio)))
              .epsilon(1e-12));
  }
}

TEST_CASE("weightings of ride have the sizes of their formulas", "[filter]") {
  for (const double f : {.3, .5, 1., 2., 5., 6.3, 16., 60.}) {
    const auto second = [&](double corner, double quality) {
      const double x = f / corner;
      return std::hypot(1. - x * x, x / quality);
    };
    const double band = f * f / (.16 * second(.4, std::sqrt(.5)) * second(100., std::sqrt(.5)));
    CHECK(std::abs(response(comfort_lateral(), f)) ==
          Approx(band * std::hypot(1., f / 2.) / second(2., .63)).epsilon(1e-12));
    CHECK(std::abs(response(comfort_vertical(), f)) ==
          Approx(.4 * band * std::hypot(1., f / 16.) / second(16., .63) * second(2.5, .8) /
                 second(4., .8))
              .epsilon(1e-12));
    const double size =
        std::sqrt((1.911 * f * f + std::pow(.25 * f * f, 2)) /
                  (std::pow(1. - .277 * f * f, 2) + std::pow(1.563 * f - .0368 * f * f * f, 2)));
    CHECK(std::abs(response(ride_index_lateral(), f)) == Approx(.737 * size).epsilon(1e-12));
    CHECK(std::abs(response(ride_index_vertical(), f)) == Approx(.588 * size).epsilon(1e-12));
  }
  // Upwards the body is most sensitive from 5 to 16 Hz, across below 2 Hz (EN 12299).
  CHECK(std::abs(response(comfort_vertical(), 8.)) >
        2. * std::abs(response(comfort_vertical(), 1.)));
  CHECK(std::abs(response(comfort_lateral(), 1.)) >
        4. * std::abs(response(comfort_lateral(), 10.)));
  // ISO 2631-1:1997 prints W_d for third octaves, to three digits of their nominal frequencies.
  for (const auto& [hz, printed] :
       {std::pair(.5, .853), {1., 1.011}, {2., .89}, {4., .512}, {8., .253}, {16., .125}})
    CHECK(std::abs(response(comfort_lateral(), hz)) == Approx(printed).margin(1.5e-3));
  // Routh: the denominator of third order is stable.
  CHECK(1.563 * .277 > .0368);
}

TEST_CASE("a filter answers straight lines between samples without error", "[filter]") {
  // 1 / (1 + 2 z s/w + s^2/w^2) under a ramp from rest: t - 2 z/w and a decaying wave, whatever the
  // samples.
  const double w = 3., z = .4, d = std::sqrt(1. - z * z), a = 2. * z / w;
  const AnalogueFilter filter = {{{1.}, {1., a, 1. / (w * w)}}};
  const auto ramp = [&](double t) {
    const double decays = std::exp(-z * w * t), turn = w * d * t;
    return t - a + decays * (a * std::cos(turn) + (2. * z * z - 1.) / (w * d) * std::sin(turn));
  };
  for (const double dt : {.05, .4, 1.7}) {
    std::vector<double> values(20);
    for (int i = 0; i < 20; ++i) values[static_cast<std::size_t>(i)] = dt * i;
    const std::vector<double> found = filtered(filter, values, dt);
    for (int i = 0; i < 20; ++i)
      CHECK(found[static_cast<std::size_t>(i)] == Approx(ramp(dt * i)).margin(1e-12));
    // A corner: the ramp stops after ten samples.
    for (int i = 10; i < 20; ++i) values[static_cast<std::size_t>(i)] = dt * 10;
    CHECK(filtered(filter, values, dt).back() ==
          Approx(ramp(dt * 19) - ramp(dt * 9)).margin(1e-11));
  }
}

TEST_CASE("filtered waves converge to the response by the second order", "[filter]") {
  for (const AnalogueFilter& filter : {low_pass(20.), band_pass(4., 10.), comfort_lateral(),
                                       comfort_vertical(), ride_index_lateral()}) {
    const double coarse = error_of(filter, 2e-3), fine = error_of(filter, 1e-3);
    CHECK(fine < 2e-3);
    CHECK(coarse / fine == Approx(4.).epsilon(.05));
  }
}

TEST_CASE("a filter of a sum is the sum of the filtered", "[filter]") {
  const std::vector<double> a = {1., -2., .5, 4., 0., 3.}, b = {-3., 1., 1., 2., 7., -5.};
  std::vector<double> sum(6);
  for (std::size_t i = 0; i < 6; ++i) sum[i] = 2. * a[i] - 3. * b[i];
  const AnalogueFilter filter = comfort_vertical();
  const std::vector<double> of_a = filtered(filter, a, .02), of_b = filtered(filter, b, .02),
                            of_sum = filtered(filter, sum, .02);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(of_sum[i] == Approx(2. * of_a[i] - 3. * of_b[i]).margin(1e-13));
}

TEST_CASE("filters begin under a value that has lasted", "[filter]") {
  const std::vector<double> still(50, 3.);
  for (const double value : filtered(low_pass(5.), still, 1e-3)) CHECK(value == Approx(3.));
  for (const double value : filtered(band_pass(.4, 10.), still, 1e-3))
    CHECK(std::fabs(value) < 1e-12);
  CHECK(filtered(low_pass(5.), {}, 1e-3).empty());
}

TEST_CASE("windows slide over straight lines", "[statistics]") {
  const std::vector<double> distance = {0., .7, 1., 2.5, 4., 4.1, 6.};
  std::vector<double> line, bent;
  for (const double x : distance) {
    line.push_back(2. + 3. * x);
    bent.push_back(std::fabs(x - 2.5));
  }
  const std::vector<double> means = sliding_mean(distance, line, 2., .5),
                            roots = sliding_rms(distance, line, 2., .5);
  REQUIRE(means.size() == 9);
  for (int k = 0; k < 9; ++k) {
    const double middle = 2. + 3. * (.5 * k + 1.);
    CHECK(means[static_cast<std::size_t>(k)] == Approx(middle).epsilon(1e-13));
    CHECK(roots[static_cast<std::size_t>(k)] ==
          Approx(std::sqrt(middle * middle + 3.)).epsilon(1e-13));
  }
  // The window from 1.5 to 3.5 m has the corner in its middle.
  CHECK(sliding_mean(distance, bent, 2., .5)[3] == Approx(.5).epsilon(1e-13));
  CHECK(sliding_rms(distance, bent, 2., .5)[3] == Approx(std::sqrt(1. / 3.)).epsilon(1e-13));
  CHECK(sliding_mean(distance, line, 6., .5).size() == 1);
  CHECK(sliding_mean(distance, line, 6.1, .5).empty());
  CHECK(sliding_mean({1.}, {1.}, 2., .5).empty());
}

TEST_CASE("percentiles, blocks and lines", "[statistics]") {
  CHECK(percentile({4., 1., 3., 2., 5.}, .5) == 3.);
  CHECK(percentile({4., 1., 3., 2., 5.}, 0.) == 1.);
  CHECK(percentile({4., 1., 3., 2., 5.}, 1.) == 5.);
  CHECK(percentile({4., 1., 3., 2.}, .5) == 2.5);
  CHECK(percentile({4., 1., 3., 2., 5.}, .9) == Approx(4.6));
  CHECK(percentile({7.}, .3) == 7.);
  CHECK(std::isnan(percentile({}, .5)));
  CHECK(mean_of({1., -2., 4.}) == 1.);
  CHECK(rms_of({1., -2., 2.}) == Approx(std::sqrt(3.)));
  const std::vector<double> wave = sampled(sine_of_7_hz, 1e-3, 2500);
  const std::vector<double> blocks = block_rms(wave, 1e-3, 1.);
  REQUIRE(blocks.size() == 2);
  for (const double block : blocks) CHECK(block == Approx(std::sqrt(.5)).epsilon(1e-12));
  const auto tones = [](double t) {
    return 40. + 2. * std::sin(2. * kPi * 3.35 * t) + std::sin(2. * kPi * 6. * t + 1.);
  };
  const std::vector<double> both = sampled(tones, 2e-3, 5000);
  CHECK(dominant_frequency(both, 2e-3, 1., 10.) == Approx(3.35));
  CHECK(dominant_frequency(both, 2e-3, 5., 10.) == Approx(6.));
  CHECK(std::isnan(dominant_frequency(std::vector<double>(100, 5.), 2e-3, 1., 10.)));
  CHECK(std::isnan(dominant_frequency({1., 2.}, 2e-3, 1., 10.)));
  // In a long record a pure tone between two lines of the grid is not lost, wherever it lies.
  for (const double hz : {3.35, 3.36, 3.37, 3.375, 3.39}) {
    std::vector<double> lone(100000);
    for (std::size_t i = 0; i < lone.size(); ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      lone[i] = 1e4 + std::sin(2. * kPi * hz * t) + .1 * std::sin(2. * kPi * 8. * t);
    }
    CHECK(std::fabs(dominant_frequency(lone, 1e-3, 1., 10.) - hz) < .026);
  }
  // Above half the sampling rate are mirrored lines.
  CHECK(dominant_frequency(sampled(sine_of_7_hz, .05, 400), .05, 1., 19.) == Approx(7.));
}
