// `railstep creep`: forces of all laws, the page, and what is refused.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

nlohmann::json creep(const std::string& words) {
  const Ran ran = railstep_program("creep --json " + words);
  INFO(words << ": " << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

void bad(const std::string& words, const std::string& message) {
  const Ran ran = railstep_program("creep " + words);
  INFO(words);
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains(message));
}

}  // namespace

TEST_CASE("creep forces of the laws are those of the half-space, as near as each can", "[creep]") {
  // a/b 0.5, x 1.5: CONTACT has -0.8877.
  for (const auto& [law, bound] : {std::pair("she", .04), {"fastsim:10", .05}, {"polach", .06}}) {
    const auto force = creep(std::string("--ratio 0.5 --x 1.5 --law ") + law);
    CHECK(force.at("fx").get<double>() == Approx(-.8877).margin(bound));
    CHECK(force.at("fy").get<double>() == 0.);
  }
  CHECK(creep("--ratio 0.5 --x 1.5 --law linear").at("fx").get<double>() ==
        Approx(-.25 * 3.8 * 1.5).epsilon(1e-12));
  // Pure spin 0.7 at a/b 2: -0.7699.
  CHECK(creep("--ratio 2 --p 0.7 --law fastsim:20").at("fy").get<double>() ==
        Approx(-.7699).margin(.06));
  CHECK(creep("--ratio 2 --p 0.7 --law fastsim") == creep("--ratio 2 --p 0.7 --law fastsim:10"));
  CHECK(creep("--ratio 1 --e 0.2 --poisson 0.25 --law linear").at("fy").get<double>() ==
        Approx(-.25 * 3.67 * .2).epsilon(1e-12));
}

TEST_CASE("the page of creep forces has the curves of all laws", "[creep]") {
  const auto folder = fresh_folder("creep");
  std::filesystem::create_directories(folder);
  const auto file = folder / "creep.html";
  const Ran ran = railstep_program("creep --ratio 0.5 --x 1 --report " + file.string());
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("she: Fx -0.68"));
  const std::string page = text_of(file);
  for (const char* text : {"fastsim:50", "polach", "Over the spin p, x = 1, e = 0"})
    CHECK_THAT(page, Contains(text));
}

TEST_CASE("words of creep that cannot be used are refused", "[creep]") {
  bad("--ratio 0.5 --law fastsim:0", "E-CLI-17");
  bad("--ratio 0.5 --law fastsim:ten", "E-CLI-17");
  bad("--ratio 0.5 --law coulomb", "E-CLI-17");
  bad("--ratio 0", "out of range");
  bad("--x 1", "--ratio");
}
