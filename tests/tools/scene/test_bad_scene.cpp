#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "support/bad_input.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

const std::string kPendulum = shipped("double_pendulum");

std::string set(const std::string& override) { return " --set '" + override + "'"; }

/// Checks that a run of a scene with replaced keys is refused and keeps an old trace and recording.
void run_refuses(const std::string& scene, const Words& overrides, const Words& said) {
  const BadInput bad("scene");
  std::string words = "run " + scene;
  for (const std::string& each : overrides) words += set(each);
  bad.refused(words + bad.old("--trace", "t.csv") + bad.old("--record", "r.bin"), said);
}

/// Checks that a scene of this text is refused; its line and column are among the words.
void text_refused(const std::string& text, const Words& said) {
  const BadInput bad("text");
  bad.refused("run " + bad.file("bad.toml", text) + bad.old("--trace", "t.csv"), said);
}

std::string moving_load() { return text_of(kMovingLoad); }

/// Checks that the shipped scene is refused after `old` was replaced by `fresh`.
void text_refused(const std::string& old, const std::string& fresh, const Words& said) {
  text_refused(replaced(moving_load(), old, fresh), said);
}

}  // namespace

TEST_CASE("an unknown key is refused with the nearest known one", "[bad_input][cli]") {
  run_refuses(kMovingLoad, {"support.stifness_z_n_per_m=1"},
              {"[support]", "'stifness_z_n_per_m'", "'stiffness_z_n_per_m'", "E-KEY-02"});
  run_refuses(kMovingLoad, {"suport.at=\"axis\""}, {"'suport'", "'support'", "E-KEY-02"});
  run_refuses(kMovingLoad, {"load[1].sped_m_per_s=1"},
              {"[load[1]]", "'sped_m_per_s'", "'speed_m_per_s'", "E-KEY-02"});
  run_refuses(kPendulum, {"beam[0].youngs_pa=1e6"},
              {"[beam[0]]", "'youngs_pa'", "'young_pa'", "E-KEY-02"});
  run_refuses(kPendulum, {"joint[0].betwen=[]"}, {"'betwen'", "'between'", "E-KEY-02"});
  text_refused("bay_m = 0.6", "bay = 0.6",
               {"bad.toml:9:1", "[track]", "'bay_m'", "'bay'", "E-KEY-01"});
}

TEST_CASE("a value that the contact of wheels and rails follows from is refused at its own key",
          "[bad_input][cli]") {
  for (const char* scene : {"manchester_s1002", "manchester_ring"})
    run_refuses(shipped(scene), {"rail.crown_radius_m=3e8"},
                {"[rail]", "crown_radius_m = 300000000 is out of range", "E-KEY-05"});
}

TEST_CASE("patches are counted from one on, and are those of profiles", "[bad_input][cli]") {
  for (const char* count : {"0", "4"})
    run_refuses(shipped("manchester_s1002"), {std::string("contact.patches=") + count},
                {"[contact]", "patches", "E-KEY-05"});
  run_refuses(shipped("manchester_ring"), {"contact.patches=1"}, {"'patches'", "E-KEY-02"});
}

TEST_CASE("a key given twice is refused at its second place", "[bad_input][cli]") {
  text_refused("bays = 16", "bays = 16\nbays = 3", {"bad.toml:9:", "bays"});
  text_refused(moving_load() + "[support]\nat = \"foot\"\n", {"bad.toml:46:", "support"});
  text_refused("schema = 1\n", "schema = 1\nrail.rectangle = {}\n", {"bad.toml:13:", "rectangle"});
}

TEST_CASE("a number given as text is refused", "[bad_input][cli]") {
  text_refused("bays = 16", "bays = \"16\"",
               {"bad.toml:8:8", "[track] bays = \"16\"", "integer", "E-KEY-03"});
  text_refused("dt_s = 25.0e-6", "dt_s = '25e-6'", {"[step] dt_s = \"25e-6\"", "E-KEY-03"});
  run_refuses(kMovingLoad, {"rail.young_pa=true"}, {"young_pa = true", "E-KEY-03"});
  run_refuses(kMovingLoad, {"rail.young_pa=[210e9]"}, {"young_pa", "array", "E-KEY-03"});
  run_refuses(kMovingLoad, {"rail.young_pa=2020-01-01"}, {"young_pa", "date", "E-KEY-03"});
  run_refuses(kMovingLoad, {"track.bays=1.5"}, {"bays = 1.5", "E-KEY-03"});
  run_refuses(kMovingLoad, {"load[0].may_leave_rail=1"}, {"may_leave_rail", "integer", "E-KEY-03"});
}

TEST_CASE("impossible masses, stiffnesses and lengths are refused", "[bad_input][cli]") {
  const struct {
    std::string scene, override, said;
  } cases[] = {
      {kMovingLoad, "rail.young_pa=0", "young_pa = 0"},
      {kMovingLoad, "rail.density_kg_per_m3=-7850", "density_kg_per_m3 = -7850"},
      {kMovingLoad, "rail.rectangle.width_m=0", "width_m = 0"},
      {kMovingLoad, "track.bay_m=-0.6", "bay_m = -0.6"},
      {kMovingLoad, "track.bays=0", "bays = 0"},
      {kMovingLoad, "support.stiffness_z_n_per_m=-1", "stiffness_z_n_per_m = -1"},
      {kMovingLoad, "support.damping_z_n_s_per_m=-1", "damping_z_n_s_per_m = -1"},
      {kWheelset, "wheelset[0].mass_kg=0", "mass_kg = 0"},
      {kWheelset, "wheelset[0].mass_kg=-100", "mass_kg = -100"},
      {shipped("ballasted_track"), "sleeper.mass_kg=-1", "mass_kg = -1"},
      {shipped("slider_crank"), "body[0].mass_kg=0", "mass_kg = 0"},
      {kPendulum, "beam[0].length_m=0", "length_m = 0"},
      {kPendulum, "beam[0].density_kg_per_m3=0", "density_kg_per_m3 = 0"},
      {kPendulum, "beam[0].rectangle={height_m=0.02, width_m=-0.03}", "width_m = -0.03"},
  };
  for (const auto& c : cases)
    run_refuses(c.scene, {c.override}, {c.override.substr(0, 8), c.said, "E-KEY-05"});
  const BadInput good("massless");  // a sleeper may weigh nothing
  CHECK(railstep_program("run " + shipped("ballasted_track") + " --model full --duration 1e-3" +
                         set("sleeper.mass_kg=0"))
            .code == 0);
}

TEST_CASE("millimetres given as metres are refused in a scene", "[bad_input][cli]") {
  for (const char* override : {"track.bay_m=600", "track.rail_spacing_m=1500",
                               "rail.rectangle.height_m=231.9", "support.half_spread_m=70"})
    run_refuses(kMovingLoad, {override}, {"E-KEY-05", "millimetres"});
  run_refuses(kWheelset, {"wheelset[0].radius_m=460"}, {"radius_m = 460", "millimetres"});
}

TEST_CASE("a rail's modulus given in N/mm2 is refused with the unit named", "[bad_input][cli]") {
  run_refuses(kMovingLoad, {"rail.young_pa=210e3"}, {"young_pa = 210000", "N/mm2", "E-KEY-05"});
}

TEST_CASE("a stiffness out of range brings no question about millimetres", "[bad_input][cli]") {
  const Ran ran = railstep_program("run " + kMovingLoad + set("support.stiffness_z_n_per_m=3e13"));
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Catch::Contains("stiffness_z_n_per_m = 30000000000000"));
  CHECK_THAT(ran.err, !Catch::Contains("millimetres"));
}

TEST_CASE("a section file with constants that no shape has is refused", "[bad_input][cli]") {
  const BadInput bad("section");
  const auto refused = [&](const char* area, const char* inertia, const Words& said) {
    const std::string file = bad.file(
        "section.toml",
        std::string("schema = 1\n[section]\n") + area + "\n" + inertia +
            "\ninertia_z_m4 = 5.12e-6\ntorsion_m4 = 2e-6\nshear_factor_y = 0.5\n"
            "shear_factor_z = 0.4\ncentroid_height_m = 0.08\nshear_centre_height_m = 0.04\n"
            "height_m = 0.172\n");
    bad.refused("run " + kWheelset + set("rail={section=\"" + file + "\"}"), said);
  };
  refused("area_m2 = 7670.0", "inertia_y_m4 = 3.038e-5",
          {"section.toml:3:", "area_m2 = 7670", "E-KEY-05"});
  refused("area_m2 = 7.67e-3", "inertia_y_m4 = 3038e-6",  // cm4 times 1e-6 instead of 1e-8
          {"section.toml:4:", "inertia_y_m4 = 0.003038", "5.645e-05", "E-SECTION-28"});
}

TEST_CASE("a record that does not reach the track is refused with both ranges of places",
          "[bad_input][cli]") {
  const BadInput bad("record");
  std::string rows = "distance_m,vertical_mm\n";
  for (int i = 0; i < 40; ++i) rows += std::to_string(12345 + i) + ",0.5\n";
  const std::string file = bad.file("chainage.csv", rows);
  bad.refused("run " + shipped("corrugation") + set("defect=[]") +
                  set("irregularity={file=\"" + file + "\"}"),
              {"chainage.csv", "from 0 to 24 m", "E-SCENE-37"});
}

TEST_CASE("a step that is 0 or NaN or exceeds the duration is refused", "[bad_input][cli]") {
  for (const char* step : {"0", "-1e-3", "nan", "inf", "1", "1e-300"})
    run_refuses(kMovingLoad, {"step.dt_s=" + std::string(step)},
                {"[step] dt_s = ", "at least 1e-07, at most 0.1"});
  run_refuses(kMovingLoad, {"step.dt_s=0.05", "step.frame_s=0.05", "step.duration_s=0.01"},
              {"dt_s = 0.05", "E-STEP-07"});
  run_refuses(kMovingLoad, {"step.frame_s=7e-5"}, {"frame_s = 7e-05", "E-STEP-06"});
  for (const char* duration : {"0", "-1", "nan", "1e300"})
    run_refuses(kMovingLoad, {"step.duration_s=" + std::string(duration)},
                {"[step] duration_s = ", "above 0"});
}

TEST_CASE("a spectral radius outside 0 to 1 is refused", "[bad_input][cli]") {
  for (const char* rho : {"-0.1", "1.1", "nan"})
    for (const std::string& scene : {kMovingLoad, kPendulum})
      run_refuses(scene, {"step.rho_inf=" + std::string(rho)},
                  {"[step] rho_inf = " + std::string(rho), "at least 0, at most 1"});
}

TEST_CASE("a Poisson's ratio outside -1 to 0.5 or at either end is refused", "[bad_input][cli]") {
  for (const char* nu : {"-2", "-1", "0.5", "0.6", "nan"}) {
    run_refuses(kMovingLoad, {"rail.poisson=" + std::string(nu)},
                {"[rail] poisson = " + std::string(nu), "above -1, below 0.5"});
    run_refuses(kPendulum, {"beam[0].poisson=" + std::string(nu)}, {"poisson", "above -1, below"});
  }
}

TEST_CASE("an unknown sensor or body is refused with the known ones", "[bad_input][cli]") {
  run_refuses(kMovingLoad, {"sensor=[{name=\"s\", on=\"wheel\"}]"},
              {"[sensor[0]] on = \"wheel\"", "\"rail\", \"sleeper\", \"wheelset\", \"vehicle\""});
  run_refuses(kWheelset, {"sensor[0].wheelset=\"front\""},
              {"[sensor[0]] wheelset = \"front\"", "\"wheelset\""});
  run_refuses(kPendulum, {"sensor[0].on=\"middle\""},
              {"[sensor[0]] on has \"middle\"", "\"upper\", \"lower\""});
  run_refuses(kPendulum, {"joint[0].between=[\"ground\", \"middle\"]"},
              {"[joint[0]] between has \"middle\"", "\"ground\", \"upper\", \"lower\""});
  const BadInput bad("receptance");
  bad.refused("receptance " + shipped("receptance_s1") + " --at middle --from 30 --to-hz 100" +
                  bad.old("--csv", "c.csv"),
              {"middle", "mid_bay"});
}

TEST_CASE("a name given twice is refused with its owner", "[bad_input][cli]") {
  run_refuses(kMovingLoad, {"load[1].name=\"load_left\""},
              {"[load[1]] name = \"load_left\" is taken by [load[0]]", "E-RUNNER-19"});
  run_refuses(kMovingLoad,
              {"sensor=[{name=\"load_left\", on=\"rail\", position_m=1, rail=\"left\"}]"},
              {"[sensor[0]] name = \"load_left\" is taken by [load[0]]"});
  run_refuses(kPendulum, {"beam[1].name=\"upper\""}, {"[beam[1]] name = \"upper\" is taken by"});
  run_refuses(kPendulum, {"sensor[1].name=\"A\""}, {"[sensor[1]] name = \"A\" is taken by"});
  run_refuses(kPendulum, {"joint[0].name=\"lower\""}, {"name = \"lower\" is taken by [beam[1]]"});
  run_refuses(kMovingLoad, {"load[0].name=\"\""}, {"[load[0]] name", "E-KEY-09"});
  run_refuses(kMovingLoad, {"load[0].name=\"a,b\""}, {"name = \"a,b\"", "E-RUNNER-14"});
}

TEST_CASE("a load that leaves its rail is refused unless may_leave_rail is set",
          "[bad_input][cli]") {
  run_refuses(kMovingLoad, {"step.duration_s=0.4"},
              {"moving_load.toml:31:", "x = 12.3 m", "0 to 9.6 m", "E-RUNNER-07"});
  run_refuses(kMovingLoad, {"load[1].start_m=-0.1"}, {"[load[1]] start_m = -0.1", "at most 9.6"});
  const Ran ran =
      railstep_program("run " + kMovingLoad + " --duration 0.4" +
                       set("load[0].may_leave_rail=true") + set("load[1].may_leave_rail=true"));
  CHECK(ran.code == 0);
}

TEST_CASE("a free rigid mode is refused with its name", "[bad_input][cli]") {
  const Words named = {"moving_load.toml", "E-TRACK-35", "the rails along z",
                       "support.stiffness_z_n_per_m"};
  const std::string loose = kMovingLoad + set("support.stiffness_z_n_per_m=0");
  const BadInput bad("free");
  const std::string out = bad.old("--out", "x.model"), shape = bad.old("--shape", "s.csv");
  run_refuses(kMovingLoad, {"support.stiffness_z_n_per_m=0"}, named);
  run_refuses(kMovingLoad, {"support.stiffness_z_n_per_m=0", "condense={kind=\"modal\"}"}, named);
  bad.refused("static " + loose + shape, named);
  bad.refused("condense " + loose + out, named);
  run_refuses(
      kWheelset, {"support.stiffness_x_n_per_m=0"},
      {"wheelset_on_track.toml", "E-TRACK-35", "the rails along x", "support.stiffness_x_n_per_m"});
}

TEST_CASE("compression at which the rails buckle is refused with both forces", "[bad_input][cli]") {
  const Words both = {"moving_load.toml", "E-TRACK-33", "1e+08 N",
                      "2.934146e+07 N, most at x = ", "axial_force_n"};
  const std::string pressed = kMovingLoad + set("rail.axial_force_n=-1e8");
  const BadInput bad("buckled");
  run_refuses(kMovingLoad, {"rail.axial_force_n=-1e8"}, both);
  bad.refused("static " + pressed + bad.old("--shape", "s.csv"), both);
  bad.refused("modes " + pressed, both);
  bad.refused("condense " + pressed + bad.old("--out", "x.model"), both);
}

TEST_CASE("a track of too many elements is refused with the bytes it would need",
          "[bad_input][cli]") {
  const BadInput bad("huge");
  const Words bytes = {"[track] bays = 1000000000 makes 2000000000 elements", "3.07e+12 bytes",
                       "E-SCENE-11"};
  const std::string huge = kMovingLoad + set("track.bays=1000000000");
  for (const std::string command : {"static ", "modes "}) bad.refused(command + huge, bytes);
  bad.refused("condense " + huge + bad.old("--out", "x.model"), bytes);
  run_refuses(kMovingLoad, {"track.bays=1000000000"}, bytes);
  run_refuses(kMovingLoad, {"track.bays=100000", "track.elements_per_bay=1000"},
              {"200000000 elements", "bytes", "E-SCENE-11"});
  run_refuses(kPendulum, {"beam[0].elements=1000000000"},
              {"[beam[0]] elements = 1000000000", "E-KEY-05"});
}

TEST_CASE("integers over 2^63, NUL and text that is not UTF-8 are refused", "[bad_input][cli]") {
  text_refused("bays = 16", "bays = 9223372036854775808", {"bad.toml:8:", "E-FILE-09"});
  run_refuses(kMovingLoad, {"track.bays=9223372036854775808"}, {"9223372036854775808"});
  run_refuses(kMovingLoad, {"track.bays=9223372036854775807"},
              {"bays = 9223372036854775807", "E-KEY-05"});
  text_refused("schema = 1", std::string("schema\0= 1", 10), {"bad.toml:3:7", "E-FILE-08"});
  text_refused("[step]", "# \xff\xfe\n[step]", {"bad.toml:41:", "utf-8", "E-FILE-09"});
  text_refused("[step]", "# \xc3(\n[step]", {"bad.toml:41:", "utf-8", "E-FILE-09"});
  run_refuses(kMovingLoad, {"load[0].name=\"\xff\""}, {"E-SET-02"});
}

TEST_CASE("a hundred thousand nested arrays are refused", "[bad_input][cli]") {
  const std::string deepest = "E-FILE-02";
  const std::string text = moving_load();
  const auto many = [](const std::string& piece) {
    std::string all;
    for (int i = 0; i < 100'000; ++i) all += piece;
    return all;
  };
  text_refused("deep = " + many("[") + many("]") + "\n" + text, {"bad.toml:1:40", deepest});
  text_refused("deep = " + many("{a=") + "\n" + text, {"bad.toml:1:", deepest});
  text_refused("[" + many("a.") + "a]\n", {"bad.toml:1:", deepest});
  text_refused("wide = [" + many("[],") + "]\n" + text, {"bad.toml:1:", "'wide'", "E-KEY-02"});
  // One word of a command line holds at most 128 KiB.
  run_refuses(kMovingLoad, {"track.bays=" + many("[")}, {"--set track.bays=[[", "E-SET-02"});
  run_refuses(kMovingLoad, {many("a").substr(0, 60'000) + "=1"}, {"--set aaa", "E-KEY-02"});
}

TEST_CASE("a scene that is not a readable file is refused", "[bad_input][cli]") {
  const BadInput bad("no_scene");
  const std::string trace = bad.old("--trace", "t.csv");
  std::filesystem::create_directory(bad.path("folder"));
  bad.refused("run " + bad.path("folder") + trace, {"folder: ", "E-FILE-03"});
  bad.refused("run " + bad.path("none.toml") + trace, {"none.toml: ", "E-FILE-04"});
  bad.refused("run " + bad.file("empty.toml", "") + trace, {"empty.toml: ", "E-FILE-07"});
  bad.refused("run /dev/zero" + trace, {"/dev/zero: ", "1048576", "E-FILE-06"});
  bad.refused("run /proc/self/mem" + trace, {"/proc/self/mem: ", "E-FILE-05"});
  if (geteuid() != 0) {  // root may read every file
    std::filesystem::permissions(bad.file("closed.toml", "schema = 1\n"),
                                 std::filesystem::perms::none);
    const Ran ran = railstep_program("run " + bad.path("closed.toml"));
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains("closed.toml: ") && Catch::Contains("E-FILE-04"));
  }
}

TEST_CASE("a scene may come through a pipe", "[bad_input][cli]") {
  CHECK(
      run_program(RAILSTEP_PROGRAM, "run /dev/stdin --duration 0.01", "cat '" + kMovingLoad + "' |")
          .code == 0);
  const BadInput bad("pipe");
  bad.refused("run /dev/stdin" + bad.old("--trace", "t.csv") + " </dev/null",
              {"stdin", "E-FILE-07"});
}
