#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "support/wait.h"

namespace railstep {

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Folders of the test cases, which go when the process that made them ends.
struct Folders {
  std::set<std::filesystem::path> made;
  pid_t owner = getpid();

  ~Folders() {
    std::error_code ignored;
    if (getpid() == owner)
      for (const auto& folder : made) std::filesystem::remove_all(folder, ignored);
  }
};
inline Folders folders;

/// An empty folder for one test case.
inline std::filesystem::path fresh_folder(const std::string& name) {
  auto folder = std::filesystem::temp_directory_path() /
                ("railstep_" + std::to_string(getpid()) + "_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  folders.made.insert(folder);
  return folder;
}

inline std::size_t entries(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

struct Ran {
  int code;  // -1 if a signal ended the shell
  std::string out, err;
};

/// Runs a program with its words through the shell. A program that runs longer than a test waits is
/// killed and has code 124.
/// @param before  words of the shell in front of the program, such as "ulimit -f 8;"
inline Ran run_program(const std::string& program, const std::string& words,
                       const std::string& before = "") {
  const auto folder = fresh_folder("words");
  const std::string command =
      before + " timeout --kill-after=5 " + std::to_string(kPatience.count()) + " '" + program +
      "' >'" + (folder / "out").string() + "' 2>'" + (folder / "err").string() + "' " + words;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder / "out"),
          text_of(folder / "err")};
}

/// The real program with these words.
inline Ran railstep_program(const std::string& words) {
  return run_program(RAILSTEP_PROGRAM, words);
}

}  // namespace railstep
