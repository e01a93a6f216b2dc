#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace railstep {

inline constexpr std::int64_t kMostRuns = 1'000'000;

/// A key of a scene and the values that a sweep gives it, as written.
struct VariedKey {
  std::string key;
  std::vector<std::string> values;
};

/// Reads "key.path=a,b,c". A comma within brackets, braces or quotes belongs to its value. Throws
/// InputError.
VariedKey read_varied(const std::string& option);

/// All combinations of the values of some keys, in order: the last key's value changes fastest.
class Grid {
 public:
  /// @param set   "key=value" for all runs
  /// @param vary  "key=a,b,c" each. Throws InputError, also for more than kMostRuns combinations
  ///              and for a key that would write over what stands before it.
  Grid(std::vector<std::string> set, const std::vector<std::string>& vary);

  std::int64_t runs() const { return runs_; }
  const std::vector<VariedKey>& varied() const { return varied_; }
  /// The values of a run, key by key.
  std::vector<std::string> values(std::int64_t run) const;
  /// "key=value" of what is varied in a run.
  std::vector<std::string> changes(std::int64_t run) const;
  /// "key=value" of a run: what is set, then what is varied.
  std::vector<std::string> overrides(std::int64_t run) const;
  /// "track.bays=24, step.dt_s=1e-4"
  std::string words(std::int64_t run) const;

 private:
  std::vector<std::string> set_;
  std::vector<VariedKey> varied_;
  std::int64_t runs_ = 1;
};

/// Every `of`-th run from the number-th on, which counts from 1; all of them by default.
struct Shard {
  std::int64_t number = 1, of = 1;
  bool whole() const { return of == 1; }
  std::vector<std::int64_t> runs(std::int64_t all) const;
};

/// Reads "I/N", 1/N to N/N; 0/N is N/N, so that numbers from 0 to N - 1 make all shards too. Throws
/// InputError.
Shard read_shard(const std::string& text);

}  // namespace railstep
