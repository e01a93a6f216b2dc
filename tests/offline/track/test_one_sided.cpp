// Statics of one-sided supports: gaps, hanging sleepers, ballast under heavy loads, stops.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/analysis/statics.h"
#include "support/one_sided_tracks.h"
#include "support/rail_at.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("a gap under the loaded seat closes and carries as the reference says", "[supports]") {
  // R6 has a gap of 0.5 mm, printed to 7 digits; 1e-3 is the case's bound (H7).
  const Statics statics(with_gap(r6_track(), 20, .5e-3));
  REQUIRE(statics.ports().size() == 1);
  const double closes = 28372.82;
  CHECK(statics.support_force(statics.solve({{at(12.), -closes * (1. - 1e-3)}}), 0, 20) == 0.);
  CHECK(statics.support_force(statics.solve({{at(12.), -closes * (1. + 1e-3)}}), 0, 20) > 0.);
  const auto u = statics.solve({{at(12.), -50e3}});
  CHECK_THAT(statics.at(u, at(12.)), WithinRel(-7.493172e-4, 1e-3));
  CHECK_THAT(statics.support_force(u, 0, 20), WithinRel(7479.5, 1e-3));
  double sum = 0.;
  for (int seat = 0; seat <= 40; ++seat) sum += statics.support_force(u, 0, seat);
  CHECK_THAT(sum, WithinRel(50e3, 1e-9));
}

TEST_CASE("a sleeper that hangs over a gap of 0.5 mm carries as the reference says", "[supports]") {
  // rail-data.md has 100 kN over it: the gap carries 27.91 kN, the rail sinks by 1.1977 mm, and the
  // neighbours carry 29.44 and 9.77 kN; half a unit of the last digit.
  const Statics statics(with_gap(s1_rail(), 20, .5e-3));
  const auto u = statics.solve({{at(12.), -100e3}});
  CHECK_THAT(statics.port_forces(u).at(0), WithinAbs(27.91e3, 5.));
  CHECK_THAT(statics.at(u, at(12.)), WithinAbs(-1.1977e-3, 5e-8));
  for (const int side : {-1, 1}) {
    CHECK_THAT(statics.support_force(u, 0, 20 + side), WithinAbs(29.44e3, 5.));
    CHECK_THAT(statics.support_force(u, 0, 20 + 2 * side), WithinAbs(9.77e3, 5.));
  }
  // The pad over the gap is in series with it.
  CHECK_THAT(statics.support_force(u, 0, 20), WithinRel(statics.port_forces(u).at(0), 1e-8));
}

TEST_CASE("ballast that does not pull opens under a heavy load as a separate iteration finds",
          "[supports]") {
  // Where springs would pull, s = k max(0, -d) cancels that. With d1 and W of the track on springs,
  // d = d1 - W s and so s = k max(0, W s - d1). As k W is below 1 (a spring is part of its
  // surroundings), this iteration contracts; it has no active set and no Newton.
  const double k = 50e6, gravity = 9.81, load = -400e3;
  Track springs = s1_rail(24);
  Track one_sided = springs;
  one_sided.sleeper->ballast_unilateral = true;
  const Statics bilateral(springs), statics(one_sided);
  REQUIRE(statics.ports().size() == 25);
  const auto sleeper = [&](const Statics& on, const std::vector<Eigen::VectorXd>& u, int seat) {
    double z = 0.;
    for (std::size_t l = 0; l < u.size(); ++l)
      z += sleeper_row(on.track(), on.lines()[l], 0, seat, 2).dot(u[l]);
    return z;
  };
  const auto u1 = bilateral.solve({{at(7.5), load}}, gravity);
  Eigen::VectorXd d1(25), s = Eigen::VectorXd::Zero(25);
  Eigen::MatrixXd W(25, 25);
  for (int i = 0; i < 25; ++i) {
    d1[i] = -sleeper(bilateral, u1, i);
    Eigen::VectorXd unit = Eigen::VectorXd(sleeper_row(springs, bilateral.lines()[0], 0, i, 2));
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(bilateral.lines()[0].stiffness);
    const Eigen::VectorXd moved = factor.solve(unit);
    for (int j = 0; j < 25; ++j) W(j, i) = sleeper(bilateral, {moved}, j);
  }
  for (int turn = 0; turn < 20000; ++turn) s = (k * (W * s - d1)).cwiseMax(0.).eval();
  const Eigen::VectorXd want = (k * (d1 - W * s)).cwiseMax(0.);
  const auto u = statics.solve({{at(7.5), load}}, gravity);
  const std::vector<double> forces = statics.port_forces(u);
  double sum = 0., most = want.maxCoeff();
  int open = 0;
  for (int i = 0; i < 25; ++i) {
    const double force = forces[static_cast<std::size_t>(i)];
    CHECK_THAT(force, WithinAbs(want[i], 1e-8 * most));  // condition 1e8, rounding 1e-16
    open += force == 0. ? 1 : 0;
    sum += force;
  }
  // 14.4 m of rail with 60.2095 kg/m, and 25 halves of 300 kg.
  CHECK_THAT(sum, WithinRel(400e3 + gravity * (7850. * 7670e-6 * 14.4 + 25 * 150.), 1e-8));
  CHECK(open >= 4);
  CHECK(s.maxCoeff() > 1e3);  // springs would have pulled
}

TEST_CASE("one side of a sleeper can hang, and mirror coordinates find the same as one line",
          "[supports]") {
  Track t = with_gap(s1_track(8, 2), 4, .3e-3, true, false);
  Track alike = with_gap(s1_track(8, 2), 4, .3e-3);
  const Statics mixed(t);
  REQUIRE(mixed.ports().size() == 1);
  const auto u = mixed.solve({{at(2.4), -80e3}, {at(2.4, 1), -80e3}});
  CHECK(mixed.at(u, at(2.4)) < mixed.at(u, at(2.4, 1)));
  const Statics mirrored(alike);
  alike.mirror_coordinates = false;
  const Statics general(alike);
  // The loads are unequal, so that both halves take part; the results agree to rounding (as in
  // tests/offline/track/test_general_way).
  const std::vector<PointForce> loads = {{at(2.4), -80e3}, {at(2.5, 1), -50e3}};
  const auto a = mirrored.solve(loads), b = general.solve(loads);
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(mirrored.port_forces(a).at(j) > 0.);
    CHECK_THAT(mirrored.port_forces(a).at(j), WithinRel(general.port_forces(b).at(j), 1e-8));
  }
  CHECK_THAT(mirrored.at(a, at(2.6, 1)), WithinRel(general.at(b, at(2.6, 1)), 1e-8));
}

TEST_CASE("a one-sided pad of two halves lifts on one side", "[supports]") {
  // A moment about x acts on the railhead: with springs some halves would pull.
  Track t = s1_track(2, 2);
  t.rails = 1;
  t.sleeper.reset();
  t.support.roll_stiffness = 0.;
  t.support.half_spread = .05;
  t.support.unilateral = true;
  t.ends = {RailEnd::free, RailEnd::free};
  const Statics statics(t);
  REQUIRE(statics.ports().size() == 6);
  const auto u = statics.solve({{at(.6), -60e3}, {{0, .6, 0., .09, 1}, 15e3}});
  const std::vector<double> forces = statics.port_forces(u);
  int open = 0;
  double sum = 0., moment = 0.;
  for (std::size_t j = 0; j < forces.size(); ++j) {
    open += forces[j] == 0. ? 1 : 0;
    sum += forces[j];
    moment += forces[j] * (j % 2 == 0 ? .05 : -.05);
  }
  CHECK(open > 0);
  CHECK_THAT(sum, WithinRel(60e3, 1e-8));
  // About the seats' height, 81 mm below the axis: the halves at +y bear more.
  CHECK_THAT(moment, WithinRel(15e3 * (.09 + .081), 1e-7));
}

TEST_CASE("a stop beside the railhead takes its share of a lateral force", "[supports]") {
  Track t = s1_track(8, 2);
  t.rails = 1;
  t.sleeper.reset();
  t.stops = {
      {.rail = 0, .x = 2.4, .z = .09, .direction = 1, .side = 1., .gap = .2e-3, .stiffness = 80e6}};
  const Statics statics(t);
  const RailPoint head{0, 2.4, 0., .09, 1};
  const auto pushed = [&](double force) { return statics.solve({{head, force}}); };
  // Away from the stop, and until it meets it, the rail moves as without it.
  t.stops.clear();
  const Statics without(t);
  const double flexibility = without.flexibility(head, head);
  CHECK_THAT(statics.at(pushed(-40e3), head), WithinRel(-40e3 * flexibility, 1e-8));
  const double meets = .2e-3 / flexibility;
  CHECK(statics.port_forces(pushed(.999 * meets)).at(0) == 0.);
  // Beyond that the stop and the rail share the force: f = (F g - gap) / (1/k + g).
  const auto u = pushed(40e3);
  const double want = (40e3 * flexibility - .2e-3) / (1. / 80e6 + flexibility);
  const double stop = statics.port_forces(u).at(0);
  CHECK_THAT(stop, WithinRel(want, 1e-8));
  CHECK_THAT(statics.at(u, head), WithinRel(.2e-3 + stop / 80e6, 1e-8));
  double seats = 0.;
  for (int seat = 0; seat <= 8; ++seat) seats += 50e6 * statics.at(u, {0, .6 * seat, 0., -.081, 1});
  CHECK_THAT(seats + stop, WithinRel(40e3, 1e-8));
}

TEST_CASE("loads without an equilibrium are refused in one sentence", "[supports]") {
  Track t = r6_track();
  t.support.unilateral = true;
  t.bays = 20;
  const Statics statics(t);
  CHECK_THROWS_WITH(statics.solve({{at(6.), 10e3}}), Catch::Contains("E-TRACK-39"));
  // Beyond the last seat that holds the rail down, a load tips it over.
  Track tips = t;
  for (int seat = 0; seat <= 20; ++seat)
    if (seat != 10 && seat != 11) tips.changed_seats[seat] = {};
  CHECK_THROWS_WITH(Statics(tips).solve({{at(3.), -10e3}}), Catch::Contains("E-TRACK-38"));
  CHECK_NOTHROW(Statics(tips).solve({{at(6.3), -10e3}}));
  for (int seat = 0; seat <= 20; ++seat) tips.changed_seats[seat] = {};
  CHECK_THROWS_WITH(Statics(tips), Catch::Contains("E-TRACK-35"));
}

TEST_CASE("a sleeper of 0 kg over a gap acts as pad and gap in series", "[supports]") {
  Track t = with_gap(s1_rail(), 20, .5e-3);
  for (auto& [border, seat] : t.changed_seats) seat.sleeper->mass = 0.;
  const Statics light(t), heavy(with_gap(s1_rail(), 20, .5e-3));
  const auto a = light.solve({{at(12.), -100e3}}), b = heavy.solve({{at(12.), -100e3}});
  CHECK_THAT(light.port_forces(a).at(0), WithinRel(heavy.port_forces(b).at(0), 1e-9));
  t.changed_seats[20].pad[0].unilateral = true;
  CHECK_THROWS_WITH(Statics(t), Catch::Contains("0 kg"));
}
