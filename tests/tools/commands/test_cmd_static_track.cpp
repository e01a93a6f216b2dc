#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <sstream>

#include "support/static_program.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// A shipped scene with more tables after its own; paths to profiles stay valid.
std::string longer(const std::string& name, const std::string& more) {
  std::string text = text_of(RAILSTEP_SOURCE "/config/scenes/" + name + ".toml");
  if (const auto at = text.find("../profiles"); at != text.npos)
    text.replace(at, 2, RAILSTEP_SOURCE "/config");
  return text + "\n" + more;
}

void refuse(const std::string& words, const std::string& why) {
  const Ran ran = railstep_program(words);
  INFO(words << "\n" << ran.err);
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains(why));
}

const std::string kUnder =
    "[[sensor]]\nname = \"under\"\non = \"rail\"\nrail = \"left\"\nposition_m = ";

}  // namespace

TEST_CASE("a wheelset presses with half its weight on each railhead", "[static]") {
  const OwnScene own(longer("wheelset_on_track", kUnder + "3.2\n"));
  // reference.md: the rail settles at -7.0046e-5 m, with its own weight at -4.36163e-4 m. The
  // head's force squeezes the section too, which moves the axis by less than 1e-4 of that.
  CHECK_THAT(point(solved(own.words()), "under")[2], WithinRel(-7.0046e-5, 1e-4));
  CHECK_THAT(point(solved(own.words() + "--set track.gravity=true"), "under")[2],
             WithinRel(-4.36163e-4, 1e-4));
  // Under so light a load the nonlinear rail is linear: theta = 1e-4, squared.
  CHECK_THAT(point(solved(own.words() + "--model nonlinear"), "under")[2],
             WithinRel(-7.0046e-5, 2e-4));
  refuse("static " + own.words() + "--set 'wheelset[0].force[0].table=[[0.0, 10.0]]'",
         "E-STATIC-01");
}

TEST_CASE("static applies the load of t = 0", "[static]") {
  const OwnScene own(longer("moving_load", kUnder + "4.5\n"));
  const std::string still =
      "--set track.elements_per_bay=8 --set 'load[0].start_m=4.5' --set "
      "'load[0].speed_m_per_s=0.0' ";
  const auto under = [&](const std::string& more) {
    return point(solved(own.words() + still + more), "under")[2];
  };
  // reference.md: 574.34 um at mid-bay; the bound is half the last digit.
  CHECK_THAT(under(""), WithinAbs(-574.34e-6, 5e-9));
  CHECK_THAT(under("--set 'load[0].table=[[0.0, 0.5], [1.0, 1.0]]'"),
             WithinRel(under("") / 2., 1e-12));
  CHECK(under("--set 'load[0].table=[[0.1, 1.0]]'") == 0.);
  CHECK(under("--set 'load[0].may_leave_rail=true' --set 'load[0].start_m=-1.0'") == 0.);
}

TEST_CASE("static solves a ballasted track nonlinearly too", "[static]") {
  const OwnScene own(longer("ballasted_track", kUnder + "4.5\n"));
  const nlohmann::json linear = solved(own.words()),
                       bent = solved(own.words() + "--model nonlinear");
  for (const char* name : {"under", "sleeper", "pad"}) point(linear, name);
  const double a = point(linear, "under")[2], b = point(bent, "under")[2];
  // About 0.5 mm under 49 kN and slopes of 1e-3: nonlinear effects are below 1e-3 of it.
  CHECK(a < -3e-4);
  CHECK(a > -1e-3);
  CHECK_THAT(b, WithinRel(a, 1e-3));
  CHECK(b != a);
  // The sleeper next to the wheelset sinks; both ends are alike by mirror symmetry.
  CHECK(bent["residual"].get<double>() < 1e-7);
}

TEST_CASE("static writes the shape of the neutral axis", "[static]") {
  const auto folder = fresh_folder("shape");
  const std::string file = (folder / "axis.csv").string();
  const Ran ran = railstep_program("static " + shipped_word("cantilever_rail") +
                                   "--json --shape '" + file + "'");
  REQUIRE(ran.code == 0);
  const auto tip = point(nlohmann::json::parse(ran.out), "tip");
  std::istringstream lines(text_of(file));
  std::string line, last;
  std::getline(lines, line);
  CHECK(line == "rail,x_m,y_m,z_m,dx_m,dy_m,dz_m");
  std::getline(lines, line);
  CHECK(line == "left,0,0,0,0,0,0");
  int count = 1;
  for (; std::getline(lines, line); ++count) last = line;
  CHECK(count == 41);  // quarters of ten elements
  std::array<double, 6> v{};
  std::replace(last.begin(), last.end(), ',', ' ');
  std::istringstream row(last.substr(5));
  for (double& value : v) row >> value;
  CHECK(v == std::array<double, 6>{2., 0., 0., tip[0], tip[1], tip[2]});
  std::filesystem::remove_all(folder);
}

TEST_CASE("the far end of a rail lies on it for every rounding of its bays", "[static]") {
  // 7 x 0.6 m over elements of 0.6 m gives 7 + 1e-15 in doubles.
  for (const char* model : {"linearised", "nonlinear", "timoshenko"})
    CHECK(railstep_program(
              "static " + shipped_word("cantilever_rail") +
              "--set track.bays=7 --set track.bay_m=0.6 --set 'sensor[0].position_m=4.2' "
              "--set 'rail.rule.shear=\"twist\"' --model " +
              model)
              .code == 0);
}

TEST_CASE("without an equilibrium the exit code is 1 and the history is printed", "[static]") {
  const auto folder = fresh_folder("shape");
  const std::string file = (folder / "axis.csv").string();
  const Ran ran = railstep_program("static " + shipped_word("cantilever_rail") +
                                   "--set static.most_iterations=1 --set "
                                   "static.most_load_halvings=2 --json --shape '" +
                                   file + "'");
  CHECK(ran.code == 1);
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told["points"].empty());
  REQUIRE(told["errors"].size() == 1);
  CHECK(told["errors"][0]["id"] == "E-STATIC-02");
  CHECK(told["warnings"].empty());
  CHECK_THAT(ran.err, Contains("E-STATIC-02") && Contains("load factor"));
  CHECK_THAT(ran.err, Contains("0.25"));  // the last of two halvings
  CHECK_FALSE(std::filesystem::exists(file));
  std::filesystem::remove_all(folder);
  // Load steps that are small enough reach the equilibrium.
  CHECK(railstep_program("static " + shipped_word("cantilever_rail") +
                         "--set static.most_iterations=3 " + "--set static.tolerance=1e-3")
            .code == 0);
}

TEST_CASE("static refuses in one sentence what it cannot solve", "[static]") {
  const std::string rail = "static " + shipped_word("cantilever_rail"),
                    beam = "static " + shipped_word("cantilever_beam");
  refuse(rail + "--model elastic", "--model");
  refuse(rail + "--set 'track.model=\"beam\"'", "timoshenko");
  refuse(rail + "--set 'track.ends=\"free\"'", "E-TRACK-35");
  refuse(beam + "--set 'track.ends=\"free\"'", "E-TRACK-35");
  refuse(rail + "--set 'track.unknowns=\"vertical\"'", "E-SCENE-08");
  refuse(beam + "--set track.rails=2 --set 'load[0].rail=\"left\"' --set 'sensor[0].rail=\"left\"'",
         "E-TIMOSHENKO-01");
  refuse(beam + "--set 'track.reference_line=\"foot\"'", "centroid");
  refuse("static " + shipped_word("ballasted_track") + "--model timoshenko", "E-TIMOSHENKO-01");
  refuse(rail + "--set 'rail.outline=\"exact\"'", "E-RAIL-04");
  refuse(rail + "--set rail.rule.section_points=4", "section_points");
  refuse(rail + "--set rail.rule.axial_points=6", "axial_points");
  refuse(rail + "--set 'rail.element=\"paper\"'", "E-KEY-02");
  refuse(rail + "--set track.axial_points=3", "E-KEY-02");
  refuse(rail + "--set static.tolerance=0.0", "tolerance");
}

TEST_CASE("a section given by constants has no shape for nonlinear bending", "[static]") {
  const OwnScene own(
      "schema = 1\n[track]\nunknowns = \"full\"\nrails = 1\nbays = 10\n"
      "bay_m = 0.2\nelements_per_bay = 1\nends = [\"clamped\", \"free\"]\n"
      "[rail.constants]\narea_m2 = 8.7e-3\ninertia_y_m4 = 39.0e-6\n"
      "inertia_z_m4 = 6.0e-6\ntorsion_m4 = 1.9514e-6\nshear_factor_y = 0.4796\n"
      "shear_factor_z = 0.4721\ncentroid_height_m = 0.085\n"
      "shear_centre_height_m = 0.0459\nheight_m = 0.1857375\n"
      "[[load]]\nname = \"end\"\nstart_m = 2.0\nforce_z_n = -63.0e3\n"
      "[[sensor]]\nname = \"tip\"\non = \"rail\"\nposition_m = 2.0\n");
  const std::string words = "static " + own.words();
  CHECK(railstep_program(words).code == 0);
  refuse(words + "--model nonlinear", "third and fourth degree");
  refuse(words + "--set rail.rule.section_points=2", "not given by rectangles");
}

TEST_CASE("run steps the linearised rail about its centroid only", "[static]") {
  refuse("run " + shipped_word("wheelset_on_track") + "--set 'track.model=\"nonlinear\"'",
         "linearised");
  refuse("run " + shipped_word("wheelset_on_track") + "--set 'track.reference_line=\"foot\"'",
         "centroid");
  refuse("condense " + shipped_word("ballasted_track") +
             "--out /dev/null --set 'track.model=\"nonlinear\"'",
         "linearised");
}
