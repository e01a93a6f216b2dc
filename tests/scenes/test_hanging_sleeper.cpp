// The scene of hanging sleepers run by the program: trace, statics, energy and refusals.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "build/build.h"
#include "offline/track/fixed_port.h"
#include "scene/scene.h"
#include "support/static_program.h"
#include "support/traced.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

const std::string kHanging = RAILSTEP_SOURCE "/config/scenes/hanging_sleeper.toml";

Scene with(const std::vector<std::string>& changes) { return read_scene(kHanging, changes); }

const std::string kStop =
    "stop=[{name=\"tie\", rail=\"left\", position_m=9.0, direction=\"z\", side=\"below\", "
    "gap_m=1e-3, stiffness_n_per_m=1e8}]";

}  // namespace

TEST_CASE("loads that stand over hanging sleepers rest where `static` finds them", "[supports]") {
  std::string words = kHanging + " --set step.duration_s=0.04 --set '" + kStop + "'";
  const char* const x[] = {"9.0", "9.0", "6.6", "6.6"};
  for (int i = 0; i < 4; ++i) {
    const std::string load = " --set load[" + std::to_string(i) + "].";
    words.append(load).append("start_m=").append(x[i]).append(load).append("speed_m_per_s=0.0");
  }
  const Rows rows = traced(words);
  const Ran ran = railstep_program("static " + words + " --json");
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto found = nlohmann::json::parse(ran.out);
  CHECK(found["residual"].get<double>() < 1e-8);
  for (const auto& first_or_last : {rows.row.front(), rows.row.back()}) {
    for (const auto& point : found["points"]) {
      const std::string name = point["name"];
      const double want = point["displacement_m"][2];
      // The run's sensors include the residual flexibility, `static` does not. At nodes it is the
      // part that the squeeze in series with the pads leaves out: 4e-3 of the squeeze
      // (docs/unknowns.md), which is 8e-3 of the flexibility on the ground.
      CHECK_THAT(first_or_last[rows.column(name + ".dz_m")], WithinRel(want, 3.2e-5));
    }
    double sum = 0.;
    for (int seat = 0; seat <= 30; ++seat)
      sum += first_or_last[rows.column("support_" + std::to_string(seat) + ".force_z_n")];
    const double stop = first_or_last[rows.column("tie.force_n")];
    CHECK(stop > 100.);
    CHECK_THAT(sum + stop, WithinRel(2. * 85e3, 1e-6));
  }
}

TEST_CASE("two axles over hanging sleepers keep the balance of energy", "[supports]") {
  const auto found = told(kHanging);
  CHECK(found["status"].empty());
  CHECK(found["energy_balance_error"].get<double>() < 1e-3);
  CHECK(found["max_iterations"].get<int>() <= 8);
  CHECK(found["allocations"] == 0);
}

TEST_CASE("the trace has the force of pads that do not pull", "[supports]") {
  // The weight of 0.6 m of rail presses a pad with 350 N, and 2 kN lift it by at most 60 N
  // (rail-data.md: 1.5 % of each axle). Pads that do not pull therefore act as springs.
  std::string both = kHanging + " --set track.gravity=true --set step.duration_s=0.05";
  for (int i = 0; i < 4; ++i) both += " --set load[" + std::to_string(i) + "].force_z_n=-2e3";
  const std::string pads =
      " --set 'support_change=[{from=14, to=16, ballast.gap_m=0.5e-3}, "
      "{from=8, to=12, support.unilateral=true}]'";
  // Without residual flexibility both are one discrete problem. With it a port's force misses the
  // effect beyond the mesh of a load inside an element: 1e-3 of its flexibility on two elements per
  // bay (flexibility.h), 1.03e-8 m/N (rail-data.md), on a pad of 200e6 N/m 2.1e-3 of the load.
  for (const bool residual : {false, true}) {
    const std::string words =
        both + " --set condense.residual_flexibility=" + (residual ? "true" : "false");
    const Rows a = traced(words), b = traced(words + pads);
    for (const int seat : {9, 10, 11}) {
      const std::size_t c = a.column("support_" + std::to_string(seat) + ".force_z_n");
      double most = 0., difference = 0.;
      for (std::size_t r = 0; r < a.row.size(); ++r) {
        most = std::max(most, a.row[r][c]);
        difference = std::max(difference, std::abs(b.row[r][c] - a.row[r][c]));
      }
      CAPTURE(residual, seat, difference, most);
      CHECK(most > 800.);
      CHECK(difference < (residual ? 1e-3 * 1.03e-8 * 200e6 * 2e3 : 1e-6 * most));
    }
  }
}

TEST_CASE("six loose pads in a row give the same as pads that differ slightly", "[supports]") {
  // Without its pads each of these sleepers stands alone on its ballast: six shapes of the same
  // rate. A transition by 1e-5 separates the rates.
  const auto run = [](const std::string& kind, const std::string& transition) {
    return traced(std::string(RAILSTEP_SOURCE) +
                  "/config/scenes/ballasted_track.toml --set track.bays=24 --set "
                  "step.duration_s=0.05 --set sensor[0].sleeper=9 --set sensor[1].position_m=5.4 "
                  "--set 'support_change=[{from=7, to=12, support.unilateral=true" +
                  transition + "}]' --set 'condense.kind=\"" + kind + "\"'");
  };
  const Rows alike = run("modal", ""), full = run("full", ""),
             apart = run("modal", ", ballast.stiffness_factor=[1.0, 1.00001]");
  const auto off = [&alike](const Rows& other, const std::string& name) {
    const std::size_t at = alike.column(name);
    double most = 0., apart_by = 0.;
    for (std::size_t i = 0; i < alike.row.size(); ++i) {
      most = std::max(most, std::abs(alike.row[i][at]));
      apart_by = std::max(apart_by, std::abs(alike.row[i][at] - other.row[i][at]));
    }
    return apart_by / most;
  };
  for (const std::string name :
       {"sleeper.dz_m", "pad.dz_m", "wheel_left.force_z_n", "support_9.force_z_n"}) {
    CAPTURE(name, off(apart, name), off(full, name));
    CHECK(off(apart, name) < 1e-4);
    CHECK(off(full, name) < 3e-2);  // the mesh of two elements a bay causes this difference
  }
}

TEST_CASE("a scene gives the supports that do not pull, seat by seat", "[supports]") {
  CHECK(fixed_ports(track_of(with({}))).size() == 6);
  // One value, a transition, one side, and a value that a later change removes.
  const auto ports = fixed_ports(track_of(
      with({"support_change=[{from=2, to=4, rail=\"left\", ballast.gap_m=[1e-3, 3e-3]}, "
            "{seats=[3], rail=\"left\", ballast.gap_m=0.0}, {seats=[7], support.unilateral=true, "
            "support.gap_m=2e-4}, {seats=[8], missing=\"ballast\", ballast.gap_m=1e-3}]"})));
  REQUIRE(ports.size() == 4);
  CHECK(ports[0].seat == 2);
  CHECK(ports[0].gap == 1e-3);
  CHECK(ports[0].stiffness == 50e6);
  CHECK(ports[0].damping == 80e3);
  CHECK(ports[1].seat == 4);
  CHECK_THAT(ports[1].gap, WithinRel(3e-3, 1e-15));
  CHECK(ports[2].of == FixedPort::Of::pad);
  CHECK(ports[2].gap == 2e-4);
  CHECK(ports[3].rail == 1);
  const auto stops = fixed_ports(track_of(with({kStop})));
  REQUIRE(stops.size() == 7);
  CHECK(stops.back().of == FixedPort::Of::stop);
  CHECK(stops.back().gap == 1e-3);
  CHECK(stops.back().closing.rail.at(0).factor == -1.);
}

TEST_CASE("a track refuses springs that do not pull where it cannot have them", "[supports]") {
  const auto refused = [](const std::string& words, const std::string& sentence) {
    const Ran ran = railstep_program(words);
    CAPTURE(words, ran.err);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Catch::Contains(sentence));
  };
  const std::string run = "run " + kHanging + " --set ";
  refused(run + "ballast.unilateral=true", "E-PACK-35");
  refused(run + "ballast.gap_m=-1e-3", "gap_m");
  refused(run + "support_change[0].ballast.gap_m=0.2", "gap_m");
  refused(run + "support.length_m=0.1 --set support.unilateral=true", "E-TRACK-14");
  refused(run + "ballast.unilateral=true --set condense.kind='\"modal\"'", "E-TRACK-34");
  refused(run +
              "'stop=[{name=\"a\", rail=\"left\", position_m=9.0, direction=\"y\", "
              "side=\"left\", stiffness_n_per_m=1e8}]'",
          "E-STOP-03");
  refused(run +
              "'stop=[{name=\"rail\", rail=\"left\", position_m=9.0, direction=\"z\", "
              "side=\"below\", stiffness_n_per_m=1e8}]'",
          "E-RUNNER-19");
  refused("static " + kHanging +
              " --set load[0].force_z_n=1e6 --set load[1].force_z_n=1e6 --set "
              "track.bays=4 --set support_change=[] --set "
              "ballast.unilateral=true --set load[2].start_m=1.0 --set "
              "load[3].start_m=1.0 --set load[0].start_m=1.0 --set "
              "load[1].start_m=1.0 --set sensor=[] --set step.duration_s=1e-3",
          "no equilibrium");
}

TEST_CASE("modes and receptance take a gap as open and a pad without gap as a spring",
          "[supports]") {
  const auto lowest = [](const std::string& set) {
    const Ran ran = railstep_program("modes " + kHanging + " --count 2 --json " + set);
    CAPTURE(ran.err);
    REQUIRE(ran.code == 0);
    return nlohmann::json::parse(ran.out)["frequencies_hz"];
  };
  CHECK(lowest("--set support.unilateral=true") == lowest(""));
  CHECK(lowest("") == lowest("--set 'support_change=[{from=14, to=16, missing=\"ballast\"}]'"));
}
