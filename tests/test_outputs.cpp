#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "bad_input.h"

using namespace railstep;

namespace {

/// What a folder has beside files that are whole.
std::size_t parts_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    count += entry.path().extension() == ".part" ? 1u : 0u;
  return count;
}

const std::string kRun = "run " + shipped("moving_load") + " --duration 0.01 ";

}  // namespace

TEST_CASE("what has the name of a part is left alone", "[cli]") {
  const BadInput files("part");
  const std::string scene = files.file("x.csv.part", text_of(shipped("moving_load"))),
                    victim = files.file("victim", "precious\n"), trace = files.path("y.csv");
  CHECK(railstep_program("run " + scene + " --duration 0.01 --trace " + files.path("x.csv")).code ==
        0);
  CHECK(text_of(scene) == text_of(shipped("moving_load")));
  std::filesystem::create_symlink(victim, trace + ".part");
  CHECK(railstep_program(kRun + "--trace " + trace + " --record " + files.path("r")).code == 0);
  CHECK(text_of(victim) == "precious\n");
  CHECK_FALSE(std::filesystem::is_symlink(trace));
  CHECK(text_of(trace) == text_of(files.path("x.csv")));
  CHECK(std::filesystem::exists(files.path("r")));
  CHECK(parts_in(files.path("")) == 2);
}

TEST_CASE("runs with one trace at once leave that of one of them, whole", "[cli]") {
  const BadInput files("at_once");
  const std::vector<std::string> durations = {"0.3", "0.25", "0.2"};
  std::vector<std::string> alone;
  for (const std::string& duration : durations) {
    const std::string trace = files.path(duration);
    REQUIRE(railstep_program("run " + shipped("moving_load") + " --duration " + duration +
                             " --trace " + trace)
                .code == 0);
    alone.push_back(text_of(trace));
  }
  std::vector<int> codes(durations.size(), -1);
  std::vector<std::thread> runs;
  for (std::size_t i = 0; i < durations.size(); ++i)
    runs.emplace_back([&, i] {
      codes[i] =
          std::system(("'" RAILSTEP_PROGRAM "' run " + shipped("moving_load") + " --duration " +
                       durations[i] + " --trace " + files.path("t.csv") + " >/dev/null")
                          .c_str());
    });
  for (std::thread& run : runs) run.join();
  CHECK(codes == std::vector<int>{0, 0, 0});
  CHECK(std::count(alone.begin(), alone.end(), text_of(files.path("t.csv"))) == 1);
  CHECK(parts_in(files.path("")) == 0);
}
