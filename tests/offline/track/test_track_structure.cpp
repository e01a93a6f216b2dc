#include <Eigen/SparseCholesky>
#include <algorithm>
#include <catch2/catch.hpp>

#include "offline/beam/equilibrium.h"
#include "offline/beam/track_structure.h"
#include "support/fine_track.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// Adds the moments that a nonlinear rail needs.
Track shaped(Track track) {
  track.section.moments = moments(kSectionF);
  return track;
}

/// The sleeper track with pads of two halves that can rock, nodes off the centroid and held ends.
Track awkward_track() {
  Track t = sleeper_track(1, {RailEnd::pinned, RailEnd::clamped});
  t.support.half_spread = .05;
  t.section.moments = moments(kSectionF);
  t.axis_z = .03;
  return t;
}

/// The same with compressed rails between clamps.
Track pressed_track() {
  Track t = awkward_track();
  t.ends = {RailEnd::clamped, RailEnd::clamped};
  t.axial_force = -4e5;
  return t;
}

/// Pads of any length under different rails.
Track rocking_track() {
  Track t = shaped(long_pads(1));
  Seat seat = t.seat(4);
  seat.pad[1].length = .3;
  t.changed_seats[4] = seat;
  t.right = t.bar(0);
  t.right->section.area *= .9;
  t.right->material.density = 7000.;
  return t;
}

Track single_rail_on_sleepers() {
  Track t = sleeper_track(1);
  t.rails = 1;
  return t;
}

/// Motion of each unknown of the lines in the plain coordinates of the structure: mirror
/// coordinates are (left +- mirrored right)/sqrt 2, and a sleeper has one lateral motion.
Eigen::MatrixXd plain_of_lines(const Track& track, const TrackStructure& rails,
                               const std::vector<Line>& lines) {
  Eigen::Index count = 0, first = 0;
  for (const Line& line : lines) count += line.unknowns();
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(rails.structure().unknowns(), count);
  for (const Line& line : lines) {
    for (int rail = 0; rail < track.rails; ++rail) {
      const double factor = line.rail_factor[static_cast<std::size_t>(rail)];
      const auto sign = [&](bool lateral) {
        return line.mirrored && rail == 1 && lateral ? -factor : factor;
      };
      for (int node = 0; node < track.nodes(); ++node)
        for (int k = 0; k < 9; ++k)
          if (const int u = line.unknown(rail, node, k); u >= 0)
            T(9 * (rail * track.nodes() + node) + k, first + u) =
                sign(k == 1 || k == 3 || k == 5 || k == 7);
      for (int seat = 0; seat < static_cast<int>(line.sleeper_unknown_of.size()); ++seat)
        for (int d = 0; d < 4; ++d) {
          const Functional end{.sleeper = {{rail, seat, d, 1.}}};
          const Eigen::SparseVector<double> row = rails.row(end);
          const Eigen::VectorXd moved = sleeper_row(track, line, rail, seat, d);
          for (Eigen::SparseVector<double>::InnerIterator at(row); at; ++at)
            T.row(at.index()).segment(first, line.unknowns()) = moved.transpose();
        }
    }
    first += line.unknowns();
  }
  return T;
}

}  // namespace

TEST_CASE("at rest a track's nonlinear tangent is the stiffness of its lines", "[statics]") {
  const Track track = GENERATE(shaped(paper_track()), shaped(sleeper_track(2)), awkward_track(),
                               pressed_track(), shaped(single_rail_on_sleepers()),
                               shaped(lopsided_track(1)), shaped(long_pads(2)), rocking_track());
  const std::vector<Line> lines = assemble(track);
  const TrackStructure rails(track);
  const Structure& s = rails.structure();
  Eigen::MatrixXd K(tangent(s, s.rest));
  for (int i = 0; i < s.unknowns(); ++i)
    if (s.held[static_cast<std::size_t>(i)]) {
      K.row(i).setZero();
      K.col(i).setZero();
    }
  const Eigen::MatrixXd T = plain_of_lines(track, rails, lines);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(T.cols(), T.cols());
  Eigen::VectorXd weights(T.cols());
  Eigen::Index first = 0;
  for (const Line& line : lines) {
    const Eigen::Index n = line.unknowns();
    expected.block(first, first, n, n) = Eigen::MatrixXd(line.stiffness);
    weights.segment(first, n) = weight(track, line);
    first += n;
  }
  CHECK(static_cast<long>(std::count(s.held.begin(), s.held.end(), false)) == T.cols());
  // Sums of the same numbers in another order.
  CHECK((T.transpose() * K * T - expected).cwiseAbs().maxCoeff() <
        1e-13 * expected.cwiseAbs().maxCoeff());
  CHECK((T.transpose() * rails.weight() - weights).norm() < 1e-13 * weights.norm());
}

TEST_CASE("the statics of structure and lines agree, with springs", "[statics]") {
  const Track track = GENERATE(shaped(paper_track()), shaped(sleeper_track(2)), awkward_track(),
                               shaped(lopsided_track(1)), rocking_track());
  const Statics statics(track);
  const TrackStructure rails(track);
  const Structure& s = rails.structure();
  const double x = track.bay_length * (track.bays == 4 ? 1.3 : 2.3);
  const std::vector<PointForce> forces = {{{0, x, .01, .1, 2}, -50e3}, {{1, x, 0., .1, 1}, 10e3}};
  Eigen::VectorXd f = rails.weight();
  for (const PointForce& force : forces) f += force.force * rails.row(force.at);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(free_part(s, tangent(s, s.rest)));
  const Eigen::VectorXd moved = factor.solve(free_part(s, f));
  const auto displacements = statics.solve(forces, 9.81);
  for (const RailPoint& point : {RailPoint{0, x, 0., .1, 2}, RailPoint{1, x, 0., -.085, 1},
                                 RailPoint{1, x - .2, .03, 0., 2}}) {
    const double found = free_part(s, Eigen::VectorXd(rails.row(point))).dot(moved);
    // Round-off: stiffness and slopes have a condition of about 1e6.
    CHECK_THAT(found, WithinRel(statics.at(displacements, point), 1e-10));
  }
}

TEST_CASE("a small load moves the nonlinear track as the linear one", "[statics]") {
  const Track track = GENERATE(awkward_track(), pressed_track());
  const Statics statics(track);
  const TrackStructure rails(track);
  const RailPoint under{0, 1.38, 0., .1, 2};
  const auto moved = [&](double newton) {
    const StructureLoad load{newton * Eigen::VectorXd(rails.row(under))};
    const Equilibrium found = equilibrium(rails.structure(), load);
    REQUIRE(found.converged);
    return rails.row(under).dot(Eigen::VectorXd(found.q - rails.structure().rest));
  };
  const double flexibility = statics.flexibility(under, under);
  const double large = moved(-1e5) / -1e5 - flexibility, half = moved(-5e4) / -5e4 - flexibility;
  // The difference is of first order in the load: half for half the load, opposite for a lift.
  CHECK(std::abs(large) > 1e-5 * flexibility);
  CHECK_THAT(half / large, WithinRel(.5, .02));
  CHECK_THAT((moved(5e4) / 5e4 - flexibility) / half, WithinRel(-1., .04));
}

TEST_CASE("tracks that cannot be nonlinear are refused", "[statics]") {
  CHECK_THROWS_WITH(TrackStructure(paper_track()), Catch::Contains("E-NONLINEAR-04"));
  CHECK_THROWS_WITH(TrackStructure(peers_track(1)), Catch::Contains("E-NONLINEAR-03"));
  Track loose = shaped(sleeper_track(1, {RailEnd::clamped, RailEnd::free}));
  Track tilting = awkward_track();
  loose.axial_force = tilting.axial_force = 1e5;
  CHECK_THROWS_WITH(TrackStructure(loose), Catch::Contains("E-NONLINEAR-08"));
  CHECK_THROWS_WITH(TrackStructure(tilting), Catch::Contains("E-NONLINEAR-08"));
}
