#pragma once
#include <cstdint>

namespace railstep {

/// A bar on stderr, when that is a terminal; moves once a percent, and is wiped at its end.
class Progress {
 public:
  explicit Progress(std::int64_t all);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  void operator()(std::int64_t done);

 private:
  std::int64_t all_;
  bool shown_;
  int percent_ = -1;
};

}  // namespace railstep
