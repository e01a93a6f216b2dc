#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "support/bad_input.h"

using namespace railstep;

namespace {

const std::string kConfig = std::string(RAILSTEP_SOURCE) + "/config/";

/// A scene that reads a profile, a vehicle and an irregularity of its own folder. The links are
/// other names of the profile.
struct ReadingScene {
  explicit ReadingScene(const BadInput& folder)
      : scene(folder.file("scene.toml", text())),
        profile(folder.file("p.toml", text_of(kConfig + "profiles/60e1.toml"))),
        vehicle(folder.file("v.toml", text_of(kConfig + "vehicles/manchester_bogie.toml"))),
        irregularity(folder.file("i.csv", "distance_m,vertical_mm\n0,0\n100,0\n200,0\n300,0\n")),
        link(folder.path("link.toml")),
        hard_link(folder.path("hard_link.toml")) {
    std::filesystem::create_symlink(profile, link);
    std::filesystem::create_hard_link(profile, hard_link);
  }

  std::string scene, profile, vehicle, irregularity, link, hard_link;

 private:
  static std::string text() {
    std::string made = text_of(shipped("bogie_at_speed"));
    made = replaced(made, "../profiles/60e1.toml", "p.toml");
    made = replaced(made, "../vehicles/manchester_bogie.toml", "v.toml");
    return made + "\n[irregularity]\nfile = \"i.csv\"\n";
  }
};

/// Number of unfinished output files in a folder.
std::size_t parts_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    count += entry.path().extension() == ".part" ? 1u : 0u;
  return count;
}

const std::string kRun = "run " + shipped("moving_load") + " --duration 0.01 ";

}  // namespace

TEST_CASE("no output replaces a file that the scene reads", "[bad_input][cli]") {
  const BadInput bad("read");
  const ReadingScene made(bad);
  REQUIRE(railstep_program("run " + made.scene + " --duration 0.001").code == 0);
  for (const std::string& file :
       {made.profile, made.vehicle, made.irregularity, made.link, made.hard_link})
    bad.refused("run " + made.scene + " --duration 0.001 --trace " + file,
                {"--trace " + file + ": this output would replace", "which the command reads"});
  const std::string section = bad.file("s.toml", "");
  REQUIRE(railstep_program("fit " + made.profile + " --out " + section).code == 0);
  const std::string fitted = bad.file(
      "fitted.toml", replaced(text_of(made.scene), "profile = \"p.toml\"", "section = \"s.toml\""));
  bad.refused("run " + fitted + " --duration 0.001 --trace " + section, {"--trace", "s.toml"});
}

TEST_CASE("no output of any command replaces a file that the scene reads", "[bad_input][cli]") {
  const BadInput bad("every");
  const ReadingScene made(bad);
  const std::string& scene = made.scene;
  const std::string paced = "hil " + scene + " --rate 100 --duration 0.1 ",
                    out = "condense " + scene + " --skip-errors --out ",
                    receptance = "receptance " + scene + " --at s --from 10 --to-hz 100 ";
  for (const std::string& words :
       {"run " + scene + " --record", "run " + scene + " --report", paced + "--names",
        paced + "--record", paced + "--report", out.substr(0, out.size() - 1),
        out + bad.path("x.model") + " --emit-c", "static " + scene + " --shape",
        receptance + "--csv", receptance + "--report", "pareto " + scene + " --csv",
        "pareto " + scene + " --report", "pareto " + scene + " --resume",
        "tune " + scene + " --max-error 1e-3 --out"})
    bad.refused(words + " " + made.profile,
                {words.substr(words.rfind("--")) + " " + made.profile, "which the command reads"});
}

TEST_CASE("outputs whose names the program chooses do not replace a file that the scene reads",
          "[bad_input][cli]") {
  const BadInput bad("own");
  const ReadingScene made(bad);
  const auto at = [&](const std::string& name) {
    std::filesystem::create_directories(std::filesystem::path(bad.path(name)).parent_path());
    std::filesystem::copy_file(made.irregularity, bad.path(name));
    return bad.file("other.toml", replaced(text_of(made.scene), "i.csv", name));
  };
  const auto kept = [&](const std::string& words, const std::string& name) {
    const Ran ran = railstep_program(words);
    CAPTURE(words, ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains(name + ": this output would replace"));
    CHECK(text_of(bad.path(name)) == text_of(made.irregularity));
  };
  kept("sweep " + at("swept/table.csv") +
           " --set step.duration_s=0.001 --vary step.dt_s=1e-4 --out " + bad.path("swept"),
       "swept/table.csv");
  CHECK(entries(bad.path("swept")) == 1);  // no run was made
  kept("run " + at("shown/other.pvd") + " --duration 0.001 --vtk " + bad.path("shown"),
       "shown/other.pvd");
}

TEST_CASE("a file or link that has the name of an unfinished output is left alone", "[cli]") {
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

TEST_CASE("runs that write one trace at the same time leave the whole trace of one of them",
          "[cli]") {
  const BadInput files("at_once");
  const std::vector<std::string> durations = {"0.3", "0.25", "0.2"};
  std::vector<std::string> alone;
  for (const std::string& duration : durations) {
    const std::string trace = files.path(duration);
    REQUIRE(railstep_program(fmt::format("run {} --duration {} --trace {}", shipped("moving_load"),
                                         duration, trace))
                .code == 0);
    alone.push_back(text_of(trace));
  }
  std::vector<int> codes(durations.size(), -1);
  std::vector<std::thread> runs;
  for (std::size_t i = 0; i < durations.size(); ++i)
    runs.emplace_back([&, i] {
      codes[i] =
          std::system(fmt::format("timeout {} '{}' run {} --duration {} --trace {} >/dev/null",
                                  kPatience.count(), RAILSTEP_PROGRAM, shipped("moving_load"),
                                  durations[i], files.path("t.csv"))
                          .c_str());
    });
  for (std::thread& run : runs) run.join();
  CHECK(codes == std::vector<int>{0, 0, 0});
  CHECK(std::count(alone.begin(), alone.end(), text_of(files.path("t.csv"))) == 1);
  CHECK(parts_in(files.path("")) == 0);
}
