#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"

using namespace railstep;

namespace {

/// Output of compare for two traces with these rows.
struct Compared {
  Ran ran;
  nlohmann::json told;
};
Compared compared(const std::string& a, const std::string& b, const std::string& words = "") {
  const auto folder = fresh_folder("compare");
  std::ofstream(folder / "a.csv") << a;
  std::ofstream(folder / "b.csv") << b;
  Compared result{railstep_program("compare " + (folder / "a.csv").string() + " " +
                                   (folder / "b.csv").string() + " --json " + words),
                  {}};
  if (!result.ran.out.empty()) result.told = nlohmann::json::parse(result.ran.out);
  return result;
}

const std::string kHead = "time_s,w.z_m\n";

}  // namespace

TEST_CASE("traces of one run are identical", "[compare][cli]") {
  const auto folder = fresh_folder("compare_runs");
  const std::string scene = std::string(RAILSTEP_SOURCE) + "/config/scenes/moving_load.toml";
  for (const char* name : {"a", "b"})
    REQUIRE(
        railstep_program("run " + scene + " --duration 0.02 --trace " + (folder / name).string())
            .code == 0);
  const Ran ran = railstep_program("compare " + (folder / "a").string() + " " +
                                   (folder / "b").string() + " --json");
  CHECK(ran.code == 0);
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["identical"] == true);
  CHECK(told["first_difference"].is_null());
  CHECK(told["max_relative_difference"] == 0.);
}

TEST_CASE("the deflections of a load of twice the size differ by their own size",
          "[compare][cli]") {
  // The track is linear and a factor 2 is exact in every product and sum. The rails are not
  // coupled: the right one moves as before.
  const auto folder = fresh_folder("compare_loads");
  const std::string run = "run " + std::string(RAILSTEP_SOURCE) +
                          "/config/scenes/moving_load.toml --duration 0.02 --trace ";
  const std::string a = (folder / "a").string(), b = (folder / "b").string();
  REQUIRE(railstep_program(run + a).code == 0);
  REQUIRE(railstep_program(run + b + " --set 'load[0].force_z_n=-100e3'").code == 0);
  const Ran ran = railstep_program("compare " + a + " " + b + " --json");
  CHECK(ran.code == 1);
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["identical"] == false);
  const auto& first = told["first_difference"];
  CHECK(first["column"] == "load_left.deflection_z_m");
  CHECK(first["b"].get<double>() == 2. * first["a"].get<double>());
  CHECK(told["max_relative_difference"] == 1.);
  CHECK(railstep_program("compare " + a + " " + b + " --tolerance 1").code == 0);
  CHECK(railstep_program("compare " + a + " " + b + " --tolerance 0.999").code == 1);
}

TEST_CASE("compare names the first difference and the largest one over its column's peak",
          "[compare]") {
  const Compared found = compared(kHead + "0,4\n1,-8\n2,1\n", kHead + "0,4\n1,-8\n2,1.5\n");
  CHECK(found.ran.code == 1);
  CHECK(found.told["identical"] == false);
  CHECK(found.told["first_difference"]["row"] == 2);
  CHECK(found.told["first_difference"]["column"] == "w.z_m");
  CHECK(found.told["first_difference"]["a"] == 1.);
  CHECK(found.told["first_difference"]["b"] == 1.5);
  CHECK(found.told["max_relative_difference"] == .5 / 8.);
}

TEST_CASE("traces that differ within a tolerance pass", "[compare]") {
  const std::string a = kHead + "0,4\n1,-8\n", b = kHead + "0,4\n1,-8.5\n";
  CHECK(compared(a, b, "--tolerance 0.0625").ran.code == 0);
  CHECK(compared(a, b, "--tolerance 0.06").ran.code == 1);
  CHECK(compared(a, b, "--tolerance -1").ran.code == 2);
}

TEST_CASE("the last bit and the sign of zero are differences", "[compare]") {
  CHECK(compared(kHead + "0,1\n", kHead + "0,1.0000000000000002\n").ran.code == 1);
  CHECK(compared(kHead + "0,0\n", kHead + "0,-0\n").ran.code == 1);
}
