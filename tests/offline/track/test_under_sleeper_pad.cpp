// Pads under sleepers: in series with the ballast, in every analysis and run.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "build/build.h"
#include "offline/analysis/critical_speed.h"
#include "offline/receptance/condensed.h"
#include "offline/receptance/exact_rail.h"
#include "offline/receptance/full_order.h"
#include "offline/track/fixed_port.h"
#include "scene/scene.h"
#include "support/bad_input.h"
#include "support/condensed_tracks.h"
#include "support/reference_tracks.h"
#include "support/traced.h"

using namespace railstep;
using Catch::Matchers::WithinRel;
using Stiffness = std::complex<double>;

namespace {

constexpr UnderSleeperPad kSoftPad{60e6, 30e3};  // 0.2 N/mm3 on 0.3 m2, soft

Functional on_sleeper(int seat, int rail = 0, int direction = 2) {
  return {.sleeper = {{rail, seat, direction, 1.}}};
}
Functional on_rail(double x) { return rail_point({0, x, 0., 0., 2}); }
Transfer driving(const Functional& point) { return {point, {point}}; }
double apart_from(const Stiffness& got, const Stiffness& want) { return std::abs(got / want - 1.); }

Track padded(Track track, const UnderSleeperPad& pad) {
  track.sleeper->under_pad = pad;
  track.sleeper = with_pads_joined(*track.sleeper);
  return track;
}

/// Dynamic stiffness of set S1's ballast under a pad, by its definition, N/m.
Stiffness in_series(const UnderSleeperPad& pad, double omega) {
  const Stiffness upper(pad.stiffness, omega * pad.damping), ballast(50e6, omega * 80e3);
  return upper * ballast / (upper + ballast);
}

/// Sleepers of set S1 under rails so loose that each swings alone.
Track loose_sleepers(int rails) {
  Track t = s1_rail(2);
  t.rails = rails;
  t.support.stiffness[2] = 1e-2;
  t.support.damping = {};
  t.ends = {RailEnd::clamped, RailEnd::clamped};
  return t;
}

// The mass of the inner unknown, 62 g of the sleeper's 150 kg for the strongest damper here.
constexpr double kInnerMass = 5e-4;

/// Set S1 by the program, on pads.
Track scene_track(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "rail={rectangle={height_m=0.17, width_m=0.045}}");
  return track_of(read_scene(shipped("ballasted_track"), overrides));
}

const std::string kPads = "under_sleeper_pad={stiffness_z_n_per_m=60e6, damping_z_n_s_per_m=30e3}";
const std::string kPadWords = " --set '" + kPads + "'";

double most_apart(const railstep::Rows& a, const railstep::Rows& b, const std::string& name) {
  const std::size_t at = a.column(name);
  double most = 0., apart = 0.;
  REQUIRE(a.row.size() == b.row.size());
  for (std::size_t r = 0; r < a.row.size(); ++r) {
    most = std::max(most, std::abs(a.row[r][at]));
    apart = std::max(apart, std::abs(a.row[r][at] - b.row[r][at]));
  }
  return apart / most;
}

}  // namespace

TEST_CASE("a load rests on pads and ballast in series", "[under_sleeper_pad]") {
  // In the middle of one bay, half of it on each sleeper: F/2 (1/K + 1/k).
  Track t = padded(s1_rail(1), kSoftPad);
  FullOrderReceptance sleeper(t, {on_rail(.3), {on_sleeper(0)}});
  CHECK_THAT(sleeper.at(0.)[0].real(), WithinRel(.5 * (1. / 60e6 + 1. / 50e6), 1e-9));
  Track series = s1_rail(20);
  series.sleeper->ballast_stiffness[2] = 1. / (1. / 60e6 + 1. / 50e6);
  t = padded(s1_rail(20), kSoftPad);
  const Transfer transfer = driving(on_rail(6.3));
  CHECK(apart_from(FullOrderReceptance(t, transfer).at(0.)[0],
                   FullOrderReceptance(series, transfer).at(0.)[0]) < 1e-9);
  CHECK_THAT(*critical_speed(t, 0), WithinRel(*critical_speed(series, 0), 1e-12));
}

TEST_CASE("a sleeper swings on the complex stiffness of pad and ballast in series",
          "[under_sleeper_pad]") {
  const UnderSleeperPad pads[] = {kSoftPad, {60e6, 0.}, {1e9, 1e5}, {60e6, 96e3}, {5e6, 300e3}};
  for (const UnderSleeperPad& pad : pads) {
    FullOrderReceptance one(padded(loose_sleepers(1), pad), driving(on_sleeper(1)), false);
    Track two = padded(loose_sleepers(2), pad);
    FullOrderReceptance mirrored(two, driving(on_sleeper(1)), false);
    two.mirror_coordinates = false;
    FullOrderReceptance general(two, driving(on_sleeper(1)), false);
    for (const double hz : {5., 40., 90., 200., 600., 2000.}) {
      const double w = 2. * M_PI * hz;
      const Stiffness bed = in_series(pad, w);
      CAPTURE(pad.stiffness, pad.damping, hz);
      CHECK(apart_from(one.at(hz)[0], 1. / (bed - w * w * 150.)) < kInnerMass);
      // Heave, and roll about x with the ends 0.75 m aside.
      const Stiffness both = .5 / (bed - w * w * 150.) + .5 / (bed - w * w * 169. / (2. * .5625));
      CHECK(apart_from(mirrored.at(hz)[0], both) < kInnerMass);
      CHECK(apart_from(general.at(hz)[0], both) < kInnerMass);
    }
  }
}

TEST_CASE("a pad under one end, and a sleeper that pitches", "[under_sleeper_pad]") {
  Track t = loose_sleepers(2);
  Seat seat = t.seat(1);
  seat.under_pad[0] = kSoftPad;
  t.changed_seats[1] = with_pads_joined(seat);
  CHECK_FALSE(is_symmetric(t));
  FullOrderReceptance across(t, {on_sleeper(1, 0), {on_sleeper(1, 1)}}, false);
  Track pitches = loose_sleepers(1);
  pitches.support.length = .16;
  pitches.sleeper->ballast_length = .26;
  pitches.sleeper->pitch_inertia = 8.;
  FullOrderReceptance turn(padded(pitches, kSoftPad), driving(on_sleeper(1, 0, 3)), false);
  for (const double hz : {5., 90., 600., 2000.}) {
    CAPTURE(hz);
    const double w = 2. * M_PI * hz, mass = w * w * 75., inertia = w * w * 169. / 2.25;
    // Over the displacements of the left and of the right end.
    const Stiffness left = in_series(kSoftPad, w) - mass - inertia,
                    right = Stiffness(50e6, w * 80e3) - mass - inertia, between = inertia - mass;
    CHECK(apart_from(across.at(hz)[0], -between / (left * right - between * between)) < kInnerMass);
    CHECK(apart_from(turn.at(hz)[0], 1. / (in_series(kSoftPad, w) * .26 * .26 / 12. - w * w * 4.)) <
          kInnerMass);
  }
}

TEST_CASE("a track on pads under sleepers answers as exact beams on them", "[under_sleeper_pad]") {
  Track t = padded(s1_rail(40), kSoftPad);
  t.elements_per_bay = 4;
  const Transfer transfer{on_rail(12.3), {on_rail(12.3), on_sleeper(20)}};
  FullOrderReceptance full(t, transfer);
  ExactRailReceptance exact(t, transfer, BeamTheory::timoshenko);
  for (const double hz : {20., 60., 100., 200., 400., 900.}) {
    CAPTURE(hz);
    for (const Eigen::Index read : {0, 1})
      CHECK(apart_from(full.at(hz)[read], exact.at(hz)[read]) < 3e-3);  // the mesh
  }
}

TEST_CASE("a very stiff pad under the sleeper changes nothing", "[under_sleeper_pad]") {
  const Track bare = s1_rail(20);
  const Transfer transfer = driving(on_rail(6.3));
  FullOrderReceptance without(bare, transfer);
  for (const double damping : {0., 1e5, 1e11}) {
    FullOrderReceptance stiff(padded(bare, {1e13, damping}), transfer);
    for (const double hz : {1., 60., 200., 900.})
      CHECK(apart_from(stiff.at(hz)[0], without.at(hz)[0]) < 1e-5);
  }
}

TEST_CASE("condensed tracks keep what relaxes in their pads", "[under_sleeper_pad]") {
  Track t = padded(s1_rail(20), kSoftPad);
  const Transfer transfer{on_rail(6.3), {on_rail(6.3), on_sleeper(10)}};
  FullOrderReceptance full(t, transfer);
  for (const ReductionKind kind :
       {ReductionKind::modal, ReductionKind::craig_bampton, ReductionKind::krylov}) {
    Reduction reduction{.kind = kind, .limit = {120, kUnlimited}};
    if (kind == ReductionKind::krylov) reduction.expansion_hz = {0., 100., 300., 800.};
    CondensedReceptance condensed(t, transfer, reduction);
    for (const double hz : {5., 40., 90., 200., 400.})
      for (const Eigen::Index read : {0, 1}) {
        CAPTURE(static_cast<int>(kind), hz, read);
        CHECK(apart_from(condensed.at(hz)[read], full.at(hz)[read]) < 1e-3);
      }
  }
}

TEST_CASE("runs on pads under sleepers, in full order, condensed and without end",
          "[under_sleeper_pad]") {
  const std::string scene = shipped("ballasted_track") + kPadWords +
                            " --set track.bays=24 --set step.duration_s=0.1"
                            " --set sensor[0].sleeper=9 --set sensor[1].position_m=5.4";
  const std::string full = scene + " --set 'condense.kind=\"full\"'",
                    fine = scene + " --set condense.modes_per_bay=4";
  const railstep::Rows a = traced(full), b = traced(fine);
  for (const char* name : {"sleeper.dz_m", "pad.dz_m", "support_9.force_z_n"})
    CHECK(most_apart(a, b, name) < 1e-2);
  for (const std::string& words : {full, fine, shipped("endless_track") + kPadWords}) {
    const auto found = told(words);
    CAPTURE(words);
    CHECK(found["status"].empty());
    CHECK(found["energy_balance_error"].get<double>() < 1e-3);
  }
  const auto folder = fresh_folder("pads");
  const std::string model = (folder / "pads.model").string();
  REQUIRE(railstep_program("condense " + fine + " --out " + model).code == 0);
  CHECK(traced(model).row == b.row);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a gap lies between pad and ballast, which then act as one spring and damper",
          "[under_sleeper_pad]") {
  const Track t = track_of(read_scene(shipped("hanging_sleeper"), {kPads}));
  const auto ports = fixed_ports(t);
  REQUIRE(ports.size() == 6);
  const double upper = 60. / 110., lower = 50. / 110.;
  for (const FixedPort& port : ports) {
    CHECK(port.gap == .5e-3);
    CHECK_THAT(port.stiffness, WithinRel(60e6 * lower, 1e-12));
    CHECK_THAT(port.damping, WithinRel(30e3 * lower * lower + 80e3 * upper * upper, 1e-12));
  }
  CHECK(t.seat(15).ballast[0].relaxing.damping == 0.);
  CHECK(t.seat(13).ballast[0].relaxing.damping > 0.);
  const Stiffness relaxes(0., 1e3 * t.seat(13).ballast[0].relaxing.damping);
  const double w = 1e3, r = relaxes.imag() / w, a = t.seat(13).ballast[0].relaxing.stiffness;
  const Stiffness simple(ports[0].stiffness, w * ports[0].damping), exact = in_series(kSoftPad, w);
  CHECK(apart_from(exact, simple) < r / ports[0].damping * std::min(1., w * r / a));
  for (const char* kind : {"full", "modal"}) {
    const auto found =
        told(shipped("hanging_sleeper") + kPadWords + " --set 'condense.kind=\"" + kind + "\"'");
    CHECK(found["status"].empty());
    CHECK(found["energy_balance_error"].get<double>() < 1e-3);
  }
}

TEST_CASE("a scene gives pads under sleepers, seat by seat", "[under_sleeper_pad]") {
  const Track all = scene_track({kPads});
  REQUIRE(all.sleeper.has_value());
  CHECK(all.sleeper->under_pad == UnderSleeperPad{});
  CHECK_THAT(all.sleeper->ballast_stiffness[2], WithinRel(1. / (1. / 60e6 + 1. / 50e6), 1e-12));
  CHECK(is_symmetric(all));
  // Pads at some seats alone; later changes act on pad and ballast, not on what both are in series.
  const Track some = scene_track(
      {"support_change=[{from=10, to=12, under_sleeper_pad.stiffness_z_n_per_m=[60e6, 100e6]},"
       "{seats=[12], rail=\"left\", ballast.stiffness_factor=2.0},"
       "{seats=[14], under_sleeper_pad={stiffness_z_n_per_m=60e6}, missing=\"ballast\"}]"});
  const auto bed = [&some](int seat, std::size_t side) {
    return some.seat(seat).ballast[side].stiffness[2];
  };
  CHECK(bed(9, 0) == 50e6);
  CHECK_THAT(bed(11, 0), WithinRel(80e6 * 50e6 / 130e6, 1e-12));
  CHECK_THAT(bed(12, 0), WithinRel(50e6, 1e-12));
  CHECK_THAT(bed(12, 1), WithinRel(100e6 * 50e6 / 150e6, 1e-12));
  CHECK(bed(14, 0) == 0.);
  const Track scattered =
      scene_track({kPads, "support_change=[{under_sleeper_pad={stiffness_scatter=0.2}, seed=7}]"});
  for (const std::size_t side : {0u, 1u}) {
    const double pad = 60e6 * scatter_factor(7, 4, 5, side, .2);
    CHECK_THAT(scattered.seat(5).ballast[side].stiffness[2],
               WithinRel(pad * 50e6 / (pad + 50e6), 1e-12));
  }
}

TEST_CASE("bad keys of a pad under sleepers are refused in one sentence", "[under_sleeper_pad]") {
  const BadInput bad("under_sleeper_pad");
  const auto refused = [&bad](const std::string& scene, const std::string& set,
                              const std::string& id) {
    bad.refused("static " + shipped(scene) + " --set '" + set + "'", {id, "under_sleeper_pad"});
  };
  const std::string change = "support_change=[{under_sleeper_pad=";
  refused("ballasted_track", "under_sleeper_pad={stiffness_z_n_per_m=0.0}", "E-KEY-");
  refused("ballasted_track", "under_sleeper_pad={damping_z_n_s_per_m=1e4}", "E-KEY-");
  refused("ballasted_track", "under_sleeper_pad={stiffness_z_n_per_m=1e8, gap_m=0.0}", "E-KEY-");
  refused("moving_load", kPads, "E-SUPPORT-02");
  refused("ballasted_track", change + "{damping_factor=2.0}}]", "E-SUPPORT-11");
  refused("ballasted_track", change + "{stiffness_z_n_per_m=1e8, unilateral=true}}]", "E-KEY-");
  refused("moving_load", change + "{stiffness_z_n_per_m=1e8}}]", "E-SUPPORT-11");
}
