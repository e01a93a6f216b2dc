#include "text/write.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "offline/math/refuse.h"
#include "text/files.h"

namespace railstep {
namespace {

/// Opens a file that was not there: what has the name already, a leftover, a user's file or a link,
/// is left alone, and the next name is tried.
int open_beside(const std::filesystem::path& file, std::filesystem::path& beside) {
  constexpr int kNames = 1000;
  for (int n = 0; n < kNames; ++n) {
    beside = file.string() + fmt::format(".{}-{}.part", getpid(), n);
    const int opened =
        open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (opened >= 0 || errno != EEXIST) return opened;
  }
  return -1;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)) {
  refuse_read_file(file_);
  // A device or a pipe (/dev/full, /dev/stdout) cannot be renamed over.
  std::error_code ignored;
  const bool in_place =
      std::filesystem::exists(file_, ignored) && !std::filesystem::is_regular_file(file_, ignored);
  const int opened =
      in_place ? open(file_.c_str(), O_WRONLY | O_CLOEXEC) : open_beside(file_, beside_);
  if (opened < 0) {
    beside_.clear();
    fail(errno);
  }
  out_ = fdopen(opened, "wb");
  if (out_ == nullptr) {
    const int reason = errno;
    close(opened);
    fail(reason);
  }
}

OutputFile::~OutputFile() { drop(); }

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size()) fail(errno);
}

void OutputFile::finish() {
  const int closed = std::fclose(std::exchange(out_, nullptr));
  if (closed != 0) fail(errno);  // a full disk may only show here
  if (!beside_.empty() && std::rename(beside_.c_str(), file_.c_str()) != 0) fail(errno);
  beside_.clear();
}

void OutputFile::drop() noexcept {
  if (out_ != nullptr) std::fclose(std::exchange(out_, nullptr));
  if (!beside_.empty()) unlink(beside_.c_str());
  beside_.clear();
}

void OutputFile::fail(int reason) {
  drop();
  railstep::fail("E-FILE-10", fmt::format("{}: the file cannot be written: {}", file_.string(),
                                          std::strerror(reason)));
}

void write_file(const std::filesystem::path& file, std::string_view content) {
  OutputFile out(file);
  out.write(content);
  out.finish();
}

}  // namespace railstep
