#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "hil/hil_latency.h"
#include "report/hil_report.h"

using namespace railstep;
using Catch::Contains;

namespace {

/// Samples from 20 ns to beyond the last bin; most of them are short.
std::vector<std::int64_t> samples(std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> exponent(3.5, 1.3);
  std::vector<std::int64_t> ns(count);
  for (std::int64_t& each : ns) each = std::llround(std::pow(10., exponent(random)));
  ns.back() = 3'000'000'000;
  return ns;
}

}  // namespace

TEST_CASE("quantiles are those of the sorted samples up to the width of a bin", "[hil]") {
  std::vector<std::int64_t> ns = samples(100'001);
  Latency times;
  for (const std::int64_t each : ns) times.add(each);
  std::sort(ns.begin(), ns.end());
  for (const double q : {1e-9, .01, .5, .9, .99, .999, .9999, .99999, 1.}) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(ns.size())));
    const std::int64_t exact = ns[rank - 1];
    const double width = exact < Latency::kFineEnd ? .01 : exact < Latency::kCoarseEnd ? 1. : 3e6;
    CAPTURE(q, exact);
    // The bounds allow for the rounding of a decimal.
    CHECK(times.quantile_us(q) >= 1e-3 * static_cast<double>(exact) - 1e-9);
    CHECK(times.quantile_us(q) <= 1e-3 * static_cast<double>(exact) + width + 1e-9);
  }
  CHECK(times.quantile_us(1.) == 3e6);
  CHECK(times.count() == 100'001);
}

TEST_CASE("bins of 1 us hold the samples that begin with that microsecond", "[hil]") {
  const std::vector<std::int64_t> ns = samples(20'000);
  Latency times;
  std::vector<std::int64_t> naive(Latency::kCoarseEnd / 1000 + 1, 0);
  for (const std::int64_t each : ns) {
    times.add(each);
    ++naive[std::min(static_cast<std::size_t>(each / 1000), naive.size() - 1)];
  }
  CHECK(times.microseconds() == naive);
}

TEST_CASE("borders of bins, no samples and negative samples are counted", "[hil]") {
  Latency times;
  CHECK(std::isnan(times.quantile_us(.5)));
  times.add(-5);
  CHECK(times.quantile_us(1.) == 0.);
  for (const std::int64_t ns :
       {Latency::kFineEnd - 1, Latency::kFineEnd, Latency::kCoarseEnd - 1, Latency::kCoarseEnd})
    times.add(ns);
  const auto bins = times.microseconds();
  CHECK(bins[0] == 1);
  CHECK(bins[999] == 1);
  CHECK(bins[1000] == 1);
  CHECK(bins[bins.size() - 2] == 1);
  CHECK(bins.back() == 1);
}

TEST_CASE("a histogram has one bar for each bin that is not empty", "[hil]") {
  Latency times, empty;
  for (const std::int64_t ns : {500, 700, 4'200, 4'900, 4'999, 77'000, 5'000'000}) times.add(ns);
  const std::string svg = histogram_svg({{"frame", &times}, {"<nothing>", &empty}});
  CHECK(std::count(svg.begin(), svg.end(), 'Z') == 4);
  CHECK_THAT(svg, Contains("&lt;nothing"));
  CHECK_THAT(svg, Contains("bins of 1 us"));
}
