#pragma once
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace railstep {

/// A trace as it grows: CSV, 17 significant digits. It is written beside its place and renamed into
/// it by `finish`, so that a reader never sees half a trace.
class Trace {
 public:
  /// Opens the file and writes the header. Throws std::runtime_error naming file and reason.
  Trace(std::filesystem::path file, const std::vector<std::string>& columns);
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  ~Trace();  // an unfinished trace leaves nothing behind

  void row(std::span<const double> values);
  /// Closes and puts the trace in its place. Throws as the constructor.
  void finish();

 private:
  [[noreturn]] void fail(int reason);

  std::filesystem::path file_, beside_;
  std::FILE* out_;
};

}  // namespace railstep
