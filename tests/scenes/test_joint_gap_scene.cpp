// Gaps of joints in scenes and how heat changes them.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "build/build.h"
#include "support/program.h"
#include "support/scene_run.h"

using namespace railstep;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

TEST_CASE("heat closes the gaps of joints in a scene", "[joint]") {
  const std::string joint =
      "rail_joint=[{x_m=4.8, gap_m=0.0023, bending_vertical_stiffness_n_m_per_rad=1e6}]";
  const auto read = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {joint, "track.ends=\"pinned\""};
    words.insert(words.end(), more.begin(), more.end());
    return read_scene(kScenes + "moving_load.toml", words);
  };
  // 1.15e-5 x 20 K x 9.6 m = 2.2 mm of 2.3 mm.
  const Track open = track_of(read({"rail.temperature_rise_k=20"}));
  CHECK(open.axial_force == 0.);
  CHECK_THAT(open.joints[0].gap[1], WithinRel(.0023 - 1.15e-5 * 20. * 9.6, 1e-9));
  const Track closed = track_of(read({"rail.temperature_rise_k=30"}));
  const double EA = closed.material.young * closed.section.area;
  const double kc = closed.joints[0].end_stiffness;
  const double P = (1.15e-5 * 30. * 9.6 - .0023) / (9.6 / EA + 1. / kc);
  CHECK_THAT(-closed.axial_force, WithinRel(P, 1e-12));
  CHECK_THAT(closed.joints[0].end_force[0], WithinRel(P, 1e-12));
  CHECK_THAT(closed.joints[0].gap[0], WithinRel(-P / kc, 1e-12));
  const Scene scene = read({"rail.temperature_rise_k=30"});
  CHECK_THAT(kc, WithinRel(EA / section_of(scene).height, 1e-12));
  const std::string two =
      "rail_joint=[{x_m=4.8, gap_m=0.0005, bending_vertical_stiffness_n_m_per_rad=1e6}, "
      "{x_m=7.2, gap_m=0.02, bending_vertical_stiffness_n_m_per_rad=1e6}]";
  CHECK_THROWS_WITH(read({two, "rail.temperature_rise_k=30"}), Contains("E-RAILJOINT-07"));
  CHECK_THROWS_WITH(
      read({"rail_joint[0].along_stiffness_n_per_m=1e6", "rail.temperature_rise_k=30"}),
      Contains("E-RAILJOINT-06"));
  CHECK_THROWS_WITH(read_scene(kScenes + "moving_load.toml",
                               {"rail_joint=[{x_m=4.8, bending_vertical_stiffness_n_m_per_rad=1, "
                                "end_stiffness_n_per_m=1e9}]"}),
                    Contains("gap_m"));
}

TEST_CASE("loads over joints under pressure from heat keep the balance of energy", "[joint]") {
  const Ran ran = railstep_program(
      "run " + kScenes +
      "moving_load.toml --json --set track.elements_per_bay=2 --set 'track.ends=\"pinned\"' "
      "--set 'track.unknowns=\"rigid-section\"' --set rail.temperature_rise_k=30 "
      "--set support.stiffness_x_n_per_m=2e7 --set support.stiffness_y_n_per_m=2e7 "
      "--set support.stiffness_roll_n_m_per_rad=3e5 "
      "--set 'load[0].table=[[0, 0], [0.05, 1]]' --set 'load[1].table=[[0, 0], [0.05, 1]]' "
      "--set 'rail_joint=[{x_m=4.8, gap_m=0.0023, bending_vertical_stiffness_n_m_per_rad=1e6}]'");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const auto run = nlohmann::json::parse(ran.out);
  CHECK(run.at("status").empty());
  CHECK(run.at("energy_balance_error").get<double>() < 1e-3);
}
