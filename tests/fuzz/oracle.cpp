#include "oracle.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace railstep::fuzz {
namespace {

/// Made once; removed with all its files.
struct Folder {
  std::filesystem::path root, scenes;

  Folder() {
    const std::filesystem::path memory = "/dev/shm";
    std::error_code none;
    const bool there = std::filesystem::is_directory(memory, none);
    root = (there ? memory : std::filesystem::temp_directory_path()) /
           ("railstep-fuzz-" + std::to_string(getpid()));
    scenes = root / "scenes";
    std::filesystem::create_directories(scenes);
    const std::filesystem::path config = std::filesystem::path(RAILSTEP_SOURCE) / "config";
    for (const char* const shipped : {"profiles", "vehicles"})
      std::filesystem::create_directory_symlink(config / shipped, root / shipped, none);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(root, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

}  // namespace

void fail(const char* what) {
  std::fprintf(stderr, "\noracle: %s\n", what);
  std::abort();
}

void check_sentence(const std::string& text) {
  check(!text.empty(), "a refusal says nothing");
  check(text.find('\n') == std::string::npos, "a refusal takes more than one line");
}

const std::filesystem::path& folder() {
  static const Folder made;
  return made.scenes;
}

std::filesystem::path written(const std::string& name, std::string_view bytes) {
  std::filesystem::path file = folder() / name;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) fail("the fuzzer's own file cannot be written");
  return file;
}

}  // namespace railstep::fuzz
