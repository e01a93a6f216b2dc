// The key rail.cant, and runs on rails that lean.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/analysis/statics.h"
#include "support/program.h"
#include "support/scene_run.h"
#include "support/static_program.h"

using namespace railstep;
using Catch::Matchers::Contains;

namespace {

const std::string kBallasted = kScenes + "ballasted_track.toml";

Scene canted(const std::string& cant, const std::string& unknowns = "full") {
  return read_scene(kBallasted, {"rail.cant=" + cant, "track.unknowns=\"" + unknowns + "\""});
}

nlohmann::json run_of(const std::string& words) {
  const Ran ran = railstep_program("run " + kBallasted + " --json " + words);
  INFO(words << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

const std::string kLeaning = "--set 'rail.cant=\"1:20\"' --duration 0.05 ";

}  // namespace

TEST_CASE("the cant of the rails is a slope", "[cant]") {
  CHECK(canted("\"1:20\"").rail.cant == .05);
  CHECK(canted("\"1:40\"").rail.cant == .025);
  CHECK(canted("0.05").rail.cant == .05);
  CHECK(canted("0").rail.cant == 0.);
  CHECK(read_scene(kBallasted).rail.cant == 0.);
  const Track t = track_of(canted("\"1:20\""));
  CHECK(t.lean(0).sine > 0.);
  CHECK(t.lean(1).sine == -t.lean(0).sine);
  for (const char* bad : {"\"1:0\"", "\"1:2\"", "\"2:40\"", "\"1:20x\"", "\"1:-20\""})
    CHECK_THROWS_WITH(canted(bad), Contains("E-KEY-08"));
  CHECK_THROWS_WITH(canted("0.3"), Contains("[rail] cant"));
}

TEST_CASE("features without leaning rails refuse them", "[cant]") {
  CHECK_THROWS_WITH(canted("\"1:20\"", "vertical"), Contains("rigid-section"));
  CHECK_THROWS_WITH(read_scene(kBallasted, {"rail.cant=0.05", "track.gauge_m=1.435"}),
                    Contains("rail_spacing_m"));
  const std::string lean = " --set 'rail.cant=\"1:20\"' --set 'track.unknowns=\"full\"' ";
  const Ran beam = railstep_program("static " + shipped_word("cantilever_rectangle") +
                                    "--set rail.cant=0.05 --set 'track.model=\"timoshenko\"'");
  CHECK(beam.code == 2);
  CHECK_THAT(beam.err, Contains("E-TIMOSHENKO-02"));
  const Ran exact =
      railstep_program("receptance " + shipped_word("receptance_s1") + lean +
                       "--at mid_bay --from 100 --to-hz 200 --points 2 --beside endless");
  CHECK(exact.code == 2);
  CHECK_THAT(exact.err, Contains("upright"));
}

TEST_CASE("flanges meet leaning rails as far from them as upright ones", "[cant][flange]") {
  for (const std::string cant : {"0.0", "\"1:40\"", "\"1:20\""})
    for (const std::string side : {"10.0", "-10.0"}) {
      const Scene scene = read_scene(
          kScenes + "wheelset_flange.toml",
          {"rail.cant=" + cant, "wheelset[0].force=[{direction=\"y\",table=[[0.0," + side + "]]}]",
           "wheelset[0].flange.clearance_m=4e-3"});
      const Simulation run(scene);
      Outputs outputs{};
      publish_start(run.model(), run.state, outputs);
      CAPTURE(cant, side);
      // Across the gap, at 70 degrees; the wheelset sinks by some 0.01 mm.
      const double upright = 4e-3 * std::sin(70. * M_PI / 180.);
      CHECK(outputs.contact_gap[2] == Approx(upright).margin(2e-5));
      CHECK(outputs.contact_gap[3] == Approx(upright).margin(2e-5));
      const Traced moved(scene);
      CHECK((moved.status & Status::off_rail) == Status::ok);
      const std::string pressed = side == "10.0" ? "left" : "right";
      const std::vector<double> force = moved["wheel_" + pressed + ".flange_force_peak_n"];
      CHECK(*std::max_element(force.begin(), force.end()) > 100.);
    }
}

TEST_CASE("a wheelset that runs on leaning rails keeps the balance of energy", "[cant]") {
  const auto error = [](const nlohmann::json& run) {
    return run.at("energy_balance_error").get<double>();
  };
  // The balance's error less the scheme's own loss or gain, which is known in closed form.
  const auto rest = [&](const nlohmann::json& run) {
    return std::abs(error(run) - std::abs(run.at("numerical_loss").get<double>()));
  };
  // As in test_energy: frozen for a step, a normal errs by up to 1e-4 where the head is squeezed.
  // Trapezoids of the dissipation, a tenth of the energy, are good to (2 pi 350 Hz dt)^2 / 12 =
  // 1e-3.
  constexpr double kFrozen = 1e-4, kTrapezoids = .1 * 1e-3;
  for (const char* unknowns : {"full", "rigid-section"}) {
    const std::string words =
        std::string("--set 'track.unknowns=\"") + unknowns + "\"' --model full ";
    const auto upright = run_of(words + "--duration 0.05"), leaning = run_of(words + kLeaning);
    CAPTURE(unknowns, error(upright), error(leaning), rest(upright), rest(leaning));
    CHECK(leaning.at("status").empty());
    CHECK(leaning.at("state_hash") != upright.at("state_hash"));
    for (const auto* run : {&upright, &leaning}) {
      CHECK(rest(*run) < kFrozen);
      CHECK(error(*run) < kFrozen + kTrapezoids);
    }
  }
  // Condensed, the loss is of first order (test_energy): a quarter with a quarter of the step.
  const auto coarse = run_of("--model condensed --step 1e-4 " + kLeaning);
  const auto fine = run_of("--model condensed --step 2.5e-5 " + kLeaning);
  CAPTURE(error(coarse), error(fine), rest(coarse), rest(fine));
  CHECK(rest(coarse) < kFrozen);
  CHECK(rest(fine) < kFrozen);
  CHECK(error(fine) < .3 * error(coarse));
}
