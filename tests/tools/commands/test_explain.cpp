// Errors as a program reads them, and what `railstep explain` says about each.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "support/bad_input.h"

using namespace railstep;
using Catch::Contains;
using Catch::StartsWith;

namespace {

nlohmann::json errors_of(const Ran& ran) {
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 2);
  return nlohmann::json::parse(ran.out);
}

/// A scene with this many loads. The force of each is a text.
std::string scene_with_bad_loads(int loads) {
  std::string text = text_of(shipped("moving_load"));
  text.resize(text.find("[[load]]"));
  for (int i = 0; i < loads; ++i)
    text += "[[load]]\nname = \"l" + std::to_string(i) +
            "\"\nrail = \"left\"\nstart_m = 3.0\nspeed_m_per_s = 1.0\nforce_z_n = \"5\"\n";
  return text + "[step]\ndt_s = 1e-4\nduration_s = 0.1\n";
}

}  // namespace

TEST_CASE("explain says more about an id and about a status bit", "[explain][cli]") {
  const Ran id = railstep_program("explain E-KEY-05"), bit = railstep_program("explain off_rail");
  CHECK(id.code == 0);
  CHECK_THAT(id.out, StartsWith("E-KEY-05\n\n") && !Contains("##"));
  CHECK(bit.code == 0);
  CHECK_THAT(bit.out, StartsWith("off_rail\n\n") && Contains("track.bays"));
}

TEST_CASE("explain takes capitals and small letters for the same", "[explain][cli]") {
  CHECK(railstep_program("explain e-key-05").out == railstep_program("explain E-KEY-05").out);
  CHECK_THAT(railstep_program("explain OFF_RAIL").out, StartsWith("off_rail\n\n"));
  const BadInput bad("explain_case");
  bad.refused("explain e-key-5", {"'e-key-5'", "'E-KEY-05'", "E-CLI-14"});
}

TEST_CASE("explain lists all ids and status bits, one a line", "[explain][cli]") {
  const Ran ran = railstep_program("explain");
  CHECK(ran.code == 0);
  CHECK(std::count(ran.out.begin(), ran.out.end(), '\n') > 100);
  for (const char* word : {"\nE-KEY-05 ", "\nW-RUN-01 ", "\noff_rail "})
    CHECK_THAT("\n" + ran.out, Contains(word));
}

TEST_CASE("explain refuses an id that is not there and names the nearest", "[explain][cli]") {
  const BadInput bad("explain");
  bad.refused("explain E-KEY-5", {"'E-KEY-5'", "'E-KEY-05'", "E-CLI-14"});
  bad.refused("explain of_rail", {"'off_rail'", "E-CLI-14"});
}

TEST_CASE("with --json an error is an object on stdout too", "[explain][cli]") {
  const auto told = errors_of(railstep_program("run none.toml --json"));
  REQUIRE(told.at("errors").size() == 1);
  CHECK(told["errors"][0].at("id") == "E-FILE-04");
  CHECK_THAT(told["errors"][0].at("text").get<std::string>(), StartsWith("none.toml: "));
  CHECK(told.at("more") == 0);
  CHECK(errors_of(
            railstep_program("run " + shipped("moving_load") + " --json --stepp 1"))["errors"][0]
            .at("id") == "E-CLI-12");
}

TEST_CASE("ten errors of a scene are shown and the others counted", "[explain][cli]") {
  const BadInput bad("several");
  const Ran ran = railstep_program("run " + bad.file("bad.toml", scene_with_bad_loads(12)) +
                                   " --json --trace " + bad.path("t.csv"));
  const auto told = errors_of(ran);
  REQUIRE(told.at("errors").size() == 10);
  CHECK(told.at("more") == 2);
  for (const auto& error : told["errors"]) CHECK(error.at("id") == "E-KEY-03");
  CHECK_THAT(told["errors"][0].at("text").get<std::string>(), Contains("[load[0]] force_z_n"));
  CHECK_THAT(told["errors"][9].at("text").get<std::string>(), Contains("[load[9]] force_z_n"));
  CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 11);
  CHECK_THAT(ran.err, Contains("and 2 more"));
  CHECK(bad.content().count("t.csv") == 0);
}
