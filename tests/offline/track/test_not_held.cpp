// Tracks that are not held, or that buckle, are refused in any start and by any caller. The message
// names the motion, the place and the key.
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "offline/analysis/buckling.h"
#include "offline/analysis/statics.h"
#include "offline/analysis/timoshenko_statics.h"
#include "offline/receptance/condensed.h"
#include "offline/track/functional.h"
#include "run/simulation.h"
#include "scene/scene_system.h"
#include "support/bad_input.h"
#include "support/condensed_tracks.h"
#include "support/one_sided_tracks.h"
#include "support/reference_tracks.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;

namespace {

/// The message with which a scene is refused; "accepted" if it is not refused.
std::string refusal(const std::string& scene, const std::vector<std::string>& overrides) {
  try {
    simulation_of(read_any_scene(shipped(scene), overrides));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void check_free(const std::string& said, const std::string& scene, const std::string& motion,
                const std::string& key) {
  CHECK_THAT(said, Contains(scene + ".toml: ") && Contains(motion) && Contains(key) &&
                       Contains("[E-TRACK-35]"));
}

const std::string kReleased = "step.start=\"released\"";

}  // namespace

TEST_CASE("rails that traffic would push away are refused in any start", "[not_held]") {
  const std::string key_y = "support.stiffness_y_n_per_m";
  check_free(refusal("wheelset_flange",
                     {"support.stiffness_y_n_per_m=0", "support.damping_y_n_s_per_m=0"}),
             "wheelset_flange", "along y", key_y);
  check_free(refusal("wheelset_on_track", {"support.stiffness_roll_n_m_per_rad=0"}),
             "wheelset_on_track", "in roll", "support.stiffness_roll_n_m_per_rad");
  for (const std::string start : {"step.start=\"equilibrium\"", "step.start=\"released\""}) {
    CAPTURE(start);
    check_free(refusal("exciter_on_track", {start, "support.stiffness_y_n_per_m=0"}),
               "exciter_on_track", "along y", key_y);
    check_free(refusal("exciter_on_track", {start, "support.stiffness_z_n_per_m=0"}),
               "exciter_on_track", "along z", "support.stiffness_z_n_per_m");
    check_free(refusal("moving_load", {start, "support.stiffness_z_n_per_m=0",
                                       "condense={kind=\"modal\", residual_flexibility=false}"}),
               "moving_load", "along z", "support.stiffness_z_n_per_m");
    check_free(refusal("ballasted_track", {start, "ballast.stiffness_z_n_per_m=0"}),
               "ballasted_track", "along z", "ballast.stiffness_z_n_per_m");
  }
}

TEST_CASE("a scene that cannot be condensed is bad input of its file", "[not_held][cli]") {
  const BadInput bad("loose");
  const std::string scene = shipped("exciter_on_track"), out = bad.old("--out", "o.model");
  bad.refused("condense " + scene + " --set support.stiffness_y_n_per_m=0" + out,
              {"exciter_on_track.toml: ", "E-TRACK-35", "along y"});
}

TEST_CASE("a free motion is named with its rail, its place and all keys that it needs",
          "[not_held]") {
  const std::string id = "E-TRACK-35";
  Track t = paper_track();
  t.support.stiffness[0] = t.support.stiffness[1] = 0.;
  CHECK_THROWS_WITH(Statics(t), Contains(id) && Contains("support.stiffness_x_n_per_m") &&
                                    Contains("support.stiffness_y_n_per_m"));
  t = s1_rail(8);
  t.support.stiffness[2] = 0.;
  t.sleeper->ballast_stiffness[2] = 0.;
  CHECK_THROWS_WITH(
      Statics(t), Contains(id) && Contains("sleepers") && Contains("support.stiffness_z_n_per_m"));
  t.support.stiffness[2] = 1e8;
  CHECK_THROWS_WITH(
      Statics(t), Contains(id) && !Contains("sleepers") && Contains("ballast.stiffness_z_n_per_m"));
  // A rail is cut, and pads hold one piece along x.
  t = paper_track();
  t.bays = 6;
  RailJoint joint;
  joint.x = 3. * t.bay_length;
  t.joints = {joint};
  const Seat held = t.seat(1);
  t.support.stiffness[0] = 0.;
  t.changed_seats[1] = held;
  CHECK_THROWS_WITH(Statics(t), Contains(id) && Contains("x = 4.8 to 9.6 m") &&
                                    Contains("support.stiffness_x_n_per_m"));
  // A vertical beam has one seat: of its pad's stiffnesses only that along x keeps it from tipping.
  t = r6_track();
  t.support.stiffness[0] = 1e6;
  for (int seat = 0; seat <= t.bays; ++seat)
    if (seat != 20) t.changed_seats[seat] = {};
  CHECK_THROWS_WITH(Statics(t), Contains(id) && Contains("[[support_change]]"));
}

TEST_CASE("a rail on one-sided supports alone is refused where the model has them open",
          "[not_held]") {
  Track t = r6_track();
  t.bays = 8;
  t.support.unilateral = true;
  CHECK_NOTHROW(Statics(t));
  const Traffic load{.loads = {{.start = 1., .stop = 2., .force = -1e4}}};
  CHECK_NOTHROW(PackedModel(t, load, full_order(1e-3)));
  CHECK_THROWS_WITH(PackedModel(t, load, condensed(t, 2, 1e-3)),
                    Contains("E-TRACK-34") && Contains("the rail,"));
}

TEST_CASE("Timoshenko's beam and a receptance of few modes name the free motion too",
          "[not_held]") {
  Track t = r6_track();
  t.support.stiffness[2] = 0.;
  const std::string id = "E-TRACK-35", key = "support.stiffness_z_n_per_m";
  CHECK_THROWS_WITH(TimoshenkoStatics(t, {1.}), Contains(id) && Contains(key));
  const Functional middle{{{{0, 12., 0., 0., 2}, 1.}}, {}};
  CHECK_THROWS_WITH(CondensedReceptance(t, {middle, {middle}}, {}, false),
                    Contains(id) && Contains(key));
}

TEST_CASE("a rail on very soft springs is not free", "[not_held]") {
  // 0.5 N/m under a rail of 1e12 N/m is as small as rounding (config/hard/h10_light_rail.toml).
  Track t = r6_track();
  t.bays = 1;
  t.bay_length = .05;
  t.elements_per_bay = 1;
  t.section.area = .2;
  t.section.inertia_y = .1;
  t.support.stiffness[2] = .5;
  const Traffic load{.loads = {{.start = .02, .stop = 1., .force = -1.}}};
  PackOptions options = full_order(1e-6);
  options.residual_flexibility = false;
  CHECK_NOTHROW(PackedModel(t, load, options));
  t.support.stiffness[2] = 0.;
  CHECK_THROWS_WITH(PackedModel(t, load, options), Contains("E-TRACK-35"));
}

TEST_CASE("scenes without a moving track, or with held ends, need no pads", "[not_held]") {
  CHECK(refusal("moving_load", {"support.stiffness_z_n_per_m=0", "track.ends=\"clamped\""}) ==
        "accepted");
  CHECK(refusal("double_pendulum", {kReleased}) == "accepted");
  // Nothing moves the rails sideways here.
  CHECK(refusal("moving_load", {"track.unknowns=\"full\"", "support.stiffness_y_n_per_m=0"}) ==
        "accepted");
}

TEST_CASE("a track that buckles is refused with the place", "[not_held]") {
  Track t = r6_track();
  t.bays = 30;
  for (int seat = 12; seat <= 17; ++seat) t.changed_seats[seat] = {};
  t.axial_force = -5e7;
  try {
    refuse_buckled(t);
    FAIL("it does not buckle");
  } catch (const std::invalid_argument& error) {
    const std::string said = error.what();
    CAPTURE(said);
    const std::size_t at = said.find(" N, most at x = ");
    REQUIRE(at != std::string::npos);
    // Seats 11 and 18 are the last that hold, so the middle of the gap is 14.5 bays on.
    CHECK(std::abs(std::stod(said.substr(at + 16)) - 14.5 * t.bay_length) < .5 * t.bay_length);
  }
}
