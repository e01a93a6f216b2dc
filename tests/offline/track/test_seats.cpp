// Seats that differ along the track and from left to right.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "support/condensed_tracks.h"
#include "support/fine_track.h"
#include "support/rail_at.h"
#include "support/reference_tracks.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("the deflection over missing supports is that of the reference", "[supports]") {
  // R6 is printed to 7 digits; 1e-3 is the case's bound (its beam is Timoshenko's, this one is the
  // element).
  Track t = r6_track();
  const Statics healthy(t);
  CHECK_THAT(50e3 * healthy.flexibility(at(12.), at(12.)), WithinRel(5.763979e-4, 1e-3));
  t.changed_seats[20] = {};
  const Statics one(t);
  CHECK_THAT(one.flexibility(at(12.), at(12.)) / healthy.flexibility(at(12.), at(12.)),
             WithinRel(1.528675, 1e-3));
  t.changed_seats[21] = {};
  const Statics two(t);
  CHECK_THAT(two.flexibility(at(12.3), at(12.3)) / healthy.flexibility(at(12.3), at(12.3)),
             WithinRel(2.299580, 1e-3));
  // The seat beside a missing one carries more: all forces sum to the load.
  const auto u = one.solve({{at(12.), -50e3}});
  double sum = 0.;
  for (int seat = 0; seat <= 40; ++seat) sum += one.support_force(u, 0, seat);
  CHECK(one.support_force(u, 0, 20) == 0.);
  CHECK_THAT(sum, WithinRel(50e3, 1e-9));
  // If all are missing the rail is free, and the message says where.
  for (int seat = 0; seat <= 40; ++seat) t.changed_seats[seat] = {};
  CHECK_THROWS_WITH(Statics(t), Catch::Contains("E-TRACK-35"));
}

TEST_CASE("a load that runs over a missing support has the deflection of the reference",
          "[supports]") {
  // R6: 50 kN at 30 m/s with dampers of 3e4 N s/m reach 8.824e-4 m, 1.5014 times the value without
  // a missing support (2e-4). A step of 0.2 ms misses the passage of the shape, 0.6 m / 30 m/s, by
  // (0.2/20)^2.
  const auto deepest = [](bool missing) {
    Track t = r6_track();
    t.support.damping = {0., 0., 3e4};
    if (missing) t.changed_seats[20] = {};
    Traffic traffic{.loads = {{.start = 6., .speed = 30., .stop = 20., .force = -50e3}}};
    ModelRun run = in_equilibrium(t, traffic, full_order(2e-4));
    double most = 0.;
    while (run.time() < .4) {  // 12 m; the first 3 m are the start
      run.step();
      if (run.time() > .1) most = std::max(most, -run.outputs.load_deflection[0]);
    }
    return most;
  };
  const double missing = deepest(true);
  CHECK_THAT(missing, WithinRel(8.824e-4, 1e-3));
  CHECK_THAT(missing / deepest(false), WithinRel(1.5014, 1e-3));
}

TEST_CASE("a sleeper that hangs on its rail has the reference's forces", "[supports]") {
  // rail-data.md: without ballast under the loaded sleeper 100 kN move the rail by 1.6613 mm; the
  // neighbours bear 40.84, 13.55, 0.52 and -2.52 kN; half a unit of the last digit.
  Track t = s1_rail();
  Seat hanging = t.seat(20);
  hanging.ballast = {};
  t.changed_seats[20] = hanging;
  const Statics statics(t);
  const auto u = statics.solve({{at(12.), -100e3}});
  CHECK_THAT(statics.at(u, at(12.)), WithinAbs(-1.6613e-3, 5e-8));
  const double forces[4] = {40.84e3, 13.55e3, .52e3, -2.52e3};
  for (int i = 0; i < 4; ++i)
    for (const int seat : {21 + i, 19 - i})
      CHECK_THAT(statics.support_force(u, 0, seat), WithinAbs(forces[i], 5.));
  CHECK_THAT(statics.support_force(u, 0, 20), WithinAbs(0., 1e-6));
}

TEST_CASE("a sleeper of 1 kg between springs of 1e9 and 1e8 N/m is stable with long steps",
          "[supports]") {
  // H8 of hard-cases.md: 9.090909e7 N/m in series, 5278.6 Hz free, stable with a step of 1 ms.
  Track t = s1_rail();
  t.bays = 8;
  t.support.stiffness = {0., 0., 1e9};
  t.support.damping = {0., 0., 1e3};
  t.sleeper = Sleeper{2., 1., {0., 0., 1e8}, {0., 0., 1e3}};  // a rail stands on half of it
  Track series = t;
  series.sleeper.reset();
  series.support.stiffness[2] = 9.090909090909e7;
  CHECK_THAT(Statics(t).flexibility(at(2.4), at(2.4)),
             WithinRel(Statics(series).flexibility(at(2.4), at(2.4)), 1e-9));
  // A rail with a million times its mass does not move where each of the nine sleepers swings, but
  // for 1 kg over 3.6e7 kg a bay. The rail's own modes are far below.
  Track still = t;
  still.material.density *= 1e6;
  const Eigen::VectorXd frequency = modes(assemble(still)[0]).frequency;
  for (Eigen::Index i = frequency.size() - 9; i < frequency.size(); ++i)
    CHECK_THAT(frequency[i], WithinRel(5278.6, 1e-5));  // as hard-cases.md prints it
  CHECK(frequency[frequency.size() - 10] < 1e3);
  // A load is put on the track at rest, so that all of it swings. The rail's swing on the seats
  // lasts longest: the pad's damper has 1e3 (1/1.1)^2 N s/m there for 36 kg, which is e^-23 in 2 s.
  Traffic traffic{.loads = {{.start = 2.4, .stop = 9., .force = -50e3}}};
  ModelRun run(t, traffic, full_order(1e-3));
  for (int i = 0; i < 2000; ++i) run.step();
  const double rest = -50e3 * Statics(t).flexibility(at(2.4), at(2.4));
  CHECK_THAT(run.outputs.load_deflection[0], WithinRel(rest, 1e-6));
}

TEST_CASE("uncoupled rails each stand on their own springs", "[supports]") {
  // H32 of hard-cases.md: left 3e7, right 1e8 N/m.
  Track t = r6_track();
  t.rails = 2;
  for (int seat = 0; seat <= t.bays; ++seat) {
    Seat there = t.seat(seat);
    there.pad[1].stiffness[2] = 1e8;
    t.changed_seats[seat] = there;
  }
  Track soft = r6_track(), stiff = r6_track();
  stiff.support.stiffness[2] = 1e8;
  const Statics both(t), left(soft), right(stiff);
  REQUIRE(both.lines().size() == 2);
  const auto u = both.solve({{at(12., 0), -50e3}, {at(12.3, 1), -20e3}});
  const auto one = left.solve({{at(12.), -50e3}}), other = right.solve({{at(12.3), -20e3}});
  double sum = 0.;
  for (int seat = 0; seat <= t.bays; ++seat) {
    CHECK(both.support_force(u, 0, seat) == left.support_force(one, 0, seat));
    CHECK(both.support_force(u, 1, seat) == right.support_force(other, 0, seat));
    sum += both.support_force(u, 0, seat) + both.support_force(u, 1, seat);
  }
  // The equation of the sum of all forces is solved to the rounding of K u: 1e9 N/m times 1e-3 m in
  // 162 rows, 1e6 * 1e-16 * sqrt(162) = 1e-9 N of 7e4.
  CHECK_THAT(sum, WithinRel(70e3, 1e-12));
}

namespace {

/// The same track in a separate assembly: all nine unknowns of every node of both rails, from the
/// matrices of a bare rail, then x, y, z, roll and yaw of every sleeper about its middle.
struct Dense {
  Eigen::MatrixXd K, M;
  int nodes;
  double g;

  explicit Dense(const Track& t) : nodes(t.nodes()), g(t.rail_spacing) {
    const int n = 18 * nodes + 5 * (t.bays + 1);
    K = Eigen::MatrixXd::Zero(n, n);
    M = Eigen::MatrixXd::Zero(n, n);
    for (const int rail : {0, 1}) add_rail(t, rail);
    for (int seat = 0; seat <= t.bays; ++seat) add_seat(t, seat);
  }
  int node_at(int rail, int node, int k) const { return 9 * (rail * nodes + node) + k; }
  int sleeper_at(int seat, int k) const { return 18 * nodes + 5 * seat + k; }
  double y(int rail) const { return rail == 0 ? g / 2. : -g / 2.; }

  void add_rail(Track t, int rail) {
    const RailBar own = t.bar(rail);
    t.section = own.section;
    t.material = own.material;
    t.axial_force = own.axial_force;
    t.right.reset();
    t.rails = 1;
    t.support = {};
    t.sleeper.reset();
    t.changed_seats.clear();
    for (const Line& line : assemble(t))
      for (int a = 0; a < 9 * nodes; ++a)
        for (int b = 0; b < 9 * nodes; ++b) {
          const int i = line.unknown(0, a / 9, a % 9), j = line.unknown(0, b / 9, b % 9);
          if (i < 0 || j < 0) continue;
          K(node_at(rail, 0, a), node_at(rail, 0, b)) += line.stiffness.coeff(i, j);
          M(node_at(rail, 0, a), node_at(rail, 0, b)) += line.mass.coeff(i, j);
        }
  }
  /// Displacement along d of the sleeper's point at y.
  Eigen::VectorXd sleeper(int seat, double at_y, int d) const {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(K.rows());
    row[sleeper_at(seat, d)] = 1.;
    if (d == 0) row[sleeper_at(seat, 4)] = -at_y;
    if (d == 2) row[sleeper_at(seat, 3)] = at_y;
    return row;
  }
  void spring(const Eigen::VectorXd& row, double k) { K += k * row * row.transpose(); }
  void add_seat(const Track& t, int seat) {
    const Seat there = t.seat(seat);
    const int border = 2 * t.elements_per_bay * seat;
    for (const int rail : {0, 1}) {
      const Support& pad = there.pad[static_cast<std::size_t>(rail)];
      for (const double beside : {-pad.half_spread, pad.half_spread})
        for (int d = 0; d < 3; ++d) {
          Eigen::VectorXd row = -sleeper(seat, y(rail) + beside, d);
          row[node_at(rail, border, d)] += 1.;
          row[node_at(rail, border, 3 + d)] += beside;
          row[node_at(rail, border, 6 + d)] += pad.height_z;
          spring(row, .5 * pad.stiffness[static_cast<std::size_t>(d)]);
        }
      Eigen::VectorXd roll = Eigen::VectorXd::Zero(K.rows());
      roll[node_at(rail, border, 5)] = .5;
      roll[node_at(rail, border, 7)] = -.5;
      roll[sleeper_at(seat, 3)] = -1.;
      spring(roll, pad.roll_stiffness);
      for (int d = 0; d < 3; ++d)
        spring(
            sleeper(seat, y(rail), d),
            there.ballast[static_cast<std::size_t>(rail)].stiffness[static_cast<std::size_t>(d)]);
    }
    for (int k = 0; k < 5; ++k)
      M(sleeper_at(seat, k), sleeper_at(seat, k)) =
          k < 3 ? there.sleeper->mass : there.sleeper->roll_inertia;
  }
  /// At y = 0 of the section, at a node.
  Eigen::VectorXd point(int rail, int node, double z, int d) const {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(K.rows());
    row[node_at(rail, node, d)] = 1.;
    row[node_at(rail, node, 6 + d)] = z;
    return row;
  }
};

}  // namespace

TEST_CASE("an unsymmetric track on rigid sleepers agrees with a separate assembly", "[supports]") {
  Track track = lopsided_track(1);
  SECTION("equal rails") {}
  SECTION("different rails") {
    RailBar right = track.bar(1);
    right.section.area *= .9;
    right.section.inertia_y *= .8;
    right.section.inertia_z *= .85;
    right.material.young = 200e9;
    right.axial_force = 300e3;
    track.right = right;
    track.axial_force = -200e3;
  }
  const Dense dense(track);
  const Statics statics(track);
  const Eigen::LDLT<Eigen::MatrixXd> factor(dense.K);
  const double bay = track.bay_length;
  for (const int rail : {0, 1})
    for (int d = 0; d < 3; ++d) {
      const Eigen::VectorXd load = dense.point(rail, 4, kHeadZ, d);  // over seat 2
      const Eigen::VectorXd moved = factor.solve(load);
      const double own = load.dot(moved);
      for (const int other : {0, 1})
        for (int e = 0; e < 3; ++e) {
          const double want = dense.point(other, 6, kHeadZ, e).dot(moved);
          const double got = statics.flexibility({other, 3. * bay, 0., kHeadZ, e},
                                                 {rail, 2. * bay, 0., kHeadZ, d});
          // Either matrix has a condition of 1e8.
          CHECK(std::abs(got - want) < 1e-8 * own);
        }
    }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense.K, dense.M,
                                                                         Eigen::EigenvaluesOnly);
  std::vector<double> found;
  for (const Line& line : statics.lines())
    for (const double f : modes(line).frequency) found.push_back(f);
  std::sort(found.begin(), found.end());
  REQUIRE(static_cast<Eigen::Index>(found.size()) == dense.K.rows());
  for (int i = 0; i < 40; ++i) {
    const double want = std::sqrt(solver.eigenvalues()[i]) / (2. * M_PI);
    CHECK_THAT(found[static_cast<std::size_t>(i)], WithinRel(want, 1e-7));
  }
}

TEST_CASE("an unsymmetric track stays at rest in its start in equilibrium", "[supports]") {
  // The loads are at quarters of an element, where the table of G_res has points. In full order and
  // condensed, model and residual give the static deflection of 16 elements per bay, but for what
  // the residual's reach leaves out between loads, 1e-4 of the largest deflection.
  const Track track = lopsided_track(1);
  Traffic traffic{.loads = {{.rail = 0, .start = 1.35, .stop = 9., .force = -50e3},
                            {.rail = 1, .start = 1.95, .stop = 9., .force = -20e3}}};
  const bool condensed_lines = GENERATE(false, true);
  ModelRun run = in_equilibrium(track, traffic,
                                condensed_lines ? condensed(track, 4., 1e-3) : full_order(1e-3));
  const Statics fine(lopsided_track(16));
  const RailPoint left = at(1.35, 0), right = at(1.95, 1);
  const auto u = fine.solve({{left, -50e3}, {right, -20e3}});
  for (int i = 0; i < 50; ++i) run.step();
  const double left_out = 1e-4 * std::abs(fine.at(u, left));
  CHECK_THAT(run.outputs.load_deflection[0], WithinAbs(fine.at(u, left), left_out));
  CHECK_THAT(run.outputs.load_deflection[1], WithinAbs(fine.at(u, right), left_out));
}

TEST_CASE("railheads are level on any supports", "[supports]") {
  // The height of the wheel's contact does not matter for rails that only move vertically. A right
  // head 20 mm nearer to its axis changes only the rounding of 200 steps with contacts.
  Track track = peers_pair(1);
  Traffic traffic{.wheelsets = {paper_wheelset(1.3)}, .head = kHead};
  traffic.wheelsets[0].speed = 20.;
  ModelRun alike = in_equilibrium(track, traffic, full_order(1e-4));
  traffic.right_head = Railhead{kHead.top_z - .02, kHead.crown_radius, kHead.half_width};
  ModelRun lower = in_equilibrium(track, traffic, full_order(1e-4));
  CHECK_THAT(lower.model().rail_z[1], WithinAbs(.02, 1e-16));
  for (int i = 0; i < 200; ++i) {
    alike.step();
    lower.step();
    for (int side = 0; side < 2; ++side)
      CHECK_THAT(lower.outputs.contact_force[side],
                 WithinRel(alike.outputs.contact_force[side], 1e-8));
  }
}

TEST_CASE("a wheelset stands with half its weight on each of two different rails", "[supports]") {
  // Nothing rolls the axle, so both wheels carry half of the weight, with the contact stiffness of
  // each rail: C goes with Young's modulus. The axle leans by 3e-4 rad, the difference of the
  // rails' deflections over their spacing. That part of the load pushes sideways from the start.
  Track track = lopsided_track(1);
  track.right = track.bar(0);
  track.right->material.young *= .5;
  track.right->section.inertia_y *= .8;
  Traffic traffic{.wheelsets = {paper_wheelset(1.5)}, .head = kHead};
  traffic.wheelsets[0].weight = 100e3;
  ModelRun run = in_equilibrium(track, traffic, full_order(1e-4));
  const ContactModel* const tread = run.model().contact;
  CHECK_THAT(tread[1].law.hertz, WithinRel(.5 * tread[0].law.hertz, 1e-12));
  for (int i = 0; i < 200; ++i) {
    run.step();
    for (int side = 0; side < 2; ++side)
      CHECK_THAT(run.outputs.contact_force[side], WithinRel(50e3, 1e-3));
  }
  CHECK(run.seen == Status::ok);
}
