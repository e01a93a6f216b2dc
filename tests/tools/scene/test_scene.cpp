#include <unistd.h>  // getpid: test cases run side by side, each in its own folder

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "online/math/table.h"
#include "scene/scene.h"
#include "support/shipped.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;
using Overrides = std::vector<std::string>;

namespace {

/// Message for a shipped scene with one option, or "accepted" if it is read.
std::string with(const std::string& name, const Overrides& overrides) {
  try {
    read_scene(shipped(name), overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Message for a shipped scene after `from` was replaced by `to` in its text, or "accepted".
std::string edited(const std::string& name, const std::string& from, const std::string& to) {
  std::string text = read_text(shipped(name));
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  const auto folder =
      std::filesystem::temp_directory_path() / ("railstep_test_scene_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "bay.toml", std::ios::binary) << text;
  try {
    read_scene(folder / "bay.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

double value_at(const std::vector<double>& table, double time) {
  return table_value(table.data(), static_cast<std::int32_t>(table.size() / 2), time);
}

}  // namespace

TEST_CASE("moving_load is the scene of the reference", "[scene]") {
  const Scene s = read_scene(shipped("moving_load"));
  CHECK(s.track.unknowns == Unknowns::vertical);
  CHECK(s.track.bays * s.track.elements_per_bay == 16);
  CHECK(s.track.length() == 16 * 0.6);
  CHECK(std::get<RectangleSize>(s.rail.shape).height == 0.2319);
  CHECK(s.rail.shear_factor_z == 0.8497);
  CHECK(s.rail.young == 210e9);
  CHECK(s.support->stiffness[2] == 3e7);
  CHECK(s.support->damping[2] == 3e4);
  CHECK(s.support->at == Height::axis);
  REQUIRE(s.loads.size() == 2);
  CHECK(s.loads[1].name == "load_right");
  CHECK(s.loads[1].rail == kRightRail);
  CHECK(s.loads[1].force == -50e3);
  CHECK(s.step->steps == 12000);
  CHECK(s.step->steps_per_frame == 40);
  CHECK(s.step->rho_inf == 0.6);
  CHECK(s.step->start == Start::released);
}

TEST_CASE("wheelset_on_track is the scene of the paper", "[scene]") {
  const Scene s = read_scene(shipped("wheelset_on_track"));
  const auto& r = std::get<RectangleSizes>(s.rail.shape);
  // The three heights add up to that of 136RE, 185.7375 mm, to the 10 digits written.
  CHECK_THAT(r.foot_height + r.web_height + r.head_height, Catch::WithinAbs(0.1857375, 1e-10));
  CHECK(s.support->damping[1] == 29e6);
  CHECK(s.support->roll_stiffness == 1e6);
  REQUIRE(s.wheelsets.size() == 1);
  const WheelsetScene& w = s.wheelsets[0];
  CHECK(w.wheels[0] == "wheel_left");
  CHECK(w.wheels[1] == "wheel_right");
  CHECK(w.start == s.track.length() / 2);
  REQUIRE(w.forces.size() == 1);
  CHECK(w.forces[0].direction == 1);
  CHECK(value_at(w.forces[0].table, 0.999) == 0.0);
  CHECK(value_at(w.forces[0].table, 1.0) == 10.0);
  CHECK(s.step->steps == 40'000);
  CHECK(s.step->steps_per_frame == 20);
  CHECK(std::get<WheelsetSensor>(s.sensors[0].on).wheelset == 0);
  CHECK(s.trace_supports);
}

TEST_CASE("ballasted_track has sleepers, ballast and sensors", "[scene]") {
  const Scene s = read_scene(shipped("ballasted_track"));
  CHECK(std::get<ProfileFile>(s.rail.shape).path ==
        (std::filesystem::path(kScenes).parent_path().parent_path() / "profiles/60e1.toml")
            .lexically_normal());
  CHECK(s.sleeper->mass == 300);
  CHECK(s.sleeper->ballast_stiffness[2] == 50e6);
  CHECK(s.sleeper->ballast_stiffness[1] == 0.);
  CHECK(s.wheelsets[0].carried_mass == 8800);
  CHECK(s.step->start == Start::equilibrium);
  REQUIRE(s.sensors.size() == 2);
  CHECK(std::get<SleeperSensor>(s.sensors[0].on).sleeper == 20);
  CHECK(std::get<RailSensor>(s.sensors[1].on).at == Height::foot);
}

TEST_CASE("a time table is 0 before its rows, linear between them and held after them", "[scene]") {
  const auto table = [](const std::string& rows) {
    return read_scene(shipped("moving_load"), {"load[0].table=" + rows}).loads[0].table;
  };
  const std::vector<double> t = table("[[1, 10], [2, 20], [4, 0]]");
  CHECK(value_at(t, 0.5) == 0.0);
  CHECK(value_at(t, 1.0) == 10.0);
  CHECK(value_at(t, 1.5) == 15.0);
  CHECK(value_at(t, 3.0) == 10.0);
  CHECK(value_at(t, 9.0) == 0.0);
  CHECK(value_at(table("[[0, 2]]"), 5.0) == 2.0);
}

TEST_CASE("rows 11 to 13: misspelt, doubled and mistyped keys are refused", "[scene]") {
  CHECK_THAT(edited("moving_load", "stiffness_z_n_per_m = 3.0e7", "stifness_z_n_per_m = 3.0e7"),
             Contains("bay.toml:24:1:") && Contains("[support]") &&
                 Contains("stifness_z_n_per_m") && Contains("'stiffness_z_n_per_m'"));
  CHECK_THAT(edited("moving_load", "stiffness_y_n_per_m", "stifness_y_n_per_m"),
             Contains("bay.toml:22:1: [support]") && Contains("'stifness_y_n_per_m'") &&
                 Contains("'stiffness_y_n_per_m'") && Contains("E-KEY-02"));
  CHECK_THAT(edited("moving_load", "bays = 16", "bays = 16\nbays = 17"),
             Contains("bay.toml:9:") && Contains("bays"));
  CHECK_THAT(edited("moving_load", "bay_m = 0.6", "bay_m = \"0.6\""),
             Contains("bay.toml:9:9: [track] bay_m = \"0.6\"") && Contains("E-KEY-03"));
}

TEST_CASE("row 14: numbers that must be positive are checked", "[scene]") {
  CHECK_THAT(with("ballasted_track", {"wheelset[0].mass_kg=-1200"}),
             Contains("--set wheelset[0].mass_kg=-1200: [wheelset[0]] mass_kg = -1200") &&
                 Contains("E-KEY-05"));
  CHECK_THAT(with("ballasted_track", {"sleeper.mass_kg=-1"}),
             Contains("mass_kg = -1") && Contains("E-KEY-05"));
  CHECK(with("ballasted_track", {"sleeper.mass_kg=0"}) == "accepted");
  CHECK_THAT(with("moving_load", {"rail.young_pa=0"}), Contains("young_pa = 0"));
  CHECK_THAT(with("moving_load", {"rail.rectangle.width_m=0"}), Contains("width_m = 0"));
  CHECK_THAT(with("moving_load", {"track.bay_m=0"}), Contains("bay_m = 0"));
  CHECK_THAT(with("moving_load", {"support.stiffness_z_n_per_m=-1"}), Contains("at least 0"));
}

TEST_CASE("rows 15 to 17: step, rho_inf and Poisson's ratio are checked", "[scene]") {
  CHECK_THAT(with("moving_load", {"step.dt_s=0"}), Contains("dt_s = 0 is out of range"));
  CHECK_THAT(with("moving_load", {"step.dt_s=nan"}), Contains("dt_s = nan is not finite"));
  CHECK_THAT(with("moving_load", {"step.dt_s=0.05", "step.duration_s=0.01"}),
             Contains("E-STEP-07"));
  CHECK_THAT(with("moving_load", {"step.dt_s=0.0007", "step.frame_s=0.0007"}),
             Contains("0.0007") && Contains("0.3"));
  CHECK_THAT(with("moving_load", {"step.frame_s=0.00101"}),
             Contains("expected a multiple of dt_s [E-STEP-06]"));
  CHECK_THAT(with("moving_load", {"step.rho_inf=1.1"}),
             Contains("rho_inf = 1.1") && Contains("at least 0, at most 1"));
  CHECK(with("moving_load", {"step.scheme=\"newmark\"", "step.newmark_gamma=0.6"}) == "accepted");
  CHECK_THAT(with("moving_load", {"step.newmark_gamma=0.5"}),
             Contains("expected scheme = \"newmark\" beside it [E-STEP-01]"));
  CHECK_THAT(with("moving_load", {"step.scheme=\"newmark\"", "step.newmark_gamma=0.25"}),
             Contains("newmark_gamma = 0.25") && Contains("at least 0.5, at most 1"));
  CHECK_THAT(with("moving_load", {"step.scheme=\"newmark\"", "step.newmark_beta=0.125"}),
             Contains("newmark_beta = 0.125") && Contains("at least 0.25, at most 1"));
  CHECK_THAT(with("moving_load", {"step.scheme=\"hht\"", "step.hht_alpha=-0.34"}),
             Contains("hht_alpha = -0.34"));
  CHECK(with("moving_load", {"step.scheme=\"hht\"", "step.hht_alpha=-0.3333333333333333"}) ==
        "accepted");
  CHECK(with("moving_load", {"step.scheme=\"tr-bdf2\""}) == "accepted");
  CHECK_THAT(with("moving_load", {"rail.poisson=0.5"}), Contains("above -1, below 0.5"));
  CHECK_THAT(with("moving_load", {"rail.poisson=-1"}), Contains("above -1, below 0.5"));
  CHECK(with("moving_load", {"rail.poisson=0.499"}) == "accepted");
}

TEST_CASE("rows 18 and 19: unknown and doubled names are refused", "[scene]") {
  CHECK_THAT(with("wheelset_on_track", {"sensor[0].wheelset=\"bogie\""}),
             Contains("wheelset = \"bogie\" is unknown; expected \"wheelset\" [E-SENSOR-01]"));
  CHECK_THAT(with("moving_load", {"sensor=[{name=\"s\", on=\"wheelset\", wheelset=\"w\"}]"}),
             Contains("E-SENSOR-02"));
  CHECK_THAT(with("moving_load", {"sensor=[{name=\"s\", on=\"sleeper\", sleeper=1}]"}),
             Contains("E-SENSOR-04"));
  CHECK_THAT(with("ballasted_track", {"sensor[0].sleeper=41"}),
             Contains("expected 0 to 40 [E-KEY-05]"));
  CHECK_THAT(with("ballasted_track", {"sensor[0].on=\"bogie\""}),
             Contains("one of \"rail\", \"sleeper\", \"wheelset\""));
  CHECK_THAT(with("moving_load", {"load[1].name=\"load_left\""}),
             Contains("name = \"load_left\" is taken by [load[0]]; expected a name that is used "
                      "once [E-RUNNER-19]"));
  CHECK_THAT(with("ballasted_track", {"sensor[1].name=\"wheel_left\""}),
             Contains("is taken by [wheelset[0]]"));
  CHECK_THAT(with("moving_load", {"load[0].name=\"a,b\""}), Contains("E-RUNNER-14"));
  CHECK_THAT(with("moving_load", {"load[0].name=\"support_1\""}), Contains("E-RUNNER-15"));
}

TEST_CASE("row 20: a path must stay on the rail unless it may leave", "[scene]") {
  CHECK_THAT(with("moving_load", {"step.duration_s=0.4"}),
             Contains("[load[0]] speed_m_per_s = 30") && Contains("x = 12.3 m") &&
                 Contains("0 to 9.6 m") && Contains("E-RUNNER-07"));
  CHECK(with("moving_load", {"step.duration_s=0.4", "load[0].stop_m=9.3", "load[1].stop_m=9.3"}) ==
        "accepted");
  CHECK(with("moving_load", {"step.duration_s=0.31"}) == "accepted");  // ends exactly at 9.6 m
  CHECK(with("moving_load", {"step.duration_s=0.4", "load[0].may_leave_rail=true",
                             "load[1].may_leave_rail=true"}) == "accepted");
  CHECK_THAT(with("moving_load", {"load[0].start_m=-0.1"}), Contains("at least 0, at most 9.6"));
  CHECK_THAT(with("moving_load", {"load[0].stop_m=0.2"}), Contains("E-RUNNER-24"));
  CHECK_THAT(with("ballasted_track", {"step.duration_s=1"}),
             Contains("x = 34.5 m") && Contains("E-RUNNER-07"));
}

TEST_CASE("a wheelset in equilibrium must start on the rail", "[scene]") {
  const Overrides beyond = {"wheelset[0].start_m=24.5", "wheelset[0].may_leave_rail=true"};
  Overrides released = beyond;
  released.emplace_back("step.start=\"released\"");
  CHECK_THAT(with("ballasted_track", beyond),
             Contains("start_m = 24.5") && Contains("0 to 24 m") && Contains("E-RUNNER-12"));
  CHECK(with("ballasted_track", released) == "accepted");
}

TEST_CASE("row 23: a billion elements are refused with the bytes they would need", "[scene]") {
  // 2 rails * 1e9 bays * 1 element; 4 unknowns each, 4 bands of 12 doubles: 2e9 * 4 * 12 * 32
  // bytes.
  CHECK_THAT(with("moving_load", {"track.bays=1000000000"}),
             Contains("2000000000 elements, about 3.07e+12 bytes") && Contains("E-SCENE-11"));
  CHECK(with("moving_load", {"track.bays=50000"}) == "accepted");
  CHECK_THAT(with("moving_load", {"track.bays=50001"}), Contains("100002 elements"));
}

TEST_CASE("rows 24 and 25: huge integers and deep nesting in a scene are refused", "[scene]") {
  CHECK_THAT(with("moving_load", {"track.bays=9223372036854775808"}), Contains("E-SET-02"));
  CHECK_THAT(edited("moving_load", "bays = 16", "bays = 9223372036854775808"),
             Contains("bay.toml:8:"));
  CHECK_THAT(edited("moving_load", "bays = 16", "bays = " + std::string(100'000, '[')),
             Contains("bay.toml:8:") && Contains("E-FILE-02"));
}

TEST_CASE("millimetres typed as metres are noticed", "[scene]") {
  CHECK_THAT(with("moving_load", {"track.bay_m=600"}), Contains("millimetres"));
  CHECK_THAT(with("moving_load", {"rail.rectangle.height_m=231.9"}), Contains("millimetres"));
  CHECK_THAT(with("wheelset_on_track", {"wheelset[0].radius_m=148"}), Contains("millimetres"));
}

TEST_CASE("the section is given in exactly one way", "[scene]") {
  CHECK_THAT(with("moving_load", {"rail.profile=\"a.toml\""}),
             Contains("rectangle is given beside profile") && Contains("E-RAIL-03"));
  CHECK_THAT(edited("moving_load",
                    "[rail.rectangle]\nheight_m = 0.2319\nwidth_m = 0.0375\n"
                    "shear_factor_y = 0.8497\nshear_factor_z = 0.8497",
                    "[rail]"),
             Contains("E-RAIL-05"));
  CHECK_THAT(with("moving_load", {"rail.shear_factor_z=0.4"}), Contains("E-RAIL-06"));
  CHECK_THAT(with("wheelset_on_track", {"rail.rectangles.web_height_m=0.98"}),
             Contains("E-RAIL-02"));
}

TEST_CASE("a table without another one that it needs is refused", "[scene]") {
  CHECK_THAT(with("moving_load", {"sleeper.mass_kg=300"}), Contains("E-SUPPORT-01"));
  CHECK_THAT(with("moving_load", {"ballast.stiffness_z_n_per_m=5e7"}), Contains("E-SUPPORT-02"));
  CHECK_THAT(with("ballasted_track", {"track.rails=1"}), Contains("E-RUNNER-13"));
  CHECK_THAT(with("moving_load", {"track.rails=1"}), Contains("E-SCENE-01"));
  CHECK(with("moving_load", {"condense.kind=\"modal\""}) == "accepted");
  CHECK_THAT(with("moving_load", {"condense.modes_per_bay=-1"}), Contains("modes_per_bay"));
  for (const char* kind : {"guyan", "irs", "craig-bampton", "krylov", "complex-modes"}) {
    CHECK(with("moving_load", {std::string("condense.kind=\"") + kind + "\""}) == "accepted");
    CHECK_THAT(with("endless_track", {std::string("condense.kind=\"") + kind + "\""}),
               Contains("E-CONDENSE-26"));
  }
  CHECK_THAT(with("moving_load", {"condense.kind=\"guyen\""}), Contains("\"guyan\""));
  CHECK_THAT(with("moving_load", {"condense.nodes_per_bay=3"}), Contains("E-CONDENSE-28"));
  CHECK_THAT(with("moving_load", {"condense.band_hz=[500, 20]"}), Contains("E-CONDENSE-25"));
  CHECK_THAT(with("moving_load", {"condense.expansion_hz=[0]"}), Contains("expansion_hz"));
  CHECK_THAT(with("moving_load", {"condense.modes_per_bay=2", "condense.highest_hz=900"}),
             Contains("E-CONDENSE-27"));
  CHECK_THAT(with("wheelset_on_track", {"wheelset[0].guide={method=\"baumgarte\"}"}),
             Contains("'alpha_per_s'") && Contains("E-KEY-01"));
  CHECK_THAT(with("wheelset_on_track", {"wheelset[0].guide.alpha_per_s=1"}),
             Contains("E-RUNNER-11"));
  CHECK_THAT(with("wheelset_on_track", {"wheelset[0].force[0].table=[[1, 1], [1, 2]]"}),
             Contains("E-RUNNER-02"));
  CHECK_THAT(with("moving_load", {"schema=2"}), Contains("E-SCENE-27"));
}

namespace {

/// The keys that `source` names in quotes right after an opening bracket or the name of a table in
/// brackets, which are the first arguments of all getters.
std::vector<std::string> quoted_keys(const std::string& source) {
  std::vector<std::string> keys;
  for (const std::string opener :
       {"number(\"", "integer(\"", "boolean(\"", "string(\"", "strings(\"", "choice(\"", "path(\"",
        "table(\"", "table_if(\"", "tables(\"", "has(\"", "(t, \"", "(force, \"", "(rail, \"",
        "(bar, \"", "(*t, \""})
    for (auto at = source.find(opener); at != std::string::npos; at = source.find(opener, at + 1)) {
      const auto from = at + opener.size();
      keys.push_back(source.substr(from, source.find('"', from) - from));
    }
  return keys;
}

}  // namespace

TEST_CASE("config/README.md has every key that the scene reader asks for", "[scene]") {
  const std::filesystem::path source(RAILSTEP_SOURCE);
  const std::string documented = read_text(source / "config/README.md");
  std::size_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator(source / "tools/scene"))
    for (const std::string& key : quoted_keys(read_text(file.path()))) {
      if (key.size() == 1) continue;  // an axis, whose full keys are checked below
      INFO(key);
      // The key stands alone, after its table's name, as the heading of a table, or before the unit
      // of a fishplate's stiffness.
      bool found = false;
      for (const char* before : {"`", ".", "["})
        for (const char* after : {"`", "]", "_stiffness_n"})
          found = found || documented.find(before + key + after) != std::string::npos;
      CHECK(found);
      ++count;
    }
  CHECK(count > 120);  // the openers above still find the reader's getters
  for (const std::string axis : {"x", "y", "z"}) {
    CHECK_THAT(documented, Contains("`stiffness_" + axis + "_n_per_m`"));
    CHECK_THAT(documented, Contains("`damping_" + axis + "_n_s_per_m`"));
  }
  for (const std::string unit : {"m", "rad", "n", "n_m"}) {
    CHECK_THAT(documented, Contains("`polynomial_" + unit + "`"));
    CHECK_THAT(documented, Contains("`table_" + unit + "`"));
  }
}
