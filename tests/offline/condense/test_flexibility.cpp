#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/fine_track.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

TEST_CASE("model and residual add up to the fine track's flexibility between ports",
          "[flexibility]") {
  const Kind kind = GENERATE(Kind::full, Kind::modal, Kind::nothing_kept);
  const auto [elements_per_bay, ends] =
      GENERATE(std::pair{1, RailEnds{}}, std::pair{2, RailEnds{RailEnd::clamped, RailEnd::clamped}},
               std::pair{2, RailEnds{RailEnd::pinned, RailEnd::free}});
  const Track coarse = sleeper_track(elements_per_bay, ends);
  const Statics fine(sleeper_track(kPoints * elements_per_bay, ends));
  const std::vector<Line> lines = assemble(coarse);
  const std::vector<Basis> bases = bases_of(kind, coarse, lines);
  const ResidualFlexibility residual(coarse, lines, bases, kPoints);
  const KeptFlexibility model(coarse, bases);
  const LoadPoint a{0, kHeadZ};
  const std::vector<double> under = residual.exact_under(a);
  const double largest = *std::max_element(under.begin(), under.end());
  for (const LoadPoint b : {LoadPoint{0, kHeadZ}, LoadPoint{0, 0.}, LoadPoint{1, kHeadZ}}) {
    const PairTable table = residual.between(a, b, kPoints);
    double inside = 0., beyond = 0., missing = 0.;
    for (int e = 0; e < coarse.elements(); ++e)
      for (const int p : {0, 3}) {
        const double x = place(coarse, e, p);
        const auto moved = fine.solve({{{a.rail, x, 0., a.z, 2}, 1.}});
        for (int e2 = 0; e2 < coarse.elements(); ++e2)
          for (const int q : {0, 3, 6}) {
            const double x2 = place(coarse, e2, q);
            // Load point b reads its whole row on the fine track, and its own row in the model.
            const double want = exact(fine, at_point({b.rail, x2, 0., b.z, 2}), moved);
            const double read_z = kind == Kind::full ? b.z : 0.;
            const double kept = model(at_point({b.rail, x2, 0., read_z, 2}), a.rail, x, a.z);
            const double error = std::abs(kept + table.at(e, p, e2, q) - want);
            double& sum = std::abs(e2 - e) <= table.range ? inside : beyond;
            sum = std::max(sum, error);
            missing = std::max(missing, std::abs(want - kept));
          }
      }
    CAPTURE(static_cast<int>(kind), elements_per_bay, b.rail, b.z, table.range, missing / largest);
    CHECK(inside / largest < kRounding);
    CHECK(beyond / largest < 1e-4);                         // the range states this
    if (b.rail == a.rail) CHECK(missing / largest > 1e-3);  // there is something to add
  }
}

TEST_CASE("model and residual add up to the fine track with unlike sides or long pads",
          "[flexibility]") {
  // Long pads spread their force over the fine track's shapes. The coarse functional reads a pad's
  // mean gap at Gauss points of its own elements, just as the fine track does.
  const Kind kind = GENERATE(Kind::full, Kind::modal, Kind::nothing_kept);
  const auto make = GENERATE(&lopsided_track, &long_pads);
  const Track coarse = make(1);
  const Statics fine(make(kPoints));
  const std::vector<Line> lines = assemble(coarse);
  const std::vector<Basis> bases = bases_of(kind, coarse, lines);
  const ResidualFlexibility residual(coarse, lines, bases, kPoints);
  const KeptFlexibility model(coarse, bases);
  const LoadPoint a{1, kHeadZ};
  const std::vector<double> under = residual.exact_under(a);
  const double largest = *std::max_element(under.begin(), under.end());
  const Functional pad = pad_gap(coarse, 0, 1);
  const std::vector<double> read = residual.from(a, pad);
  double error = 0., missing = 0.;
  for (const LoadPoint b : {LoadPoint{0, kHeadZ}, LoadPoint{1, kHeadZ}}) {
    const PairTable table = residual.between(a, b, kPoints);
    for (int e = 1; e < coarse.elements(); ++e)
      for (const int p : {0, 3, 6}) {
        const double x = place(coarse, e, p);
        const auto moved = fine.solve({{{a.rail, x, 0., a.z, 2}, 1.}});
        const auto compare = [&](double added, const Functional& full, const Functional& kept) {
          const double want = exact(fine, full, moved), own = model(kept, a.rail, x, a.z);
          error = std::max(error, std::abs(own + added - want));
          missing = std::max(missing, std::abs(want - own));
        };
        const double z = kind == Kind::full ? b.z : 0.;
        compare(table.at(e, p, e, 4), at_point({b.rail, place(coarse, e, 4), 0., b.z, 2}),
                at_point({b.rail, place(coarse, e, 4), 0., z, 2}));
        compare(read.data()[e * (kPoints + 1) + p], pad, pad);
      }
  }
  CAPTURE(static_cast<int>(kind), missing / largest);
  CHECK(error / largest < kRounding);
  CHECK(missing / largest > 1e-3);
}

TEST_CASE(
    "model and residual add up to the fine track from a load point to rails, sleepers and pads",
    "[flexibility]") {
  const Kind kind = GENERATE(Kind::full, Kind::modal, Kind::nothing_kept);
  const Track coarse = sleeper_track(1);
  const Statics fine(sleeper_track(kPoints));
  const std::vector<Line> lines = assemble(coarse);
  const std::vector<Basis> bases = bases_of(kind, coarse, lines);
  const ResidualFlexibility residual(coarse, lines, bases, kPoints);
  const KeptFlexibility model(coarse, bases);
  struct Case {
    const char* name;
    Functional functional;
  };
  // 1.57 m and 2.03 m are not at nodes of the fine track.
  const Case cases[] = {{"along x", at_point({0, 1.57, .02, kHeadZ, 0})},
                        {"lateral, other rail", at_point({1, 2.03, -.01, kHeadZ, 1})},
                        {"lateral, own rail", at_point({0, 2.03, 0., kFootZ, 1})},
                        {"vertical, off the middle", at_point({1, 1.57, .03, kFootZ, 2})},
                        {"vertical at a seat", at_point({0, 1.8, 0., 0., 2})},
                        {"vertical at the end", at_point({0, 3.6, 0., kHeadZ, 2})},
                        {"sleeper, along x", {.sleeper = {{0, 2, 0, 1.}}}},
                        {"sleeper, lateral", {.sleeper = {{1, 3, 1, 2.}}}},
                        {"sleeper, vertical", {.sleeper = {{0, 2, 2, 1.}}}},
                        {"pad", opening(0, 3)},
                        {"pad, other rail", opening(1, 2)}};
  for (const Case& c : cases) {
    double error = 0., size = 0., missing = 0.;
    const LoadPoint load_point{0, kHeadZ};
    const std::vector<double> table = residual.from(load_point, c.functional);
    REQUIRE(table.size() == static_cast<std::size_t>(coarse.elements() * (kPoints + 1)));
    for (int e = 0; e < coarse.elements(); ++e)
      for (int p = 0; p <= kPoints; ++p) {
        const double x = place(coarse, e, p);
        const double want = exact(fine, c.functional,
                                  fine.solve({{{load_point.rail, x, 0., load_point.z, 2}, 1.}}));
        const double kept = model(c.functional, load_point.rail, x, load_point.z);
        const double added =
            table[static_cast<std::size_t>(e) * (kPoints + 1) + static_cast<std::size_t>(p)];
        error = std::max(error, std::abs(kept + added - want));
        missing = std::max(missing, std::abs(kept - want));
        size = std::max(size, std::abs(want));
      }
    CAPTURE(c.name, static_cast<int>(kind), size, missing / size);
    CHECK(error / 2e-8 < kRounding);  // over the rail's own flexibility, m/N
    CHECK(missing > 10. * error);     // the table is not noise
    CHECK(size > 1e-12);              // m/N: the functional is not noise either
  }
}

TEST_CASE("a functional inside an element reads the exact element", "[flexibility]") {
  // At 1.57 m in 0.6 m elements with 8 parts, against 32 parts. A part, h = 75 mm, is read
  // quadratically where the rail is cubic: V h^3/(125 EI) = 2e-13 m/N. At the head 8 parts per
  // element miss the squeeze of the section, which decays over some 0.05 m.
  const Track coarse = sleeper_track(1);
  const Statics fine(sleeper_track(32));
  const ResidualFlexibility residual(
      coarse, assemble(coarse), bases_of(Kind::nothing_kept, coarse, assemble(coarse)), kPoints);
  const Functional foot = at_point({0, 1.57, 0., 0., 2});
  const std::vector<double> table = residual.from({0, 0.}, foot);
  for (int p = 0; p <= kPoints; ++p) {
    const double want = exact(fine, foot, fine.solve({{{0, place(coarse, 2, p), 0., 0., 2}, 1.}}));
    CAPTURE(p);
    CHECK_THAT(table[static_cast<std::size_t>(2 * (kPoints + 1) + p)], WithinAbs(want, 4e-13));
  }
}

TEST_CASE("a rigid sleeper moves equally under both rails", "[flexibility]") {
  const Track t = sleeper_track(1);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility whole(t, lines, bases_of(Kind::nothing_kept, t, lines), kPoints);
  const auto left = whole.from({0, kHeadZ}, {.sleeper = {{0, 3, 1, 1.}}});
  const auto right = whole.from({0, kHeadZ}, {.sleeper = {{1, 3, 1, 1.}}});
  double size = 0.;
  for (std::size_t i = 0; i < left.size(); ++i) {
    CHECK_THAT(right[i], WithinAbs(left[i], 1e-22));  // one unknown, the same factors
    size = std::max(size, std::abs(left[i]));
  }
  CHECK(size > 1e-12);  // m/N; the roll of the seats pushes it sideways
}

TEST_CASE("residual flexibility is symmetric in its ports", "[flexibility]") {
  const Kind kind = GENERATE(Kind::full, Kind::modal);
  const Track t = sleeper_track(1);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility residual(t, lines, bases_of(kind, t, lines), kPoints);
  const LoadPoint a{0, kHeadZ}, b{1, .02};
  const PairTable ab = residual.between(a, b, 4), ba = residual.between(b, a, 4);
  REQUIRE(ab.range == ba.range);
  double error = 0.;
  for (int e = 0; e < t.elements(); ++e)
    for (int e2 = 0; e2 < t.elements(); ++e2)
      for (int p = 0; p <= 4; ++p)
        for (int q = 0; q <= 4; ++q)
          error = std::max(error, std::abs(ab.at(e, p, e2, q) - ba.at(e2, q, e, p)));
  CHECK(error / 2e-8 < kRounding);
}

TEST_CASE("on the diagonal the table of pairs equals that of a single load point",
          "[flexibility]") {
  const Kind kind = GENERATE(Kind::full, Kind::modal);
  const Track t = sleeper_track(2);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility residual(t, lines, bases_of(kind, t, lines), kPoints);
  const LoadPoint load_point{1, kHeadZ};
  const std::vector<double> under = residual.under(load_point);
  const PairTable table = residual.between(load_point, load_point, 4);
  for (int e = 0; e < t.elements(); ++e)
    for (int p = 0; p <= 4; ++p)
      CHECK_THAT(
          table.at(e, p, e, p),
          WithinAbs(under[static_cast<std::size_t>(e * (kPoints + 1) + 2 * p)], kRounding * 2e-8));
}

TEST_CASE("the residual flexibility holds the jump of slope under a point force", "[flexibility]") {
  // A Timoshenko beam's slope jumps by -1/(k G A) under a unit force. The deflection is cubic on
  // both sides, so differences over 1, 2 and 3 intervals give the jump exactly; no model has it
  // inside an element. Rounding is 1e-8 of G (condition 1e8), times 12 for the differences, over
  // jump x h = G/400: 5e-5.
  const Kind kind = GENERATE(Kind::full, Kind::modal, Kind::nothing_kept);
  const Track t = peers_track(1);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility residual(t, lines, bases_of(kind, t, lines), 16);
  const PairTable table = residual.between({0, 0.}, {0, 0.}, 16);
  const double h = t.element_length() / 16.;
  for (const int e : {0, 7, 15})
    for (const int q : {4, 8, 12}) {
      const auto second = [&](int j) {
        return table.at(e, q + j, e, q) - 2. * table.at(e, q, e, q) + table.at(e, q - j, e, q);
      };
      const double jump = (3. * second(1) - 1.5 * second(2) + second(3) / 3.) / h;
      const BeamSection& s = t.section;
      CAPTURE(e, q, static_cast<int>(kind));
      CHECK_THAT(jump,
                 WithinRel(-1. / (s.shear_factor_z * t.material.shear_modulus() * s.area), 1e-4));
    }
}

TEST_CASE("the range ends where the residual flexibility becomes negligible", "[flexibility]") {
  // The largest |G_res| at each distance, by hand from fine and coarse statics or from modes.
  const Kind kind = GENERATE(Kind::full, Kind::modal);
  const Track coarse = peers_track(1);
  const Statics fine(peers_track(4));
  const std::vector<Line> lines = assemble(coarse);
  const std::vector<Basis> bases = bases_of(kind, coarse, lines);
  const KeptFlexibility model(coarse, bases);
  std::vector<double> by_distance(16, 0.);
  double largest = 0.;
  for (int i = 0; i <= 64; ++i) {
    const auto moved = fine.solve({{{0, .15 * i, 0., 0., 2}, 1.}});
    for (int j = 0; j <= 64; ++j) {
      const Functional there = at_point({0, .15 * j, 0., 0., 2});
      const double want = exact(fine, there, moved);
      const double lost = std::abs(want - model(there, 0, .15 * i, 0.));
      if (i == j) largest = std::max(largest, want);
      // A border belongs to the elements on both sides: the nearest and the farthest count.
      const int first = (i + 3) / 4 - 1, last = i / 4, first2 = (j + 3) / 4 - 1, last2 = j / 4;
      for (const int e : {std::max(first, 0), std::min(last, 15)})
        for (const int e2 : {std::max(first2, 0), std::min(last2, 15)}) {
          double& there_most = by_distance[static_cast<std::size_t>(std::abs(e - e2))];
          there_most = std::max(there_most, lost);
        }
    }
  }
  int range = 15;
  while (range > 0 && by_distance[static_cast<std::size_t>(range)] < 1e-4 * largest) --range;
  const PairTable table =
      ResidualFlexibility(coarse, lines, bases, kPoints).between({0, 0.}, {0, 0.}, 4);
  CAPTURE(static_cast<int>(kind));
  CHECK(table.range == range);
  CHECK(table.value.size() == static_cast<std::size_t>(16 * (2 * table.range + 1) * 25));
}

TEST_CASE("residual flexibility is below 0 only by the squeeze of a section", "[flexibility]") {
  const auto lowest = [](const std::vector<double>& table) {
    return *std::min_element(table.begin(), table.end());
  };
  // Two Gauss points see 5/6 of the energy of a squeeze at one end node. The element is too soft
  // there by some 1e-11 m/N; rounding is 2e-15.
  const Track soft = sleeper_track(2);
  const ResidualFlexibility at_head(soft, assemble(soft), {}, kPoints);
  CHECK(lowest(at_head.under({0, kHeadZ})) < -1e-12);
  // The modes of a track are a projection of it: on the axis only rounding makes a residual
  // negative.
  const Track t = peers_track(2);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility residual(t, lines, bases_of(Kind::modal, t, lines), kPoints);
  CHECK(lowest(residual.under({0, 0.})) > -kRounding * 2.5e-8);
}

TEST_CASE("lines that the load point does not move may be free", "[flexibility]") {
  Track t = sleeper_track(1);
  t.rails = 1;
  t.sleeper.reset();
  t.support = {.stiffness = {3e6, 0., 3e7}};  // nothing holds the rail sideways or in roll
  t.section.shear_centre_z = 0.;              // r_z and b_z decouple
  CHECK_NOTHROW(ResidualFlexibility(t, assemble(t), {}, 4).under({0, kHeadZ}));
  t.support.stiffness = {0., 0., 3e7};  // x is on b_z's line, which the axis does not move
  CHECK_NOTHROW(ResidualFlexibility(t, assemble(t), {}, 4).under({0, 0.}));
  CHECK_THROWS_WITH(ResidualFlexibility(t, assemble(t), {}, 4).under({0, kHeadZ}),
                    Catch::Contains("E-TRACK-35"));
  t.support.stiffness = {3e6, 3e6, 0.};
  const ResidualFlexibility loose(t, assemble(t), {}, 4);
  CHECK_THROWS_AS(loose.under({0, 0.}), std::invalid_argument);
  CHECK_THROWS_AS(loose.between({0, 0.}, {0, 0.}, 4), std::invalid_argument);
  CHECK_THROWS_AS(loose.from({0, 0.}, {}), std::invalid_argument);
}

TEST_CASE("tables of bad size, basis or place are refused", "[flexibility]") {
  const Track t = peers_track(1);
  const std::vector<Line> lines = assemble(t);
  CHECK_THROWS_WITH(ResidualFlexibility(t, lines, {}, 2), Catch::Contains("E-CONDENSE-09"));
  const std::vector<Basis> good = lowest_modes(t, lines, 1);
  std::vector<Basis> bad = good;
  bad.push_back(good[0]);
  CHECK_THROWS_WITH(ResidualFlexibility(t, lines, bad, 8), Catch::Contains("E-CONDENSE-10"));
  bad = good;
  bad[0].shapes = Eigen::MatrixXd(good[0].shapes.dense().topRows(10));
  CHECK_THROWS_WITH(ResidualFlexibility(t, lines, bad, 8), Catch::Contains("E-CONDENSE-19"));
  bad = good;
  bad[0].omega[0] = 0.;
  CHECK_THROWS_WITH(ResidualFlexibility(t, lines, bad, 8), Catch::Contains("E-CONDENSE-20"));
  const ResidualFlexibility residual(t, lines, {}, 8);
  CHECK_THROWS_AS(residual.under({1, 0.}), std::invalid_argument);  // there is one rail
  CHECK_THROWS_WITH(residual.between({0, 0.}, {0, 0.}, 3), Catch::Contains("E-CONDENSE-12"));
  CHECK_THROWS_WITH(residual.from({0, 0.}, at_point({0, 9.7, 0., 0., 2})),
                    Catch::Contains("E-TRACK-05"));
  CHECK_THROWS_WITH(residual.from({0, 0.}, at_point({1, 1., 0., 0., 2})),
                    Catch::Contains("E-CONDENSE-07"));
  CHECK_THROWS_AS(residual.from({0, 0.}, {.sleeper = {{0, 3, 2, 1.}}}), std::invalid_argument);
}
