#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/beam/equilibrium.h"
#include "offline/beam/linearise.h"
#include "offline/beam/track_structure.h"
#include "support/program.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// A slender pinned rail: 12 m of a 50 mm square bar, which sags by a large part of its height.
Track pinned_bar(int elements) {
  const double h = .05;
  Track t;
  t.section = {.area = h * h,
               .inertia_y = h * h * h * h / 12.,
               .inertia_z = h * h * h * h / 12.,
               .torsion = .1406 * h * h * h * h,
               .shear_factor_y = .85,
               .shear_factor_z = .85,
               .moments = rectangle_moments(h, h)};
  t.rails = 1;
  t.bays = elements;
  t.bay_length = 12. / elements;
  t.elements_per_bay = 1;
  t.ends = {RailEnd::pinned, RailEnd::pinned};
  return t;
}

/// Undamped frequencies of the line that moves the rail up, lowest first.
Modes vertical_modes(const Track& track) {
  for (const Line& line : assemble(track))
    if (line.unknown(0, 1, 2) >= 0) return modes(line);
  return {};
}

}  // namespace

TEST_CASE("a force near a configuration is f_s + K_r (q - q_s)", "[linearise]") {
  Track track = pinned_bar(4);
  track.axial_force = -2e3;
  const TrackStructure rail(track);
  const Structure& s = rail.structure();
  Eigen::VectorXd bent = s.rest;
  for (int i = 0; i < bent.size(); ++i) bent[i] += 1e-2 * std::sin(1.7 * i);
  const Linearised at = linearised(s, bent);
  Eigen::VectorXd step(bent.size());
  for (int i = 0; i < step.size(); ++i) step[i] = std::cos(2.3 * i);
  const auto left_over = [&](double size) {
    const Eigen::VectorXd force = internal_force(s, bent + size * step);
    return (force - at.force - size * (at.stiffness * step)).norm();
  };
  // The difference is of second order: a tenth of the step leaves a hundredth, but for third order.
  const double ratio = left_over(1e-3) / left_over(1e-4);
  CHECK(ratio > 98.);
  CHECK(ratio < 102.);
}

TEST_CASE("a rail that sags between pins is stiffer by the closed form", "[linearise]") {
  // One sine of amplitude a has V = E I pi^4 w^2/(4 L^3) + E A pi^4 w^4/(32 L^3). So at the sag
  //   f1^2 = f10^2 (1 + 3/4 A a^2/I),
  // and the tension E A pi^2 a^2/(4 L^2) gives the second mode f2^2 = f20^2 (1 + A a^2/(16 I)).
  // Uniform weight bends the rail into a shape with other sines: the third harmonic is 1/243 of the
  // first, which changes these shifts by less than 1 % and the peak by 0.4 %.
  const Track track = pinned_bar(16);
  const double gravity = 1.;
  const Track sagged = linearised_under_weight(track, gravity);
  const double a = -sagged.state->rail[0][9 * 16 + 2], h = .05;
  CHECK(a > .5 * h);                             // otherwise the effect is small
  const double slender = 12. * a * a / (h * h);  // A a^2/I
  const Modes flat = vertical_modes(track), curved = vertical_modes(sagged);
  const auto shift = [&](Eigen::Index n) {
    const double ratio = curved.frequency[n] / flat.frequency[n];
    return ratio * ratio - 1.;
  };
  CHECK_THAT(shift(0), WithinRel(.75 * slender, .015));
  CHECK_THAT(shift(1), WithinRel(slender / 16., .015));
}

TEST_CASE("the linear response to the weight is the state of the linearisation", "[linearise]") {
  Track track = paper_track();
  track.section.moments = moments(kSectionF);
  track.sleeper = Sleeper{.mass = 300., .roll_inertia = 50., .ballast_stiffness = {0., 0., 5e7}};
  if (GENERATE(false, true)) {  // the sides differ, one right seat hangs
    track.right = track.bar(0);
    track.right->material.young *= .9;
    track.sleeper->ballast_stiffness = {2e7, 2e7, 5e7};
    Seat hanging = track.seat(1);
    hanging.ballast[1] = {};
    hanging.pad[0].stiffness[2] *= 2.;
    track.changed_seats[1] = hanging;
  }
  const Track at = linearised_under_weight(track, 9.81);
  const Statics statics(at);
  const auto answer = statics.solve({}, 9.81);
  const TrackStructure rails(track);
  const Equilibrium nonlinear = equilibrium(rails.structure(), {rails.weight(9.81)});
  REQUIRE(nonlinear.converged);
  const Eigen::VectorXd change = nonlinear.q - rails.structure().rest;
  for (const double x : {0., 1.1, 3.2, 6.4}) {
    const RailPoint point{1, x, 0., .1, 2};
    // Both are solved to round-off: 1e-10 of the sag is ample.
    CHECK_THAT(statics.at(answer, point), WithinRel(rails.row(point).dot(change), 1e-9));
  }
  CHECK(statics.support_force(answer, 1, 2) > 0.);
}

TEST_CASE("a track that nothing holds is refused with the loose motion", "[linearise]") {
  Track loose = pinned_bar(2);
  loose.ends = {RailEnd::free, RailEnd::free};
  CHECK_THROWS_WITH(linearised_under_weight(loose, 9.81), Catch::Contains("E-TRACK-35"));
}

TEST_CASE("a scene linearised under its weight has the nonlinear sag", "[linearise]") {
  const std::string scene = RAILSTEP_SOURCE "/config/scenes/cantilever_rail.toml";
  const std::string words = " --json --set track.gravity=true --set 'load[0].force_z_n=0'";
  const auto tip = [&](const std::string& more) {
    const Ran ran = railstep_program("static " + scene + words + more);
    REQUIRE(ran.code == 0);
    const auto result = nlohmann::json::parse(ran.out);
    return result["points"][0]["displacement_m"].get<std::vector<double>>();
  };
  const auto nonlinear = tip("");
  const auto linear = tip(" --model linearised --set track.linearised_at='\"weight\"'");
  const auto at_rest = tip(" --model linearised");
  // The nonlinear solution leaves 1e-10 of the load; the tip misses less than 1e-8 of its sag.
  CHECK_THAT(linear[2], WithinRel(nonlinear[2], 1e-9));
  CHECK_THAT(linear[0], WithinRel(nonlinear[0], 1e-8));
  CHECK(nonlinear[0] < 0.);
  CHECK(std::abs(at_rest[0]) < 1e-6 * std::abs(nonlinear[0]));
  const Ran refused = railstep_program("modes " RAILSTEP_SOURCE
                                       "/config/scenes/pinned_bay.toml "
                                       "--set track.linearised_at='\"weight\"'");
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Catch::Contains("linearised_at"));
}

TEST_CASE("a strip that buckles sideways under its own weight is refused", "[linearise]") {
  // A cantilever 0.2 m high and 2 mm thick falls sideways where its weight per length w reaches
  // 12.85 sqrt(E Iz G J)/L^3 (Timoshenko and Gere, Theory of Elastic Stability, 6.3): L = 2.44 m.
  const std::string words =
      "modes " RAILSTEP_SOURCE
      "/config/scenes/cantilever_rectangle.toml --json --set track.gravity=true "
      "--set track.linearised_at='\"weight\"' --set rail.rectangle.height_m=0.2 "
      "--set rail.rectangle.width_m=0.002 --set 'rail.rule.shear=\"twist\"' ";
  const Ran stands = railstep_program(words + "--set track.bay_m=0.240"),
            falls = railstep_program(words + "--set track.bay_m=0.250");
  REQUIRE(stands.code == 0);
  CHECK(nlohmann::json::parse(stands.out)["frequencies_hz"][0].get<double>() > 0.);
  CHECK(falls.code == 2);
  CHECK_THAT(falls.err, Catch::Contains("E-NONLINEAR-02"));
}

TEST_CASE("an unloaded rail is in equilibrium where it lies", "[linearise]") {
  const std::string unloaded =
      "static " RAILSTEP_SOURCE
      "/config/scenes/cantilever_rail.toml --json --set 'load[0].force_z_n=0' "
      "--set 'load[0].start_m=0.8' --set 'sensor[0].position_m=0.8' --set track.bays=";
  for (const char* bays : {"4", "15", "40", "100"}) {
    std::string words = unloaded;
    words.append(bays);
    const Ran ran = railstep_program(words);
    INFO(bays << ran.err);
    REQUIRE(ran.code == 0);
    const auto result = nlohmann::json::parse(ran.out);
    CHECK(result["stable"] == true);
    // Round-off of positions of 20 m, by the bending of 0.8 m, is 1e-15 of 20 m times (L/h)^2.
    CHECK(std::abs(result["points"][0]["displacement_m"][2].get<double>()) < 1e-11);
  }
}

TEST_CASE("scenes that would give wrong results are refused", "[linearise]") {
  const std::string linear =
      "static " RAILSTEP_SOURCE "/config/scenes/cantilever_rail_linear.toml ";
  const Ran line = railstep_program(linear +
                                    "--set 'track.unknowns=\"vertical\"' "
                                    "--set 'track.reference_line=\"foot\"'");
  CHECK(line.code == 2);
  CHECK_THAT(line.err, Catch::Contains("reference_line"));
  const Ran ballast = railstep_program("static " RAILSTEP_SOURCE
                                       "/config/scenes/ballasted_track.toml "
                                       "--set ballast.stiffness_y_n_per_m=0");
  CHECK(ballast.code == 2);
  CHECK_THAT(ballast.err, Catch::Contains("ballast"));
  const Ran growing = railstep_program("modes " RAILSTEP_SOURCE
                                       "/config/scenes/free_rail.toml "
                                       "--set rail.rule.coupling_points=1 "
                                       "--set track.elements_per_bay=2");
  CHECK(growing.code != 0);
  CHECK_THAT(growing.err, Catch::Contains("E-MODES-09"));
  CHECK(railstep_program(linear + "--json >/dev/full").code == 1);
}
