#include <catch2/catch.hpp>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "run/in_parallel.h"
#include "support/program.h"
#include "sweep/sweep_grid.h"
#include "sweep/sweep_key.h"

using namespace railstep;

TEST_CASE("commas within brackets, braces and quotes belong to a value", "[sweep]") {
  const VariedKey varied =
      read_varied(R"(load[0].table = [[0, 1], [2, 3]] ,{a = 1, b = 2},"x, \", y",'\,',1.5)");
  CHECK(varied.key == "load[0].table");
  CHECK(varied.values == std::vector<std::string>{"[[0, 1], [2, 3]]", "{a = 1, b = 2}",
                                                  R"("x, \", y")", R"('\,')", "1.5"});
}

TEST_CASE("the last key of a grid changes fastest", "[sweep]") {
  const Grid grid({"c=0"}, {"a=1,2", "b=3,4,5"});
  CHECK(grid.runs() == 6);
  CHECK(grid.words(0) == "a=1, b=3");
  CHECK(grid.words(1) == "a=1, b=4");
  CHECK(grid.words(5) == "a=2, b=5");
  CHECK(grid.overrides(3) == std::vector<std::string>{"c=0", "a=2", "b=3"});
}

TEST_CASE("every run is in one shard", "[sweep]") {
  std::vector<int> met(10, 0);
  for (const char* shard : {"1/4", "2/4", "3/4", "4/4"})
    for (const std::int64_t run : read_shard(shard).runs(10)) ++met[static_cast<std::size_t>(run)];
  CHECK(met == std::vector<int>(10, 1));
  CHECK(read_shard("0/4").runs(10) == read_shard("4/4").runs(10));  // shards may be numbered from 0
  CHECK(read_shard("7/8").runs(3).empty());  // there are more shards than runs
}

TEST_CASE("the first of several failures is thrown", "[sweep]") {
  for (const int jobs : {1, 2, 8}) {
    std::vector<int> done(1000, 0);
    const auto work = [&](std::int64_t i) {
      done[static_cast<std::size_t>(i)] = 1;
      if (i >= 137) throw std::runtime_error(std::to_string(i));
    };
    CHECK_THROWS_WITH(in_parallel(1000, jobs, work), "137");
    CHECK(std::vector<int>(done.begin(), done.begin() + 138) == std::vector<int>(138, 1));
  }
  CHECK_NOTHROW(in_parallel(0, 4, [](std::int64_t) { throw std::runtime_error("none"); }));
}

TEST_CASE("a run's key depends on the program, the scene, its overrides and all files", "[sweep]") {
  const auto folder = fresh_folder("sweep_key");
  const std::string source = std::string(RAILSTEP_SOURCE) + "/config/";
  std::filesystem::copy(source + "profiles/60e1.toml", folder / "rail.toml");
  const std::string rail = "rail.profile=\"" + (folder / "rail.toml").string() + "\"";
  const auto key = [&](const std::vector<std::string>& set, double from, const char* program) {
    RunKeys keys(program, from);
    return keys.of(source + "scenes/ballasted_track.toml", set);
  };
  const std::string plain = key({rail}, 0., "1");
  CHECK(plain.size() == 64);
  CHECK(key({rail}, 0., "1") == plain);
  CHECK(key({rail}, 0., "2") != plain);
  CHECK(key({rail}, .1, "1") != plain);
  CHECK(key({rail, "track.bays=40"}, 0., "1") != plain);
  std::ofstream(folder / "rail.toml", std::ios::app) << "# another file\n";
  CHECK(key({rail}, 0., "1") != plain);
  // Profiles of wheels on rails count, too.
  std::filesystem::copy(source + "profiles/s1002.toml", folder / "wheel.toml");
  const std::string wheel = "contact.wheel_profile=\"" + (folder / "wheel.toml").string() + "\"";
  const auto of_car = [&] {
    return RunKeys("1", 0.).of(source + "scenes/manchester_s1002.toml", {wheel});
  };
  const std::string before = of_car();
  std::ofstream(folder / "wheel.toml", std::ios::app) << "# another file\n";
  CHECK(of_car() != before);
}
