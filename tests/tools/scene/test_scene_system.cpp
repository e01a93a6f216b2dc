#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "scene/scene_system.h"
#include "support/shipped.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Overrides = std::vector<std::string>;

namespace {

SystemScene system_scene(const std::string& name, const Overrides& overrides = {}) {
  return std::get<SystemScene>(read_any_scene(shipped(name), overrides));
}

/// Message for a shipped scene with these options, or "accepted" if it is read.
std::string system_with(const std::string& name, const Overrides& overrides) {
  try {
    read_any_scene(shipped(name), overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kPendulumName = "double_pendulum", kCrank = "slider_crank",
                  kSpring = "spring_pendulum";

}  // namespace

TEST_CASE("double_pendulum is the pendulum of the paper", "[scene]") {
  const SystemScene s = system_scene(kPendulumName);
  CHECK_FALSE(s.system.planar);
  CHECK(s.system.gravity == Eigen::Vector3d(0., 0., -9.81));
  REQUIRE(s.system.beams.size() == 2);
  CHECK(s.system.bodies.empty());
  const FlexibleBeam& lower = s.system.beams[1];
  CHECK(lower.start == Eigen::Vector3d(.4, 0., 0.));
  CHECK(lower.axes == Eigen::Matrix3d::Identity());
  CHECK(lower.length == .4);
  CHECK(lower.elements == 4);
  CHECK(s.system.beams[0].ends[0] == BeamEnd::pinned);
  CHECK(s.system.beams[0].ends[1] == BeamEnd::free);
  CHECK(std::get<RectangleSize>(s.bars[0].bar.shape).height == .02);
  CHECK(s.bars[0].bar.young == 210e6);  // the paper's value, a thousandth of steel's
  CHECK(s.bars[0].bar.density == 7900.);
  CHECK(s.bars[0].bar.shear_factor_z == 1.);
  REQUIRE(s.system.joints.size() == 1);
  CHECK(s.system.joints[0].kind == JointKind::spherical);
  CHECK(s.system.joints[0].a.kind == Part::Kind::beam);
  CHECK(s.system.joints[0].b.index == 1);
  CHECK(s.system.joints[0].point == Eigen::Vector3d(.4, 0., 0.));
  CHECK(s.names.sensors == std::vector<std::string>{"A", "B", "C"});
  CHECK(s.system.sensors[2].point == Eigen::Vector3d(.8, 0., 0.));
  CHECK(s.step.scheme == TimeScheme::generalised_alpha);
  CHECK(s.step.rho_inf == .9);
  CHECK(s.step.steps == 1000);
}

TEST_CASE("slider_crank and spring_pendulum have the values in their comments", "[scene]") {
  const SystemScene crank = system_scene(kCrank);
  CHECK(crank.system.planar);
  REQUIRE(crank.system.bodies.size() == 3);
  CHECK(crank.system.bodies[0].inertia.diagonal() == Eigen::Vector3d(1e-4, 9e-4, 9e-4));
  REQUIRE(crank.system.joints.size() == 5);
  CHECK(crank.system.joints[3].kind == JointKind::prismatic);
  CHECK(crank.system.joints[3].axis == Eigen::Vector3d::UnitX());
  CHECK(crank.system.joints[4].kind == JointKind::rotation);
  CHECK(crank.system.joints[4].a.kind == Part::Kind::ground);
  CHECK(crank.system.joints[4].motion.polynomial == std::vector<double>{0., 10.});
  CHECK(crank.system.sensors[1].point == Eigen::Vector3d(.4, 0., 0.));  // the slider's centre
  const SystemScene spring = system_scene(kSpring);
  REQUIRE(spring.system.springs.size() == 1);
  CHECK(spring.system.springs[0].stiffness == 200.);
  CHECK(spring.system.springs[0].length == .9);
  CHECK(spring.system.springs[0].b.kind == Part::Kind::body);
}

TEST_CASE("the keys of [joints] have their defaults and limits", "[scene]") {
  const SystemOptions defaults{}, plain = system_scene(kPendulumName).options;
  CHECK(plain.constraint_method == ConstraintMethod::augmented_lagrangian);
  CHECK(plain.cap == defaults.cap);
  CHECK(plain.joint_tolerance == defaults.joint_tolerance);
  const SystemOptions o =
      system_scene(kPendulumName, {"joints={hold=\"baumgarte\", cap=7, projections=2, "
                                   "tolerance_m=1e-8, force_tolerance=1e-6, alpha_per_s=50, "
                                   "beta_per_s=60}"})
          .options;
  CHECK(o.constraint_method == ConstraintMethod::baumgarte);
  CHECK(o.cap == 7);
  CHECK(o.projections == 2);
  CHECK(o.joint_tolerance == 1e-8);
  CHECK(o.tolerance == 1e-6);
  CHECK(o.alpha == 50.);
  CHECK(o.beta == 60.);
  const SystemOptions kept =
      system_scene(kPendulumName, {"joints={hold=\"direct\", tangent=\"kept\", kept_steps=4}"})
          .options;
  CHECK(kept.constraint_method == ConstraintMethod::direct);
  CHECK(kept.renew == Renew::kept);
  CHECK(kept.keep_steps == 4);
  CHECK(system_scene(kPendulumName, {"joints={penalty=1e7, tangent=\"iteration\"}"})
            .options.penalty == 1e7);
  CHECK_THAT(system_with(kPendulumName, {"joints.hold=\"lagrange\""}),
             Contains("hold = \"lagrange\"") && Contains("\"baumgarte\"") && Contains("E-KEY-06"));
  CHECK_THAT(system_with(kPendulumName, {"joints.alpha_per_s=5"}),
             Contains("expected hold = \"baumgarte\" beside it [E-BODY-27]"));
  CHECK_THAT(system_with(kPendulumName, {"joints={hold=\"direct\", penalty=5}"}),
             Contains("expected hold = \"augmented-lagrangian\" beside it [E-BODY-27]"));
  CHECK_THAT(system_with(kPendulumName, {"joints.kept_steps=5"}), Contains("tangent = \"kept\""));
  CHECK_THAT(system_with(kPendulumName, {"joints.cap=0"}),
             Contains("cap = 0") && Contains("1 to 1000"));
  CHECK_THAT(system_with(kPendulumName, {"joints.pennalty=5"}),
             Contains("'penalty'") && Contains("E-KEY-02"));
}

TEST_CASE("a body stands and turns as its keys say", "[scene]") {
  const RigidBody b = system_scene(kSpring, {"body[0].rotation_deg=[0, 0, 90]",
                                             "body[0].inertia_kg_m2=[3, 2, 2.5, 0.1, 0.2, 0.3]",
                                             "body[0].angular_velocity_rad_per_s=[1, 2, 3]"})
                          .system.bodies[0];
  CHECK((b.orientation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-15);
  CHECK(b.inertia(0, 1) == .1);
  CHECK(b.inertia(2, 0) == .2);
  CHECK(b.inertia(1, 2) == .3);
  CHECK(b.angular_velocity == Eigen::Vector3d(1., 2., 3.));
}

TEST_CASE("a beam in the plane of x and z has the section's left at +y", "[scene]") {
  const auto axes = [](const Overrides& overrides) {
    return system_scene(kPendulumName, overrides).system.beams[0].axes;
  };
  const std::string joint = "joint=[]", sensor = "sensor=[]";
  Eigen::Matrix3d down = axes({"beam[0].direction=[0, 0, -2]", joint, sensor});
  CHECK((down.col(0) + Eigen::Vector3d::UnitZ()).norm() < 1e-15);
  CHECK((down.col(1) - Eigen::Vector3d::UnitY()).norm() < 1e-15);
  const Eigen::Matrix3d across =
      axes({"beam[0].direction=[0, 3, 0]", "beam[0].up=[0, 0, 1]", joint, sensor});
  CHECK((across.col(1) + Eigen::Vector3d::UnitX()).norm() < 1e-15);
  CHECK_THAT(across.determinant(), WithinAbs(1., 1e-15));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].direction=[0, 1, 0]"}),
             Contains("[beam[0]]") && Contains("key 'up'"));
  CHECK_THAT(
      system_with(kPendulumName, {"beam[0].up=[1, 0, 1]"}),
      Contains("up stands at 45 degrees to the beam's direction; expected 90 degrees [E-BODY-34]"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].direction=[0, 0, 0]"}), Contains("E-BODY-31"));
}

TEST_CASE("numbers that no mass has are refused", "[scene]") {
  CHECK_THAT(system_with(kSpring, {"body[0].mass_kg=0"}),
             Contains("[body[0]] mass_kg = 0") && Contains("E-KEY-05"));
  CHECK_THAT(system_with(kSpring, {"body[0].mass_kg=nan"}),
             Contains("mass_kg = nan") && Contains("E-KEY-04"));
  CHECK_THAT(system_with(kSpring, {"body[0].inertia_kg_m2=[1, 1, 2.1]"}),
             Contains("1, 1 and 2.1") && Contains("E-BODY-16"));
  CHECK(system_with(kSpring, {"body[0].inertia_kg_m2=[0.1, 0.2, 0.3]"}) ==
        "accepted");  // a flat body
  CHECK_THAT(system_with(kSpring, {"body[0].inertia_kg_m2=[1, 1, 0]"}),
             Contains("inertia of 0; expected above 0 [E-BODY-15]"));
  // The eigenvalues are 3, 1 and -1.
  CHECK_THAT(system_with(kSpring, {"body[0].inertia_kg_m2=[1, 1, 1, 2, 0, 0]"}),
             Contains("inertia of -1") && Contains("E-BODY-15"));
  CHECK_THAT(system_with(kSpring, {"body[0].inertia_kg_m2=[1, 1, 1, 2]"}),
             Contains("has 4 entries") && Contains("E-BODY-13"));
  CHECK_THAT(system_with(kSpring, {"body[0].position_m=[0, 0]"}),
             Contains("position_m") && Contains("E-KEY-07"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].length_m=-1"}), Contains("length_m = -1"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].elements=0"}), Contains("elements = 0"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].elements=1000000000"}), Contains("1 to 1000"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].young_pa=0"}),
             Contains("[beam[0]] young_pa = 0"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].rectangle.height_m=20"}),
             Contains("millimetres"));
  CHECK_THAT(system_with(kSpring, {"spring[0].stiffness_n_per_m=-1"}), Contains("at least 0"));
  CHECK_THAT(
      system_with(kSpring, {"spring[0].stiffness_n_per_m=0", "spring[0].damping_n_s_per_m=0"}),
      Contains("E-JOINT-12"));
  CHECK_THAT(system_with(kSpring, {"spring[0].point_m=[0.3, 0, -0.9]"}), Contains("E-JOINT-11"));
  CHECK_THAT(system_with(kSpring, {"system.gravity_m_per_s2=[0, 0, inf]"}), Contains("E-KEY-04"));
}

TEST_CASE("an unknown name or one given twice is refused", "[scene]") {
  CHECK_THAT(system_with(kPendulumName, {"joint[0].between=[\"uper\", \"lower\"]"}),
             Contains("[joint[0]] between has \"uper\", which is unknown; expected \"ground\", "
                      "\"upper\", \"lower\" [E-BODY-23]"));
  CHECK_THAT(system_with(kPendulumName, {"joint[0].between=[\"upper\", \"upper\"]"}),
             Contains("\"upper\" twice") && Contains("E-JOINT-01"));
  CHECK_THAT(system_with(kPendulumName, {"joint[0].between=[\"upper\"]"}), Contains("1 entries"));
  CHECK_THAT(system_with(kPendulumName, {"joint[0].between=[\"rail left\", \"lower\"]"}),
             Contains("E-BODY-36"));
  CHECK_THAT(
      system_with(kPendulumName, {"sensor[0].on=\"ground\""}),
      Contains("on has \"ground\", which is unknown; expected \"upper\", \"lower\" [E-BODY-23]"));
  CHECK_THAT(system_with(kPendulumName, {"beam[1].name=\"upper\""}),
             Contains("[beam[1]] name = \"upper\" is taken by [beam[0]]"));
  CHECK_THAT(system_with(kPendulumName, {"joint[0].name=\"upper\""}),
             Contains("is taken by [beam[0]]"));
  CHECK_THAT(system_with(kPendulumName, {"sensor[2].name=\"hinge\""}),
             Contains("is taken by [joint[0]]"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].name=\"ground\""}), Contains("E-BODY-19"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].name=\"a b\""}), Contains("E-RUNNER-14"));
}

TEST_CASE("points must lie on their beam", "[scene]") {
  CHECK_THAT(system_with(kPendulumName, {"sensor[1].position_m=[0.41, 0, 0]"}),
             Contains("[sensor[1]] position_m is at 0.41 m along beam \"upper\"; expected 0 to 0.4 "
                      "m [E-BODY-24]"));
  CHECK_THAT(system_with(kPendulumName, {"joint[0].point_m=[0.39, 0, 0]"}),
             Contains("point_m is at -0.01 m along beam \"lower\""));
  // The section's diagonal is sqrt(0.02^2 + 0.03^2) = 0.0361 m.
  CHECK_THAT(system_with(kPendulumName, {"sensor[1].position_m=[0.4, 0, 0.04]"}),
             Contains("position_m is 0.04 m beside beam \"upper\"; expected at most 0.0360555 m") &&
                 Contains("E-BODY-25"));
  CHECK(system_with(kPendulumName, {"sensor[1].position_m=[0.4, 0.015, 0.01]"}) ==
        "accepted");  // a corner
  CHECK_THAT(system_with(kPendulumName, {"sensor[1]={name=\"B\", on=\"upper\"}"}),
             Contains("'position_m'") && Contains("E-KEY-01"));
}

TEST_CASE("a kind of joint refuses keys of other kinds", "[scene]") {
  const auto joint = [](const std::string& keys) {
    return system_with(kSpring,
                       {"joint=[{name=\"j\", between=[\"ground\", \"bob\"], " + keys + "}]"});
  };
  const std::string at = "point_m=[0, 0, 0], ";
  CHECK_THAT(joint(at + "kind=\"ball\""),
             Contains("kind = \"ball\"") && Contains("\"revolute\"") && Contains("E-KEY-06"));
  CHECK_THAT(joint(at + "kind=\"revolute\""), Contains("'axis'") && Contains("E-KEY-01"));
  CHECK_THAT(joint(at + "kind=\"spherical\", axis=[0, 0, 1]"),
             Contains("axis does not belong to a spherical joint") && Contains("E-JOINT-08"));
  CHECK_THAT(joint("kind=\"spherical\""), Contains("'point_m'") && Contains("E-KEY-01"));
  CHECK_THAT(joint(at + "kind=\"distance\", other_point_m=[0, 0, 0]"), Contains("E-JOINT-10"));
  CHECK(joint(at + "kind=\"distance\", other_point_m=[0, 0, -1]") == "accepted");
  const std::string apart = at + "kind=\"distance\", other_point_m=[0, 0, -1], ";
  CHECK(joint(apart + "polynomial_m=[0, 0.1]") == "accepted");
  CHECK_THAT(joint(apart + "polynomial_m=[1, 0.1]"),
             Contains("begins at 1 m") && Contains("E-JOINT-06"));
  CHECK_THAT(joint(apart + "table_m=[[0, 0], [1, -1.5]]"),
             Contains("a distance of 1 m by 1.5 m") && Contains("E-JOINT-07"));
  CHECK_THAT(joint(apart + "polynomial_rad=[0, 1]"),
             Contains("polynomial_rad does not belong to a distance joint"));
  CHECK_THAT(joint(at + "kind=\"universal\", axis=[1, 0, 0], other_axis=[1, 1, 0]"),
             Contains("other_axis stands at 45 degrees to axis; expected 90 degrees [E-BODY-34]"));
  CHECK(joint(at + "kind=\"universal\", axis=[1, 0, 0], other_axis=[0, 2, 0]") == "accepted");
  CHECK_THAT(joint(at + "kind=\"prismatic\", axis=[1, 0, 0], polynomial_m=[0, 1]"),
             Contains("polynomial_m does not belong to a prismatic joint"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0]"),
             Contains("'polynomial_m'") && Contains("E-KEY-01"));
  CHECK_THAT(joint(at + "kind=\"rotation\", axis=[1, 0, 0], polynomial_m=[0, 1]"),
             Contains("polynomial_m does not belong to a rotation joint"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0], polynomial_m=[0.1, 1]"),
             Contains("begins at 0.1 m") && Contains("E-JOINT-06"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0], polynomial_m=[0,1,2,3,4,5,6]"),
             Contains("has 7 entries"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0], table_m=[[0, 0], [0, 1]]"),
             Contains("E-RUNNER-02"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0], table_m=[[0, 0]]"),
             Contains("E-JOINT-04"));
  CHECK_THAT(joint(at + "kind=\"translation\", axis=[1, 0, 0], table_m=[[0, 0], [1, 1]], "
                        "polynomial_m=[0]"),
             Contains("table_m is given beside polynomial_m; expected one of them [E-JOINT-05]"));
  CHECK(joint(at + "kind=\"rotation\", axis=[0, 0, 1], table_rad=[[0, 0], [1, 3]]") == "accepted");
}

TEST_CASE("forces and moments are constant or given over time", "[scene]") {
  const auto force = [](const std::string& keys) {
    return "force=[{on=\"bob\", direction=[0, 0, 2], " + keys + "}]";
  };
  const SystemScene s = system_scene(kSpring, {force("point_m=[0, 0, 0], force_n=-5")});
  REQUIRE(s.system.forces.size() == 1);
  CHECK(s.system.forces[0].direction == Eigen::Vector3d::UnitZ());
  CHECK(s.system.forces[0].factor.polynomial == std::vector<double>{-5.});
  CHECK_FALSE(s.system.forces[0].moment);
  CHECK(system_scene(kSpring, {force("table_n_m=[[0, 1], [2, 3]]")}).system.forces[0].moment);
  CHECK_THAT(system_with(kSpring, {force("point_m=[0, 0, 0]")}),
             Contains("'polynomial_n'") && Contains("E-KEY-01"));
  CHECK_THAT(system_with(kSpring, {force("point_m=[0, 0, 0], moment_n_m=1")}),
             Contains("E-JOINT-15"));
  CHECK_THAT(
      system_with(kSpring, {force("point_m=[0, 0, 0], force_n=1, table_n=[[0, 1], [1, 1]]")}),
      Contains("table_n is given beside force_n; expected one of them [E-JOINT-05]"));
  CHECK_THAT(
      system_with(kPendulumName, {"force=[{on=\"upper\", direction=[0, 1, 0], moment_n_m=1}]"}),
      Contains("E-JOINT-16"));
  CHECK_THAT(system_with(kSpring, {"force=[{on=\"bob\", point_m=[0, 0, 0], force_n=1}]"}),
             Contains("'direction'") && Contains("E-KEY-01"));
}

TEST_CASE("a planar system refuses everything that leaves its plane", "[scene]") {
  CHECK(system_with(kPendulumName, {"system.planar=true"}) == "accepted");
  const std::string planar = "system.planar=true";
  CHECK_THAT(system_with(kPendulumName, {planar, "sensor[0].position_m=[0, 0.01, 0]"}),
             Contains("E-BODY-30"));
  CHECK_THAT(system_with(kPendulumName, {planar, "system.gravity_m_per_s2=[0, 1, -9]"}),
             Contains("y = 1"));
  CHECK_THAT(system_with(kPendulumName, {planar, "beam[0].direction=[1, 1, 0]"}),
             Contains("direction has y") && Contains("E-BODY-30"));
  CHECK_THAT(system_with(kPendulumName, {planar, "beam[0].up=[0, 0, -1]"}), Contains("E-BODY-18"));
  CHECK_THAT(system_with(kCrank, {"body[0].rotation_deg=[0, 0, 5]"}),
             Contains("rotation_deg = [0, 0, 5] turns out of the plane of x and z; expected a turn "
                      "about y alone, or system.planar = false [E-BODY-32]"));
  CHECK_THAT(system_with(kCrank, {"body[0].angular_velocity_rad_per_s=[1, 0, 0]"}),
             Contains("E-BODY-32"));
  CHECK_THAT(system_with(kCrank, {"body[0].inertia_kg_m2=[1, 1, 1, 0.1, 0, 0]"}),
             Contains("E-BODY-14"));
  CHECK(system_with(kCrank, {"body[0].inertia_kg_m2=[1, 1, 1, 0, 0.1, 0]"}) == "accepted");
  CHECK_THAT(system_with(kCrank, {"joint[0].axis=[0, 0, 1]"}), Contains("E-BODY-32"));
  CHECK_THAT(system_with(kCrank, {"joint[0].axis=[0, -1, 0]"}),
             Contains("expected [0, 1, 0] [E-BODY-33]"));
  CHECK_THAT(system_with(kCrank, {"joint[3].axis=[0, 1, 0]"}),
             Contains("axis has y = 1") && Contains("E-BODY-30"));
  CHECK_THAT(system_with(kCrank, {"joint[3].kind=\"cylindrical\""}), Contains("E-JOINT-09"));
}

TEST_CASE("a scene without a track refuses a track's keys", "[scene]") {
  CHECK_THAT(system_with("moving_load", {"body=[]"}), Contains("E-BODY-28"));
  CHECK_THAT(system_with(kPendulumName, {"support.stiffness_z_n_per_m=1"}),
             Contains("[support]") && Contains("E-BODY-26"));
  CHECK_THAT(system_with(kPendulumName, {"condense.kind=\"modal\""}),
             Contains("[condense]") && Contains("E-BODY-26"));
  CHECK_THAT(system_with(kPendulumName, {"beam=[]", "joint=[]", "sensor=[]"}),
             Contains("E-BODY-28"));
  CHECK_THAT(
      system_with(kPendulumName, {"sensor[0].on=\"rail\""}),
      Contains("on has \"rail\", which is unknown; expected \"upper\", \"lower\" [E-BODY-23]"));
  for (const std::string& name : {kPendulumName, std::string("exciter_on_track")})
    CHECK_THROWS_WITH(read_scene(shipped(name)),
                      Contains(name + ".toml") && Contains("E-SCENE-02"));
  CHECK(std::holds_alternative<Scene>(read_any_scene(shipped("moving_load"))));
}

TEST_CASE("the [step] of a system has its schemes, starts and limits", "[scene]") {
  CHECK(system_scene(kPendulumName, {"step.scheme=\"energy-momentum\""}).step.scheme ==
        TimeScheme::energy_momentum);
  CHECK_THAT(system_with(kPendulumName, {"step.scheme=\"rk4\""}),
             Contains("one of \"generalised-alpha\", \"backward-euler\", "
                      "\"newmark\", \"hht\", \"energy-momentum\""));
  CHECK_THAT(system_with("moving_load", {"step.scheme=\"energy-momentum\""}),
             Contains("one of \"generalised-alpha\", \"backward-euler\""));
  CHECK(system_scene(kPendulumName).step.start == Start::released);
  CHECK(system_scene(kPendulumName, {"step.start=\"equilibrium\""}).step.start ==
        Start::equilibrium);
  CHECK_THAT(system_with(kPendulumName, {"step.frame_s=0.003"}), Contains("E-STEP-09"));
  CHECK_THAT(system_with(kPendulumName, {"step.dt_s=0"}), Contains("dt_s = 0 is out of range"));
  CHECK_THAT(system_with(kPendulumName, {"beam[0].rectangel.height_m=1"}), Contains("rectangel"));
}
