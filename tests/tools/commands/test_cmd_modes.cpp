// The program's modes command on the shipped scenes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "scene/scene.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

struct Listed {
  std::vector<double> hz, ratio;
};

Listed modes_of(const std::string& words) {
  const Ran ran = railstep_program("modes --json " + words);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  const auto json = nlohmann::json::parse(ran.out);
  CHECK(json.size() == 4);
  CHECK(json.at("errors").empty());
  CHECK(json.at("warnings").empty());
  Listed found{json.at("frequencies_hz").get<std::vector<double>>(),
               json.at("damping_ratios").get<std::vector<double>>()};
  CHECK(found.hz.size() == found.ratio.size());
  CHECK(std::is_sorted(found.hz.begin(), found.hz.end()));
  return found;
}

/// Expects exit code 2 and one error, in words with this among them and as JSON.
void check_modes_refused(const std::string& words, const std::string& sentence) {
  const Ran ran = railstep_program("modes --json " + words);
  INFO(words << ": " << ran.err);
  CHECK(ran.code == 2);
  CHECK(nlohmann::json::parse(ran.out).at("errors").size() == 1);
  CHECK_THAT(ran.err, Catch::Contains(sentence));
  CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("a free rail has six rigid modes and the published frequencies", "[modes]") {
  // reference.md, free-free 2 m rail: 117.3, 166.4, 290.3, 298.8 Hz. The bound of 0.2 Hz covers its
  // unstated mesh and the rounding of its print.
  const Listed found = modes_of(shipped("free_rail"));
  REQUIRE(found.hz.size() == 10);
  for (std::size_t i = 0; i < 6; ++i) CHECK(found.hz[i] == 0.);
  const double expected[4] = {117.3, 166.4, 290.3, 298.8};
  for (std::size_t i = 0; i < 4; ++i) CHECK_THAT(found.hz[6 + i], WithinAbs(expected[i], .2));
  for (const double ratio : found.ratio) CHECK(ratio == 0.);
}

TEST_CASE("a pinned bay has the closed form's frequency and its mesh errors", "[modes]") {
  // Timoshenko's lower root for one half wave on 0.6 m with k_z = .472: 1141.4281 Hz. (reference.md
  // prints 1141.44: half a unit of k_z's last digit is .05 Hz.) The element's error is about
  // (pi/16)^4/720 = 2e-6 on the shipped mesh; the bound is twice that.
  const double closed = 1141.4281487;
  CHECK_THAT(modes_of(shipped("pinned_bay") + " --count 1").hz[0], WithinRel(closed, 4e-6));
  // The errors are +6.8, +0.82 and +0.056 % with 1, 2 and 4 elements, to half the last digit.
  const auto error = [closed](int elements) {
    const Listed found =
        modes_of(shipped("pinned_bay") +
                 " --count 1 --set track.elements_per_bay=" + std::to_string(elements));
    return 100. * (found.hz[0] / closed - 1.);
  };
  CHECK_THAT(error(1), WithinAbs(6.8, .05));
  CHECK_THAT(error(2), WithinAbs(.82, .005));
  CHECK_THAT(error(4), WithinAbs(.056, .0005));
}

TEST_CASE("without its dampers a ballasted track has the modes of a dense solution", "[modes]") {
  const std::vector<std::string> still = {"track.bays=12",
                                          "support.damping_x_n_s_per_m=0",
                                          "support.damping_y_n_s_per_m=0",
                                          "support.damping_z_n_s_per_m=0",
                                          "ballast.damping_z_n_s_per_m=0",
                                          "wheelset[0].start_m=0.3",
                                          "step.duration_s=0.05"};
  std::string words = shipped("ballasted_track") + " --count 40";
  for (const std::string& option : still) words += " --set " + option;
  words += " --set sensor[0].sleeper=3 --set sensor[1].position_m=1.8";
  const Listed found = modes_of(words);
  std::vector<std::string> overrides = still;
  overrides.insert(overrides.end(), {"sensor[0].sleeper=3", "sensor[1].position_m=1.8"});
  std::vector<double> all;
  for (const Line& line : assemble(track_of(read_scene(shipped("ballasted_track"), overrides))))
    for (const double f : modes(line).frequency) all.push_back(f);
  std::sort(all.begin(), all.end());
  REQUIRE(found.hz.size() == 40);
  for (std::size_t i = 0; i < 40; ++i) {
    // Rounding of the dense solution: 1e-16 of the highest square (1e5 Hz)^2 over (60 Hz)^2.
    CHECK_THAT(found.hz[i], WithinRel(all[i], 1e-9));
    CHECK(found.ratio[i] == 0.);
  }
}

TEST_CASE("with dampers each mode of a ballasted track has a damping ratio between 0 and 1",
          "[modes]") {
  const Listed found = modes_of(shipped("ballasted_track") + " --count 20");
  REQUIRE(found.hz.size() == 20);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(found.hz[i] > 0.);
    CHECK(found.ratio[i] > 0.);
    CHECK(found.ratio[i] < 1.);
  }
  // More modes do not change the first ones; a mode's forces are in balance to 1e-8.
  const Listed few = modes_of(shipped("ballasted_track") + " --count 3");
  REQUIRE(few.hz.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(few.hz[i], WithinRel(found.hz[i], 1e-8));
}

TEST_CASE("strong dampers hold their seats still", "[modes]") {
  // Dampers twice as strong as 29e6 N s/m leave the lateral mode between seats where it is: its
  // remaining motion at the seats is of the order of the rail's own force over c w.
  const Listed found = modes_of(shipped("wheelset_on_track") + " --count 24");
  CHECK(found.hz.size() == 24);
  const Listed twice =
      modes_of(shipped("wheelset_on_track") + " --count 24 --set support.damping_y_n_s_per_m=58e6");
  for (std::size_t i = 0; i < 24; ++i) {
    CHECK(found.ratio[i] > 0.);
    CHECK_THAT(twice.hz[i], WithinRel(found.hz[i], 1e-3));
  }
}

TEST_CASE("the table shows the same modes as the JSON", "[modes]") {
  const Ran ran = railstep_program("modes --count 8 " + shipped("free_rail"));
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Catch::Contains("frequency, Hz") && Catch::Contains("166.3"));
  CHECK(std::count(ran.out.begin(), ran.out.end(), '\n') == 9);
}

TEST_CASE("modes refuses a scene that makes no track", "[modes]") {
  const std::string bay = shipped("pinned_bay");
  check_modes_refused(bay + " --set 'track.ends=\"pined\"'", "E-KEY-06");
  check_modes_refused(bay + " --set 'track.ends=[\"pinned\"]'", "E-KEY-07");
  check_modes_refused(bay + " --set 'track.ends=[\"pinned\", 3]'", "pinned");
  check_modes_refused(bay + " --set track.ends=true", "one of");
  check_modes_refused(bay + " --set sleeper.mass_kg=3", "ballast");
  check_modes_refused("no_such_scene.toml", "no_such_scene.toml");
  for (const char* count : {"0", "-1", "1001", "ten"}) {
    const Ran ran = railstep_program("modes " + bay + " --count " + count);
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK_THAT(ran.err, Catch::Contains("--count"));
  }
  // A scene of few unknowns lists all its modes: 3 heights less two pins, and 3 slopes.
  const std::string coarse = bay + " --count 1000 --set track.elements_per_bay=1";
  CHECK(modes_of(coarse).hz.size() == 4);
}

TEST_CASE("the warning about a lopsided section is in the JSON too", "[modes]") {
  const auto section = fresh_folder("modes_lopsided") / "section.toml";
  std::ofstream(section) << "schema = 1\n[section]\narea_m2 = 7.67e-3\ninertia_y_m4 = 3.038e-5\n"
                            "inertia_z_m4 = 5.12e-6\ntorsion_m4 = 2e-6\nshear_factor_y = 0.5\n"
                            "shear_factor_z = 0.4\ncentroid_height_m = 0.08\n"
                            "shear_centre_height_m = 0.04\nheight_m = 0.172\n[asymmetry]\n"
                            "share_of_area = 0.1\nproduct_of_inertia_m4 = 2e-6\n"
                            "centroid_offset_m = 1e-3\nshear_centre_offset_m = 1e-3\n";
  const Ran ran = railstep_program("modes " + shipped("free_rail") +
                                   " --count 1 --json --set 'rail={section=\"" + section.string() +
                                   "\", young_pa=2.1e11, density_kg_per_m3=7850}'");
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto told = nlohmann::json::parse(ran.out);
  REQUIRE(told["warnings"].size() == 1);
  CHECK(told["warnings"][0]["id"] == "W-SECTION-01");
  CHECK_THAT(ran.err, Catch::Contains(told["warnings"][0]["text"].get<std::string>()));
}

TEST_CASE("run and condense refuse a scene without [step]", "[modes]") {
  for (const std::string& words :
       {"run " + shipped("pinned_bay") + " --set 'load=[{name=\"l\",start_m=0.3,force_z_n=-1.0}]'",
        "condense " + shipped("pinned_bay") +
            " --out x --set 'load=[{name=\"l\",start_m=0.3,force_z_n=-1.0}]'"}) {
    const Ran ran = railstep_program(words);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains("[step]"));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
  }
}

namespace {

/// A pinned rail of section F, 3 m long, with this axial force.
std::string three_metres(const std::string& unknowns, double force) {
  return shipped("pinned_bay") + " --set track.bay_m=3 --set 'track.unknowns=\"" + unknowns +
         "\"' --set track.elements_per_bay=40 --set rail.axial_force_n=" + std::to_string(force);
}

/// P/(4 m L^2) of three_metres, 1/s2; reference.md, section F: A = 8700 mm2.
double unit_of(double compression) { return compression / (4. * 7850. * 8.7e-3 * 9.); }

}  // namespace

TEST_CASE("compression lowers the frequency of each mode between pins by the same law",
          "[modes][preload]") {
  // hard-cases.md, R7: f_10 59.49949 Hz, P_cr 8.703979 MN, 18.81539 and 5.94995 Hz at .9 and .99 of
  // it. R7 has its own k_z, here it is .472: 1e-4 of the share of shear (2 %). Bounds of the last
  // two are 1e-4 and 1e-3.
  const Listed bent = modes_of(three_metres("vertical", 0.) + " --count 4");
  CHECK_THAT(bent.hz[0], WithinRel(59.49949, 1e-5));
  CHECK_THAT(modes_of(three_metres("vertical", -.9 * 8.703979e6) + " --count 1").hz[0],
             WithinRel(18.81539, 1e-4));
  CHECK_THAT(modes_of(three_metres("vertical", -.99 * 8.703979e6) + " --count 1").hz[0],
             WithinRel(5.94995, 1e-3));
  for (const double part : {-.5, .9, .99}) {
    const double unit = unit_of(part * 8.703979e6);
    const Listed pressed = modes_of(three_metres("vertical", -part * 8.703979e6) + " --count 4");
    for (std::size_t n = 1; n <= 4; ++n)  // H13: the law to 1e-3
      CHECK_THAT(pressed.hz[n - 1], WithinRel(std::sqrt(std::pow(bent.hz[n - 1], 2) -
                                                        static_cast<double>(n * n) * unit),
                                              1e-3));
  }
}

TEST_CASE("in three dimensions each mode between pins has its number of half waves",
          "[modes][preload]") {
  // (f_0^2 - f^2)/(P/(4 m L^2)) = n^2, to H13's 1e-3, for vertical bending, lateral bending and
  // torsion. The 17 lowest modes keep their order and hold n = 1 to 4 of all three.
  const Listed free = modes_of(three_metres("full", 0.) + " --count 17");
  const double critical = 4. * 7850. * 8.7e-3 * 9. * free.hz[0] * free.hz[0];
  for (const double part : {.9, .99}) {
    const double P = part * critical;
    const Listed pressed = modes_of(three_metres("full", -P) + " --count 17");
    std::vector<int> times(10, 0);
    for (std::size_t i = 0; i < 17; ++i) {
      const double square = (std::pow(free.hz[i], 2) - std::pow(pressed.hz[i], 2)) / unit_of(P);
      const double n = std::round(std::sqrt(square));
      CAPTURE(part, i, free.hz[i], square);
      CHECK_THAT(square, WithinRel(n * n, 1e-3));
      ++times.at(static_cast<std::size_t>(n));
    }
    for (const std::size_t n : {1UL, 2UL, 3UL, 4UL}) CHECK(times[n] == 3);
  }
  check_modes_refused(three_metres("full", -1.01 * critical), "buckles at 1356");
}

TEST_CASE("at the critical force the track is refused and the message gives both forces",
          "[modes][preload]") {
  check_modes_refused(three_metres("vertical", -1.01 * 8.703979e6), "8791019 N");
  check_modes_refused(three_metres("vertical", -1.01 * 8.703979e6), "buckles at 870");
  modes_of(three_metres("vertical", -.999 * 8.703979e6));
  // Every command refuses it: a long rail on springs buckles below 2 sqrt(k EI) = 40 MN.
  for (const std::string& words : {"run " + shipped("moving_load"),
                                   "condense " + shipped("moving_load") + " --out no_model"}) {
    const Ran ran = railstep_program(words + " --set rail.axial_force_n=-4e7");
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains("4e+07 N") && Catch::Contains("E-TRACK-33"));
  }
  // A heated rail between pins has the axial force alpha E A dT.
  const std::string rail = three_metres("vertical", 0.);
  const double per_kelvin = 1.15e-5 * 210e9 * 8.7e-3;
  const Listed warm = modes_of(rail + " --set rail.temperature_rise_k=40 --count 1");
  const Listed pressed = modes_of(three_metres("vertical", -40. * per_kelvin) + " --count 1");
  CHECK_THAT(warm.hz[0], WithinRel(pressed.hz[0], 1e-9));  // to_string writes six decimals, 1e-6 N
  CHECK(warm.hz[0] < 58.);
  check_modes_refused(
      rail + " --set rail.temperature_rise_k=40 --set 'track.ends=[\"pinned\",\"free\"]'",
      "free end");
}
