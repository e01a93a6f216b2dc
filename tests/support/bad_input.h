#pragma once
#include <fmt/core.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"
#include "support/shipped.h"

namespace railstep {

/// A folder with files from before the program ran: inputs, and outputs of an earlier run.
class BadInput {
 public:
  explicit BadInput(const std::string& name) : folder_(fresh_folder("bad_" + name)) {}
  BadInput(const BadInput&) = delete;
  BadInput& operator=(const BadInput&) = delete;
  ~BadInput() { std::filesystem::remove_all(folder_); }

  /// Writes a file byte for byte and returns its full name.
  std::string file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  /// An option and its output file, which an earlier run has already written.
  std::string old(const std::string& option, const std::string& name) const {
    return " " + option + " " + file(name, "of an earlier run\n");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Names and bytes of the files in the folder.
  std::map<std::string, std::string> content() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      all[entry.path().filename().string()] =
          entry.is_regular_file() ? text_of(entry.path()) : "no file";
    return all;
  }

  /// Checks that the program ends with this code, one sentence a line on stderr with all these
  /// words and nothing on stdout but errors as JSON, and that it leaves the files in the folder as
  /// they were and adds none.
  void refused(const std::string& words, const std::vector<std::string>& said, int code = 2) const {
    const auto before = content();
    const Ran ran = railstep_program(words);
    CAPTURE(words.substr(0, 500), ran.err, ran.out);
    CHECK(ran.code == code);
    const bool json = words.find("--json") != std::string::npos;
    CHECK((ran.out.empty() || (json && ran.out.substr(0, 13) == "{\n  \"errors\":")));
    std::istringstream lines(ran.err);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
      CHECK(line.substr(0, 7) == "error: ");
      CHECK(line.size() < 800);
    }
    CHECK(count > 0);
    CHECK(count <= 11);
    for (const std::string& each : said) CHECK_THAT(ran.err, Catch::Contains(each));
    CHECK(content() == before);
  }

 private:
  std::filesystem::path folder_;
};

/// A text with one piece of it replaced, which must be there.
inline std::string replaced(std::string text, const std::string& old, const std::string& fresh) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), fresh);
}

}  // namespace railstep
