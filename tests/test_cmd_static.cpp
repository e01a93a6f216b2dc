#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::string kScenes = RAILSTEP_SOURCE "/config/scenes/";

std::string scene(const std::string& name) { return "'" + kScenes + name + ".toml' "; }

nlohmann::json solved(const std::string& words) {
  const Ran ran = railstep_program("static " + words + " --json");
  INFO(words << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

/// Displacement of a named point, m.
std::array<double, 3> point(const nlohmann::json& result, const std::string& name = "tip") {
  for (const auto& p : result["points"])
    if (p["name"] == name) return p["displacement_m"];
  FAIL("no point " << name);
  return {};
}

/// Refused: exit 2, and one sentence that says why.
void refuse(const std::string& words, const std::string& why) {
  const Ran ran = railstep_program("static " + words);
  INFO(words << "\n" << ran.err);
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains(why));
}

struct Row {
  std::string words;
  double z, x, half_z, half_x;  // m; half a unit of the last digit printed in reference.md
};

const std::string kNoShear = "--set rail.shear_factor_z=1 ";

}  // namespace

TEST_CASE("cantilevers: nonlinear, linearised and Timoshenko's", "[static]") {
  const Row row = GENERATE(
      Row{scene("cantilever_rectangle"), -2.06522e-2, -1.27763e-4, 5e-8, 5e-10},
      Row{scene("cantilever_rail"), -2.08871e-2, -1.30243e-4, 5e-8, 5e-10},
      Row{scene("cantilever_rail_linear"), -2.08927e-2, 0., 5e-8, 1e-15},
      Row{scene("cantilever_beam"), -2.08927e-2, 0., 5e-8, 1e-15},
      Row{scene("cantilever_rail") + kNoShear, -2.06866e-2, -1.28161e-4, 5e-8, 5e-10},
      Row{scene("cantilever_rail") + "--model linearised " + kNoShear, -2.06921e-2, 0., 5e-8, 1e-15},
      Row{scene("cantilever_rail") + "--model timoshenko " + kNoShear, -2.06921e-2, 0., 5e-8,
          1e-15});
  INFO(row.words);
  const nlohmann::json result = solved(row.words);
  const auto [x, y, z] = point(result);
  CHECK_THAT(z, WithinAbs(row.z, row.half_z));
  CHECK_THAT(x, WithinAbs(row.x, row.half_x));
  CHECK(std::abs(y) < 1e-15);
  CHECK(result["residual"].get<double>() < 1e-10);
  const bool nonlinear = row.x != 0.;
  CHECK((result["iterations"].get<int>() > 1) == nonlinear);
}

TEST_CASE("the linearised rail is Timoshenko's beam", "[static]") {
  const double ancf = point(solved(scene("cantilever_rail_linear")))[2];
  const double exact = point(solved(scene("cantilever_beam")))[2];
  // Exact at its end nodes; condition 1e6 for the elements of 0.2 m times 1e2 for ten of them.
  CHECK_THAT(ancf, WithinRel(exact, 1e-8));
}
