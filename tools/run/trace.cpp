#include "run/trace.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace railstep {

Trace::Trace(std::filesystem::path file, const std::vector<std::string>& columns)
    : out_(std::move(file)) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + column;
  out_.write(line + '\n');
}

void Trace::row(std::span<const double> values) {
  fmt::memory_buffer line;
  for (std::size_t i = 0; i < values.size(); ++i)
    fmt::format_to(std::back_inserter(line), "{}{:.17g}", i == 0 ? "" : ",", values[i]);
  line.push_back('\n');
  out_.write({line.data(), line.size()});
}

}  // namespace railstep
