#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "text/write.h"

namespace railstep {

/// A trace as it grows: CSV, 17 significant digits.
class Trace {
 public:
  /// Opens the file and writes the header. Throws as OutputFile does, which leaves nothing behind
  /// where the trace is not finished.
  Trace(std::filesystem::path file, const std::vector<std::string>& columns);

  void row(std::span<const double> values);
  /// Closes and puts the trace in its place.
  void finish() { out_.finish(); }

 private:
  OutputFile out_;
};

}  // namespace railstep
