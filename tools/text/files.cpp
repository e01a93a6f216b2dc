#include "text/files.h"

#include <fmt/core.h>

#include <map>
#include <mutex>
#include <set>
#include <system_error>

#include "text/read.h"

namespace railstep {
namespace {

struct Files {
  std::mutex lock;
  std::map<std::filesystem::path, std::string> written;  // and by which option
  std::set<std::filesystem::path> read;
};

Files& files() {
  static Files all;
  return all;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;  // a file that is not there is not the same
  return std::filesystem::is_regular_file(a, ignored) && std::filesystem::equivalent(a, b, ignored);
}

[[noreturn]] void refuse(const std::string& written, const std::filesystem::path& read) {
  throw InputError("E-FILE-01", fmt::format("{}: this output would replace {}, which the command "
                                            "reads; expected another name for the output",
                                            written, read.string()));
}

}  // namespace

void announce_output(const std::string& option, const std::filesystem::path& file) {
  const std::lock_guard<std::mutex> hold(files().lock);
  files().written.insert_or_assign(file, option);
}

void note_read_file(const std::filesystem::path& file) {
  const std::lock_guard<std::mutex> hold(files().lock);
  for (const auto& [output, option] : files().written)
    if (same_file(output, file)) refuse(fmt::format("{} {}", option, output.string()), file);
  files().read.insert(file);
}

void refuse_read_file(const std::filesystem::path& file) {
  const std::lock_guard<std::mutex> hold(files().lock);
  for (const std::filesystem::path& read : files().read)
    if (same_file(file, read)) refuse(file.string(), read);
}

}  // namespace railstep
