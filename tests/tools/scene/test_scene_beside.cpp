#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "build/build_system.h"
#include "scene/scene_system.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;
using Overrides = std::vector<std::string>;

namespace {

std::filesystem::path exciter() {
  return std::filesystem::path(RAILSTEP_SOURCE) / "config/scenes/exciter_on_track.toml";
}

SystemScene scene_with(const Overrides& overrides = {}) {
  return std::get<SystemScene>(read_any_scene(exciter(), overrides));
}

/// Message for the exciter's scene with this option, or "accepted" if it is read and built.
std::string beside_with(const Overrides& overrides) {
  try {
    static_cast<void>(BuiltSystem(scene_with(overrides)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("exciter_on_track has a track, bodies and springs between them", "[scene]") {
  const SystemScene s = scene_with();
  REQUIRE(s.track);
  CHECK(s.track->track.rails == 2);
  CHECK(s.track->sleeper->mass == 300.);
  CHECK(!s.track->condense.kind);
  CHECK_FALSE(s.track->condense.residual_flexibility);
  CHECK(s.step.start == Start::equilibrium);
  CHECK(s.step.rho_inf == .6);
  CHECK(s.track->step->steps == 2000);
  REQUIRE(s.system.bodies.size() == 3);
  REQUIRE(s.system.springs.size() == 4);
  CHECK(s.system.springs[0].a.kind == Part::Kind::rail);
  CHECK(s.system.springs[0].a.index == 0);
  CHECK(s.system.springs[3].a.index == 1);
  CHECK(s.system.springs[3].point_a == Eigen::Vector3d(12.3, -.75, .091));
  // Sensors on rails and sleepers belong to the track, the others to the system.
  CHECK(s.names.sensors == std::vector<std::string>{"frame_centre"});
  REQUIRE(s.track->sensors.size() == 2);
  CHECK(std::get<RailSensor>(s.track->sensors[0].on).position == 12.);
  CHECK(s.traced.joints == std::vector<int>{1});
  CHECK(s.traced.springs == std::vector<int>{0, 1});
}

TEST_CASE("a scene with a track and bodies has the columns of both", "[scene]") {
  const BuiltSystem built(
      scene_with({"output.supports=true",
                  "load=[{name=\"axle\", rail=\"left\", start_m=6, force_z_n=-1e4}]"}));
  const auto at = [&](const std::string& name) {
    const auto found = std::find(built.columns.begin(), built.columns.end(), name);
    CAPTURE(name);
    REQUIRE(found != built.columns.end());
    return found - built.columns.begin();
  };
  CHECK(at("axle.x_m") == 1);
  CHECK(at("rail_centre.x_m") == 3);
  CHECK(at("sleeper_centre.x_m") == 10);
  CHECK(at("support_0.force_z_n") == 17);
  CHECK(at("support_right_40.force_z_n") == 17 + 81);
  CHECK(at("frame_centre.x_m") == 99);
  CHECK(at("axle_left.force_x_n") == 106);
  CHECK(at("axle_left.moment_z_n_m") == 111);
  CHECK(at("foot_left_rear.force_n") == 112);
  CHECK(built.columns.size() == 114);
}

TEST_CASE("keys that cannot be stepped beside bodies are refused", "[scene]") {
  const auto refused = [](const std::string& option, const std::string& said) {
    CAPTURE(option);
    CHECK_THAT(beside_with({option}), Contains(said));
  };
  refused("static.tolerance=1e-9", "E-BODY-05");
  refused("condense.residual_flexibility=true", "E-CONDENSE-31");
  CHECK_THAT(beside_with({"load=[{name=\"load\"}]"}),
             Contains("[load[0]]") && Contains("E-KEY-01"));
  CHECK(beside_with({"condense={kind=\"full\", residual_flexibility=false}"}) == "accepted");
  refused("step.scheme=\"energy-momentum\"", "E-BODY-06");
  refused("step.scheme=\"tr-bdf2\"", "E-BODY-07");
  refused("step.scheme=\"rk4\"", "expected one of \"generalised-alpha\", \"backward-euler\"");
  refused("step.frame_s=0.003", "E-STEP-09");
  refused("joints.hold=\"gear-gupta-leimkuhler\"", "E-BODY-11");
  refused("track.model=\"nonlinear\"", "E-BODY-09");
  refused("track.reference_line=\"foot\"", "E-BODY-10");
  refused("system.planar=true", "E-BODY-12");
  refused("body=[]", "E-BODY-28");
}

TEST_CASE("names of rails are known, and points must lie on them", "[scene]") {
  CHECK_THAT(beside_with({"spring[0].between=[\"rail lift\", \"frame\"]"}),
             Contains("expected \"ground\", \"frame\", \"disc_left\", \"disc_right\", \"rail "
                      "left\", \"rail right\" [E-BODY-37]"));
  CHECK_THAT(
      beside_with({"spring[0].point_m=[25, 0.75, 0]"}),
      Contains(
          "[spring[0]] point_m is at 25 m along the left rail; expected 0 to 24 m [E-BODY-24]"));
  CHECK_THAT(beside_with({"spring[0].point_m=[11.7, -0.75, 0.091]"}),
             Contains("1.50276 m beside the left rail") && Contains("E-BODY-25"));
  CHECK_THAT(beside_with({"force[0].on=\"rail left\""}), Contains("E-BODY-38"));
  CHECK_THAT(
      beside_with({"sensor[0].on=\"rail right\""}),
      Contains(
          "expected \"frame\", \"disc_left\", \"disc_right\", \"rail\", \"sleeper\" [E-BODY-39]"));
  CHECK_THAT(beside_with({"sensor[0].on=\"fram\""}), Contains("E-BODY-23"));
  CHECK_THAT(beside_with({"body[1].name=\"sleeper\""}),
             Contains("[body[1]] name = \"sleeper\"") && Contains("E-BODY-21"));
  CHECK_THAT(beside_with({"load=[{name=\"frame\", rail=\"left\", start_m=6, force_z_n=-1e4}]"}),
             Contains("[body[0]] name = \"frame\" is taken by [load[0]]"));
  CHECK_THAT(beside_with({"spring[1].name=\"frame\""}), Contains("is taken by [body[0]]"));
  // Without a name the same spring has no name for its column.
  CHECK_THAT(
      beside_with({"spring=[{between=[\"rail left\", \"frame\"], point_m=[11.7, 0.75, 0.091], "
                   "other_point_m=[11.7, 0.75, 0.341], stiffness_n_per_m=1e6, trace=true}]"}),
      Contains("E-JOINT-17"));
}

TEST_CASE("a body that nothing holds has no equilibrium", "[scene]") {
  // No joint holds this disc.
  CHECK_THAT(
      beside_with({"joint[2].between=[\"frame\", \"disc_left\"]", "joint[2].point_m=[12, 0.3, 0.6]",
                   "joint[4].between=[\"frame\", \"disc_left\"]", "joint[4].point_m=[12, 0.3, 0.6]",
                   "joint[4].polynomial_rad=[0, 188.49555921538759]"}),
      Contains("exciter_on_track.toml: ") && Contains("body 2") && Contains("E-SYSTEM-62"));
  CHECK(beside_with({"joint=[]", "step.start=\"released\""}) == "accepted");
}
