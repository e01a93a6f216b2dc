// Rails cut at bolted joints: closed forms, limits of stiffness, and joints in runs and residuals.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "offline/analysis/statics.h"
#include "offline/receptance/full_order.h"
#include "support/foundation.h"
#include "support/program.h"
#include "support/sections.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kRigid = std::numeric_limits<double>::infinity();

/// One rail with vertical bending only.
Track bare(int bays, double bay, int elements, RailEnds ends) {
  Track t;
  t.section = peers_rectangle();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.bay_length = bay;
  t.elements_per_bay = elements;
  t.ends = ends;
  return t;
}

RailJoint hinge(double x, double stiffness) {
  RailJoint joint;
  joint.x = x;
  joint.stiffness = {0., kRigid, kRigid};
  joint.rotation_stiffness[1] = stiffness;
  return joint;
}

/// Two rails in space on pads and sleepers.
Track ballasted(int bays, int elements) {
  Track t;
  t.section = section_f();
  t.bays = bays;
  t.elements_per_bay = elements;
  t.support = {.stiffness = {20e6, 40e6, 120e6},
               .damping = {10e3, 10e3, 30e3},
               .roll_stiffness = 2e5,
               .height_z = -.085,
               .half_spread = .05};
  t.sleeper = Sleeper{.mass = 300.,
                      .roll_inertia = 75.,
                      .ballast_stiffness = {40e6, 40e6, 70e6},
                      .ballast_damping = {50e3, 50e3, 80e3}};
  return t;
}

RailPoint axis(double x, int direction = 2, int rail = 0) { return {rail, x, 0., 0., direction}; }

/// b_x at one end of the joint's rail, on a track of one line.
double slope(const Statics& statics, const Eigen::VectorXd& u, int node, bool ahead) {
  const Line& line = statics.lines()[0];
  return u[ahead ? line.unknown_ahead(0, node, 6) : line.unknown(0, node, 6)];
}

}  // namespace

TEST_CASE("a beam with a hinge spring bends as in the closed form", "[joint]") {
  // The beam is pinned, with P over the hinge in the middle: there M = PL/4 and the joint opens by
  // M/k, so w = PL^3/48EI + PL/4kGA + PL^2/16k. Elements are exact at nodes; 1e-9 is rounding.
  const double P = 10e3, L = 3.;
  for (const int elements : {2, 8})
    for (const double k : {1e4, 1e6, 1e9}) {
      Track track = bare(1, L, elements, {RailEnd::pinned, RailEnd::pinned});
      track.joints = {hinge(L / 2., k)};
      const Statics statics(track);
      const std::vector<Eigen::VectorXd> u = statics.solve({{axis(L / 2.), -P}});
      const BendingBeam beam = bending_beam(track, BeamTheory::timoshenko);
      const double want = P * L * L * L / (48. * beam.stiffness) +
                          P * L / 4. * beam.shear_softness + P * L * L / (16. * k);
      CAPTURE(elements, k);
      CHECK_THAT(-statics.at(u, axis(L / 2.)), WithinRel(want, 1e-9));
      // b_x is minus the slope of the axis.
      const double turned =
          slope(statics, u[0], elements, true) - slope(statics, u[0], elements, false);
      CHECK_THAT(std::fabs(turned), WithinRel(P * L / (4. * k), 1e-6));
    }
}

namespace {

/// Errors of a joint's sag and kink under a load, relative to two beams on a foundation.
struct Missed {
  double sag, kink;
};

/// Timoshenko's beam on a foundation, w = a1 e^(k1 x) + a2 e^(k2 x) on x > 0, carries half the
/// force there, with M = EI theta' = 2 k theta at the hinge. The track has springs each `step`.
Missed missed_on_foundation(double k, double step) {
  const double P = 50e3, bed = 50e6, x = 10.;
  const int seat = static_cast<int>(std::round(x / step));
  Track track = bare(2 * seat, step, 2, {});
  track.support.stiffness[2] = bed * step;
  track.joints = {hinge(x, k)};
  const Statics statics(track);
  const std::vector<Eigen::VectorXd> u = statics.solve({{axis(x), -P}});
  const BendingBeam beam = bending_beam(track, BeamTheory::timoshenko);
  const Foundation wave(beam, bed, 0.);
  Eigen::Matrix2cd at_zero;
  Eigen::Vector2cd turn;
  for (int i = 0; i < 2; ++i) {
    const auto kappa = wave.kappa[static_cast<std::size_t>(i)];
    turn[i] = kappa - bed * beam.shear_softness / kappa;
    at_zero.col(i) << beam.stiffness * kappa * turn[i] - 2. * k * turn[i], -bed / kappa;
  }
  const Eigen::Vector2cd a = at_zero.inverse() * Eigen::Vector2cd(0., .5 * P);
  const double kink = 2. * (a[0] * turn[0] + a[1] * turn[1]).real();
  const double turned =
      slope(statics, u[0], 4 * seat, true) - slope(statics, u[0], 4 * seat, false);
  return {statics.at(u, axis(x)) / -std::fabs(a.sum().real()) - 1., std::fabs(turned / kink) - 1.};
}

}  // namespace

TEST_CASE("a joint on a foundation sags as two half beams with a hinge spring", "[joint]") {
  // Springs in place of a foundation are the trapezoidal rule. It errs by (lambda step)^2 = 3e-3,
  // with lambda = (bed/4EI)^(1/4) = 1.1 1/m, and by a quarter of that at half the step; 10 % is for
  // the next order.
  for (const double k : {0., 1e5, 1e6, 1e8}) {
    const Missed coarse = missed_on_foundation(k, .05), fine = missed_on_foundation(k, .025);
    CAPTURE(k, coarse.sag, coarse.kink, fine.sag, fine.kink);
    CHECK(std::fabs(coarse.sag) < 3e-3);
    CHECK(std::fabs(coarse.kink) < 3e-3);
    CHECK_THAT(fine.sag / coarse.sag, WithinRel(.25, .1));
  }
}

TEST_CASE("a stiff joint acts as a whole rail", "[joint]") {
  // Ends that share both unknowns are one node; with springs the difference falls as 1/k.
  Track whole = bare(8, .6, 2, {});
  whole.support.stiffness[2] = 30e6;
  Track cut = whole;
  cut.joints = {hinge(2.4, kRigid)};
  const Line a = assemble(whole)[0], b = assemble(cut)[0];
  REQUIRE(a.unknowns() == b.unknowns());
  CHECK((a.stiffness - b.stiffness).norm() == 0.);
  CHECK((a.mass - b.mass).norm() == 0.);
  const auto sag = [](const Track& track) {
    return Statics(track).flexibility(axis(2.4), axis(2.4));
  };
  const double uncut = sag(whole);
  const auto excess = [&](double k) {
    cut.joints = {hinge(2.4, k)};
    cut.joints[0].stiffness[2] = 100. * k;
    return sag(cut) / uncut - 1.;
  };
  CHECK(excess(1e7) > 0.);
  // It is a/(k + b) with the stiffness b around the joint: 4 % off 1/k at 1e8, 0.4 % at 1e9.
  CHECK_THAT(excess(1e10) / excess(1e9), WithinRel(.1, .01));
  CHECK(std::fabs(excess(1e12)) < 1e-5);
  // In space fishplates leave the ends' own strains free, which is 1e-3 of the sag of the axis.
  Track space = ballasted(8, 2);
  const double solid = Statics(space).flexibility(axis(2.4), axis(2.4));
  const double solid_y = Statics(space).flexibility(axis(2.4, 1), axis(2.4, 1));
  RailJoint stiff;
  stiff.x = 2.4;
  stiff.stiffness = {kRigid, kRigid, kRigid};
  stiff.rotation_stiffness = {1e12, kRigid, kRigid};
  space.joints = {stiff};
  CHECK_THAT(Statics(space).flexibility(axis(2.4), axis(2.4)), WithinRel(solid, 1e-3));
  CHECK_THAT(Statics(space).flexibility(axis(2.4, 1), axis(2.4, 1)), WithinRel(solid_y, 1e-2));
}

TEST_CASE("a joint works on rails whose section does not strain", "[joint]") {
  // On the axis the vertical motion is that of two unknowns per node; 1e-9 is rounding.
  Track plane = bare(8, .6, 2, {});
  plane.support.stiffness = {3e6, 20e6, 30e6};
  plane.support.roll_stiffness = 2e5;
  plane.joints = {hinge(2.4, 2e6)};
  Track space = plane;
  space.unknowns = Unknowns::rigid_section;
  const Statics flat(plane), turning(space);
  for (const double x : {2.4, 3.1})
    CHECK_THAT(turning.flexibility(axis(2.4), axis(x)),
               WithinRel(flat.flexibility(axis(2.4), axis(x)), 1e-9));
  // Rigid plates share all six unknowns, as without a joint. Without plates nothing passes.
  const auto sideways = [&](double plates) {
    space.joints[0].stiffness = {plates, plates, plates};
    space.joints[0].rotation_stiffness = {plates, plates, plates};
    return Statics(space).flexibility(axis(3., 1), axis(1.8, 1));
  };
  space.joints.clear();
  const double uncut = Statics(space).flexibility(axis(3., 1), axis(1.8, 1));
  space.joints = plane.joints;
  CHECK_THAT(sideways(1e13), WithinRel(uncut, 1e-4));  // EI / length over it: 1e6 / 1e13
  CHECK(std::fabs(sideways(0.)) < 1e-12 * std::fabs(uncut));
}

TEST_CASE("a joint without plates leaves two separate rails", "[joint]") {
  // The cut is over seat 4 of 8: the first four bays stand alone, on half of the pad at their end.
  Track cut = bare(8, .6, 2, {});
  cut.support.stiffness[2] = 30e6;
  Track half = cut;
  RailJoint none;
  none.x = 2.4;
  cut.joints = {none};
  half.bays = 4;
  half.changed_seats[4] = half.seat(4);
  half.changed_seats[4].pad[0].stiffness[2] *= .5;
  const Statics a(cut), b(half);
  for (const double x : {.3, 1.5, 2.1, 2.25})
    CHECK_THAT(a.flexibility(axis(x), axis(1.8)),
               WithinRel(b.flexibility(axis(x), axis(1.8)), 1e-9));
  CHECK(std::fabs(a.flexibility(axis(3.), axis(1.8))) < 1e-20);
  // Both ends share a pad, whose force is that of the half seat.
  CHECK_THAT(a.support_force(a.solve({{axis(1.8), -1e3}}), 0, 4),
             WithinRel(b.support_force(b.solve({{axis(1.8), -1e3}}), 0, 4), 1e-6));
  // On a sleeper both halves share it; at mid-bay nothing connects them.
  Track between = cut;
  between.joints[0].x = 2.7;
  CHECK(std::fabs(Statics(between).flexibility(axis(3.), axis(1.8))) < 1e-20);
  between.joints[0].stiffness[2] = 1e8;
  CHECK(Statics(between).flexibility(axis(3.), axis(1.8)) > 1e-11);
}

TEST_CASE("a joint in both rails is the same in mirror coordinates", "[joint]") {
  Track mirror = ballasted(6, 2);
  RailJoint joint = hinge(1.8, 2e6);
  joint.stiffness = {1e8, 3e8, 5e8};
  joint.damping = {1e3, 2e3, 3e3};
  joint.rotation_stiffness = {1e5, 2e6, 1e6};
  joint.rotation_damping = {10., 20., 30.};
  mirror.joints = {joint};
  Track general = mirror;
  general.mirror_coordinates = false;
  const Statics a(mirror), b(general);
  for (const int rail : {0, 1})
    for (const int d : {0, 1, 2})
      for (const double x : {1.5, 1.8, 2.1}) {
        CAPTURE(rail, d, x);
        const double want = b.flexibility(axis(x, d, rail), axis(2., d, 0));
        // Both agree to 1e-9 (docs/supports.md), relative to the place under the load.
        CHECK_THAT(a.flexibility(axis(x, d, rail), axis(2., d, 0)),
                   WithinAbs(want, 1e-9 * b.flexibility(axis(2., d, 0), axis(2., d, 0))));
      }
  // With a cut only on the left the sides differ, and the right one is stiffer.
  mirror.joints[0].rails = {true, false};
  CHECK_FALSE(is_symmetric(mirror));
  const Statics one(mirror);
  CHECK(one.flexibility(axis(1.8, 1, 0), axis(1.8, 1, 0)) >
        1.02 * one.flexibility(axis(1.8, 1, 1), axis(1.8, 1, 1)));
}

TEST_CASE("the residual flexibility includes the cut", "[joint]") {
  // Static receptance with the residual, against eight times as many elements with the points at
  // their nodes: 1e-5 for quadratic elements under a long pad. The division follows the pad only
  // where a point needs four parts of an element or more (x = 1.725, 1.875).
  Track coarse = bare(6, .6, 2, {});
  coarse.support.stiffness[2] = 30e6;
  coarse.joints = {hinge(1.8, 1e5)};
  coarse.joints[0].stiffness[2] = 2e8;
  for (const double length : {0., .2}) {
    coarse.support.length = length;
    Track fine = coarse;
    fine.elements_per_bay = 16;
    for (const double x : {1.65, 1.725, 1.8, 1.875})
      for (const double y : {1.65, 1.875, 2.1}) {
        if (length > 0. && x != 1.725 && y != 1.875) continue;
        CAPTURE(length, x, y);
        const Transfer at{rail_point(axis(x)), {rail_point(axis(y))}};
        const double want = FullOrderReceptance(fine, at).at(0.)[0].real();
        CHECK_THAT(FullOrderReceptance(coarse, at).at(0.)[0].real(), WithinRel(want, 1e-5));
      }
  }
}

TEST_CASE("joints must be where elements meet", "[joint]") {
  Track track = bare(4, .6, 2, {});
  track.support.stiffness[2] = 30e6;
  const auto refused = [&](double x) {
    track.joints = {hinge(x, 1e5)};
    CHECK_THROWS_AS(assemble(track), std::invalid_argument);
  };
  for (const double x : {0., .1, .45, 2.4, 3., -.3}) refused(x);
  track.joints = {hinge(.9, 1e5), hinge(.9, 1e6)};
  CHECK_THROWS_AS(assemble(track), std::invalid_argument);
  track.joints.pop_back();
  CHECK(assemble(track)[0].unknowns() == 2 * 17 + 1);  // both sides share their heights
  track.joints[0].rotation_stiffness[0] = kRigid;
  CHECK_THROWS_AS(assemble(track), std::invalid_argument);
}

namespace {

nlohmann::json told(const std::string& words) {
  const Ran ran = railstep_program(words);
  CAPTURE(words, ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(ran.out);
}

const std::string kJoint =
    "--set 'rail_joint=[{x_m=4.8, bending_vertical_stiffness_n_m_per_rad=1e6, "
    "bending_vertical_damping_n_m_s_per_rad=200}]' ";

}  // namespace

TEST_CASE("loads and wheels run over a joint", "[joint]") {
  // In full order the balance of energy errs only by the scheme's loss (rounding is 1e-12).
  const auto run =
      told("run " + kScenes + "moving_load.toml --json --set track.elements_per_bay=2 " + kJoint);
  CHECK_THAT(run.at("energy_balance_error").get<double>(),
             WithinAbs(run.at("numerical_loss").get<double>(), 1e-12));
  CHECK(run.at("status").empty());
  const auto wheels = told("run " + kScenes +
                           "wheelset_on_track.toml --json --duration 0.02 --set "
                           "'rail_joint=[{x_m=3.2, bending_vertical_stiffness_n_m_per_rad=1e6, "
                           "along_stiffness_n_per_m=1e7}]'");
  CHECK(wheels.at("status").empty());
  CHECK(wheels.at("allocations") == 0);
}

TEST_CASE("the joints of a scene are checked", "[joint]") {
  const auto said = [&](const std::string& words) {
    return railstep_program("static " + kScenes + "moving_load.toml " + words).err;
  };
  const auto refused = [&](const std::string& words, const std::string& why) {
    CAPTURE(words, said(words));
    CHECK(said(words).find(why) != std::string::npos);
  };
  refused("--set 'rail_joint=[{x_m=4.8}]'", "bending_vertical_stiffness_n_m_per_rad");
  refused("--set 'rail_joint=[{x_m=4.7, bending_vertical_stiffness_n_m_per_rad=1}]'",
          "4.2 and 4.8");
  for (const char* const model : {"nonlinear", "timoshenko"}) {
    std::string words = kJoint + "--set 'track.model=\"";
    words.append(model).append(
        "\"' --set track.rails=1 --set support.half_spread_m=0.05 --set 'load=[]' "
        "--set track.unknowns='\"full\"'");
    refused(words, "joints");
  }
  refused("--set 'rail_joint=[{x_m=9.6, bending_vertical_stiffness_n_m_per_rad=1}]'",
          "E-RAILJOINT-02");
  refused(kJoint + "--set rail.axial_force_n=1e5", "E-RAILJOINT-08");
  refused(kJoint + "--set 'track.ends=\"pinned\"' --set rail.temperature_rise_k=20",
          "E-RAILJOINT-07");
  // 1.15e-5 x 20 K x 9.6 m = 2.2 mm.
  const std::string gap =
      "--set 'rail_joint=[{x_m=4.8, gap_m=0.0023, "
      "bending_vertical_stiffness_n_m_per_rad=1e6}]' ";
  CHECK(said(gap + "--set 'track.ends=\"pinned\"' --set rail.temperature_rise_k=20").empty());
  CHECK(said(gap + "--set 'track.ends=\"pinned\"' --set rail.temperature_rise_k=21").empty());
  refused(
      "--set 'rail_joint=[{x_m=4.8, bending_vertical_stiffness_n_m_per_rad=1, "
      "shear_vertical_damping_n_s_per_m=3}]'",
      "share");
}
