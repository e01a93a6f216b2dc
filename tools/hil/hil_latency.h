#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace railstep {

/// Counts how often each time was met. The constructor takes and touches all memory: add() does
/// neither, and takes the same few instructions for any time.
///
/// Bins of 10 ns below 1 ms, of 1 us from there to 100 ms, and one for all that is longer.
class Latency {
 public:
  static constexpr std::int64_t kFine = 10, kFineEnd = 1'000'000;           // ns
  static constexpr std::int64_t kCoarse = 1'000, kCoarseEnd = 100'000'000;  // ns

  Latency();
  /// @param ns  below 0 counts as 0
  void add(std::int64_t ns) noexcept;

  std::int64_t count() const noexcept { return count_; }
  /// The smallest time that a part q (0 to 1) of the samples does not exceed, us: the upper end of
  /// the bin of that sample, so at most a bin's width over it and never under it; of the last bin,
  /// and of q = 1, the longest sample itself. NaN without samples.
  double quantile_us(double q) const;
  /// Samples of each whole microsecond, [0, 1) us first; the last entry has all from kCoarseEnd on.
  std::vector<std::int64_t> microseconds() const;

 private:
  static std::size_t bin(std::int64_t ns) noexcept;
  static std::int64_t upper_end(std::size_t bin) noexcept;  // ns

  std::vector<std::int64_t> samples_;  // [bins + 1]
  std::int64_t count_ = 0, longest_ = 0;
};

}  // namespace railstep
