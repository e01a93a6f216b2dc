#include "trace.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace railstep {
namespace {

/// Where to write first. A device or a pipe cannot be renamed over: into it at once.
std::filesystem::path beside(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored))
    return file;
  return file.string() + ".part";
}

}  // namespace

Trace::Trace(std::filesystem::path file, const std::vector<std::string>& columns)
    : file_(std::move(file)), beside_(beside(file_)), out_(std::fopen(beside_.c_str(), "wb")) {
  if (!out_) fail(errno);
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + column;
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), out_);
}

Trace::~Trace() {
  if (!out_) return;
  std::fclose(out_);
  if (beside_ != file_) std::remove(beside_.c_str());
}

void Trace::row(std::span<const double> values) {
  fmt::memory_buffer line;
  for (std::size_t i = 0; i < values.size(); ++i)
    fmt::format_to(std::back_inserter(line), "{}{:.17g}", i == 0 ? "" : ",", values[i]);
  line.push_back('\n');
  if (std::fwrite(line.data(), 1, line.size(), out_) != line.size()) fail(errno);
}

void Trace::finish() {
  const bool bad = std::ferror(out_) != 0;
  const int closed = std::fclose(out_);
  out_ = nullptr;
  if (bad || closed != 0) fail(errno);  // a full disk may only show here
  if (beside_ != file_ && std::rename(beside_.c_str(), file_.c_str()) != 0) fail(errno);
}

void Trace::fail(int reason) {
  if (out_) std::fclose(out_);
  out_ = nullptr;
  if (beside_ != file_) std::remove(beside_.c_str());
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(reason)));
}

}  // namespace railstep
