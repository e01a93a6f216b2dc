#include "hil/hil_latency.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railstep {
namespace {

constexpr std::size_t kFineBins = Latency::kFineEnd / Latency::kFine;
constexpr std::size_t kCoarseBins = (Latency::kCoarseEnd - Latency::kFineEnd) / Latency::kCoarse;
constexpr std::size_t kLast = kFineBins + kCoarseBins;

}  // namespace

Latency::Latency() : samples_(kLast + 1, 0) {}

std::size_t Latency::bin(std::int64_t ns) noexcept {
  if (ns < kFineEnd) return static_cast<std::size_t>(ns / kFine);
  if (ns < kCoarseEnd) return kFineBins + static_cast<std::size_t>((ns - kFineEnd) / kCoarse);
  return kLast;
}

std::int64_t Latency::upper_end(std::size_t bin) noexcept {
  if (bin < kFineBins) return static_cast<std::int64_t>(bin + 1) * kFine;
  return kFineEnd + static_cast<std::int64_t>(bin - kFineBins + 1) * kCoarse;
}

void Latency::add(std::int64_t ns) noexcept {
  const std::int64_t time = std::max(ns, std::int64_t{0});
  ++samples_[bin(time)];
  ++count_;
  longest_ = std::max(longest_, time);
}

double Latency::quantile_us(double q) const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(q * static_cast<double>(count_));
  const auto wanted = std::clamp(static_cast<std::int64_t>(rank), std::int64_t{1}, count_);
  std::int64_t found = 0;
  for (std::size_t i = 0; i < kLast; ++i) {
    found += samples_[i];
    if (found >= wanted) return static_cast<double>(std::min(upper_end(i), longest_)) / 1e3;
  }
  return static_cast<double>(longest_) / 1e3;
}

std::vector<std::int64_t> Latency::microseconds() const {
  std::vector<std::int64_t> sums(kCoarseEnd / 1000 + 1, 0);
  for (std::size_t i = 0; i < kLast; ++i)
    sums[static_cast<std::size_t>((upper_end(i) - 1) / 1000)] += samples_[i];
  sums.back() += samples_[kLast];
  return sums;
}

}  // namespace railstep
