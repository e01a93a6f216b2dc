// [[support_change]] and [rail.right]: seats and rails of a scene that differ.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/analysis/statics.h"
#include "support/program.h"
#include "support/shipped.h"
#include "support/traced.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Overrides = std::vector<std::string>;

namespace {

/// A track whose rail is a plain rectangle, which needs no fit.
Track track(const std::string& name, Overrides overrides) {
  overrides.insert(overrides.begin(), "rail={rectangle={height_m=0.17, width_m=0.045}}");
  return track_of(read_scene(shipped(name), overrides));
}

/// Message for the ballasted track with one change, or "accepted" if it is read and built.
std::string seats_with(const std::string& change, const std::string& name = "ballasted_track") {
  try {
    (void)track(name, {"support_change=[{" + change + "}]"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a change reaches only its seats and its side", "[seats]") {
  const Track t =
      track("ballasted_track", {"support_change=["
                                "{from=3, to=4, rail=\"left\", support={stiffness_z_n_per_m=1e8}},"
                                "{seats=[4, 9], ballast={stiffness_factor=0.5, damping_factor=2}},"
                                "{seats=[7], sleeper={mass_kg=250}}]"});
  CHECK(t.changed_seats.size() == 4);
  CHECK(t.seat(2) == seat_of(t.support, t.sleeper));
  CHECK(t.seat(3).pad[0].stiffness == std::array<double, 3>{50e6, 50e6, 1e8});
  CHECK(t.seat(3).pad[1] == t.support);
  CHECK(t.seat(4).pad[0].stiffness[2] == 1e8);
  for (const std::size_t side : {0u, 1u}) {
    CHECK(t.seat(4).ballast[side].stiffness[2] == 25e6);
    CHECK(t.seat(9).ballast[side].damping[2] == 160e3);
  }
  CHECK(t.seat(7).sleeper->mass == 250.);
  CHECK(t.seat(7).sleeper->roll_inertia == 169.);
  CHECK_FALSE(is_symmetric(t));
  CHECK(is_symmetric(track("ballasted_track", {"support_change=[{missing=\"ballast\"}]"})));
}

TEST_CASE("two values make a transition along the seats", "[seats]") {
  const Track t = track("ballasted_track",
                        {"support_change=[{from=10, to=14, ballast={stiffness_factor=[1, 3], "
                         "damping_z_n_s_per_m=[80e3, 40e3]}}]"});
  for (int i = 0; i <= 4; ++i) {
    CHECK_THAT(t.seat(10 + i).ballast[0].stiffness[2], WithinRel(50e6 * (1. + .5 * i), 1e-15));
    CHECK_THAT(t.seat(10 + i).ballast[1].damping[2], WithinRel(80e3 - 10e3 * i, 1e-15));
  }
}

TEST_CASE("missing pads, ballast and sleepers carry nothing", "[seats]") {
  const Track t = track("ballasted_track", {"support_change=[{seats=[5], missing=\"pad\"},"
                                            "{seats=[6], rail=\"right\", missing=\"ballast\"},"
                                            "{seats=[7], missing=\"sleeper\"}]"});
  CHECK(t.seat(5).pad[0].stiffness[2] == 0.);
  CHECK(t.seat(5).pad[1].roll_stiffness == 0.);
  CHECK(t.seat(5).ballast[0].stiffness[2] == 50e6);
  CHECK(t.seat(6).ballast[0].stiffness[2] == 50e6);
  CHECK(t.seat(6).ballast[1].stiffness[2] == 0.);
  CHECK(t.seat(6).sleeper.has_value());
  CHECK_FALSE(t.seat(7).sleeper.has_value());
  CHECK(t.seat(7).pad[0].stiffness[2] == 0.);
  // The track still stands, and the other seats carry more.
  const Statics whole(track("ballasted_track", {})), gone(t);
  const RailPoint over{0, 4.2, 0., 0., 2};
  CHECK(gone.flexibility(over, over) > 1.3 * whole.flexibility(over, over));
}

TEST_CASE("scatter is even, follows its seed and is the same on every machine", "[seats]") {
  // The same integers and one division by 2^53, computed without this program.
  CHECK(scatter_factor(7, 0, 3, 0, .2) == 0x1.ae189daca866ep-1);
  CHECK(scatter_factor(7, 2, 3, 1, .2) == 0x1.a4c92fd6aad22p-1);
  CHECK(scatter_factor(0, 0, 0, 0, .5) == 0x1.4704eb7871f97p-1);
  double sum = 0., squares = 0., least = 1., most = 1.;
  constexpr int kSeats = 10000;
  for (int seat = 0; seat < kSeats; ++seat) {
    const double off = scatter_factor(1, 0, seat, 0, .3) - 1.;
    sum += off;
    squares += off * off;
    least = std::min(least, 1. + off);
    most = std::max(most, 1. + off);
  }
  // Mean and variance of 10^4 even draws: 4 standard errors, .3/sqrt 3/100 and .09 * .089/100.
  CHECK(std::abs(sum / kSeats) < 4. * .3 / std::sqrt(3.) / 100.);
  CHECK(std::abs(squares / kSeats - .03) < 4. * .09 * .3 / 100.);
  CHECK(least > .7);
  CHECK(most < 1.3);
  const Track few = track("ballasted_track", {"support_change=[{from=3, to=5, seed=11, "
                                              "support={stiffness_scatter=0.2}}]"});
  const Track all = track("ballasted_track", {"support_change=[{seed=11, support="
                                              "{stiffness_scatter=0.2, damping_scatter=0.4}}]"});
  CHECK(few.seat(4).pad[1].stiffness == all.seat(4).pad[1].stiffness);
  CHECK(few.seat(4).pad[1].damping == few.support.damping);
  CHECK(all.seat(4).pad[0].stiffness[2] != all.seat(4).pad[1].stiffness[2]);
  const double k = all.seat(9).pad[0].stiffness[2] / 200e6,
               c = all.seat(9).pad[0].damping[2] / 20e3;
  CHECK_THAT(all.seat(9).pad[0].stiffness[0], WithinRel(50e6 * k, 1e-15));
  CHECK(std::abs((k - 1.) / .2 - (c - 1.) / .4) > 1e-3);  // each is drawn separately
}

TEST_CASE("bad changes are refused, each in one sentence", "[seats]") {
  CHECK_THAT(seats_with("seats=[41], missing=\"pad\""), Contains("at least 0, at most 40"));
  CHECK_THAT(seats_with("seats=[3.5], missing=\"pad\""),
             Contains("3.5") && Contains("E-SUPPORT-05"));
  CHECK_THAT(seats_with("seats=[4, 3], missing=\"pad\""), Contains("E-SUPPORT-06"));
  CHECK_THAT(seats_with("seats=[4], to=5, missing=\"pad\""), Contains("E-SUPPORT-04"));
  CHECK_THAT(seats_with("from=7, to=5, missing=\"pad\""), Contains("to = 5"));
  CHECK_THAT(seats_with("from=7"), Contains("E-SUPPORT-17"));
  CHECK_THAT(seats_with("missing=\"rail\""),
             Contains("missing = \"rail\"") && Contains("\"ballast\""));
  CHECK_THAT(seats_with("rail=\"left\", missing=\"sleeper\""), Contains("E-SUPPORT-14"));
  CHECK_THAT(seats_with("rail=\"left\", sleeper={mass_kg=1}"), Contains("E-SUPPORT-12"));
  CHECK_THAT(seats_with("seats=[3], ballast={stiffness_factor=[1, 2]}"), Contains("E-SUPPORT-08"));
  CHECK_THAT(seats_with("support={stiffness_z_n_per_m=-1}"), Contains("E-KEY-05"));
  CHECK_THAT(seats_with("support={stifness_z_n_per_m=1}"),
             Contains("'stifness_z_n_per_m'") && Contains("'stiffness_z_n_per_m'"));
  CHECK_THAT(seats_with("ballast={stiffness_y_n_per_m=1e7}"),
             Contains("holds the sleeper along y") && Contains("E-SUPPORT-18"));
  CHECK_THAT(seats_with("ballast={length_m=0.2}"), Contains("E-SUPPORT-10"));
  CHECK_THAT(seats_with("ballast={stiffness_scatter=0.2}"), Contains("seed"));
  CHECK_THAT(seats_with("missing=\"pad\", seed=1"), Contains("E-SUPPORT-16"));
  CHECK_THAT(seats_with("ballast={stiffness_scatter=1.0}, seed=1"), Contains("below 1"));
  CHECK_THAT(seats_with("missing=\"ballast\"", "moving_load"), Contains("E-SUPPORT-13"));
  CHECK_THAT(seats_with("ballast={stiffness_factor=2}", "moving_load"), Contains("E-SUPPORT-11"));
  CHECK_THAT(seats_with("seats=[20], missing=\"sleeper\""),
             Contains("sleeper = 20") && Contains("E-SENSOR-05"));
  CHECK_THAT(seats_with("seats=[19], missing=\"sleeper\""), Contains("accepted"));
  CHECK(seats_with("seats=[19], missing=\"sleeper\"") == "accepted");
}

TEST_CASE("the right rail may differ", "[seats]") {
  const Scene scene =
      read_scene(shipped("ballasted_track"), {"rail.right={profile=\"../profiles/54e1.toml\", "
                                              "young_pa=200e9, axial_force_n=1e5}"});
  const Track t = track_of(scene);
  REQUIRE(t.right);
  // rail-data's 54E1 has 6977 mm2; the fit meets its printed digits.
  CHECK_THAT(t.right->section.area, WithinRel(6977.4e-6, 1e-4));
  CHECK_THAT(t.section.area, WithinRel(7670e-6, 1e-4));
  CHECK(t.right->material.young == 200e9);
  CHECK(t.right->material.density == 7850.);
  CHECK(t.right->axial_force == 1e5);
  CHECK(t.axial_force == 0.);
  // Pads reach each rail's own foot, 80.92 and 75.13 mm below its centroid.
  CHECK_THAT(t.seat(7).pad[0].height_z, WithinAbs(-80.92e-3, 5e-5));
  CHECK_THAT(t.seat(7).pad[1].height_z, WithinAbs(-75.13e-3, 5e-5));
  CHECK_FALSE(is_symmetric(t));
  // The heads are level, so the middle of a rectangle 20 mm lower is 10 mm higher.
  const Scene low =
      read_scene(shipped("ballasted_track"), {"rail={rectangle={height_m=0.17, width_m=0.045}, "
                                              "right={rectangle={height_m=0.15, width_m=0.045}}}"});
  const RailSections sections = sections_of(low);
  const Track uneven = track_of(low);
  CHECK_THAT(rail_z(low, sections, uneven, kRightRail), WithinAbs(.01, 1e-15));
  CHECK(rail_z(low, sections, uneven, kLeftRail) == 0.);
  CHECK_THROWS_WITH(track("pinned_bay", {"rail.right={young_pa=200e9}"}), Contains("E-SCENE-28"));
}

TEST_CASE("the program runs a track whose sides and rails differ", "[seats]") {
  const auto folder = fresh_folder("seats");
  const auto scene = shipped("ballasted_track");
  const auto changes = [](const std::string& seed) {
    return " --set 'rail={rectangle={height_m=0.17, width_m=0.045}, "
           "right={rectangle={height_m=0.15, width_m=0.045}}}' --set 'support_change=[{from=8, "
           "to=9, rail=\"left\", missing=\"ballast\"}, {seed=" +
           seed + ", ballast={stiffness_scatter=0.3}}]'";
  };
  const auto words_of = [&](const std::string& name, const std::string& seed = "3") {
    return "run '" + scene + "' --json --trace '" + (folder / name).string() +
           "' --set track.bays=12 --set step.duration_s=0.01 --set 'sensor=[]' --set "
           "'condense.kind=\"full\"' --set output.supports=true" +
           changes(seed);
  };
  const Ran ran = railstep_program(words_of("once.csv"));
  CHECK(ran.err.empty());
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("\"status\": []"));
  // The wheelset comes to seat 8, where the left rail hangs. A rigid sleeper with ballast under its
  // right end alone leaves the left pad what the roll of its pads makes.
  const std::string trace = text_of(folder / "once.csv");
  const Rows rows = rows_of(trace);
  const auto at_end = [&](const std::string& column) {
    return std::abs(rows.row.back()[rows.column(column)]);
  };
  CHECK(at_end("support_right_8.force_z_n") > 1e3);
  CHECK(at_end("support_8.force_z_n") < .5 * at_end("support_right_8.force_z_n"));
  // The same seed makes the same track, another seed another one.
  REQUIRE(railstep_program(words_of("twice.csv")).code == 0);
  CHECK(text_of(folder / "twice.csv") == trace);
  REQUIRE(railstep_program(words_of("other.csv", "4")).code == 0);
  CHECK(text_of(folder / "other.csv") != trace);
  const Ran still = railstep_program("static '" + scene + "' --json" + changes("3"));
  CHECK(still.code == 0);
}
