#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "offline/analysis/krylov.h"
#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/condense/component.h"
#include "offline/condense/reduction.h"
#include "offline/pack/accuracy.h"
#include "support/condensed_tracks.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

namespace {

using Value = std::complex<double>;
constexpr ReductionKind kAll[] = {ReductionKind::modal,  ReductionKind::guyan,
                                  ReductionKind::irs,    ReductionKind::craig_bampton,
                                  ReductionKind::krylov, ReductionKind::complex_modes};

/// A ballasted rail; its pads have no damping, some, or the paper's 29e6 N s/m.
Track rail(int bays, double pad_damping, bool ballast_damped = true) {
  Track t = s1_track(bays, 2);
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.support.damping = {0., 0., pad_damping};
  t.support.height_z = 0.;
  if (!ballast_damped) t.sleeper->ballast_damping = {};
  return t;
}

Reduction of(ReductionKind kind, int most, std::vector<double> hz = {50., 400., 1200.}) {
  return {.kind = kind, .limit = {most, kUnlimited}, .expansion_hz = std::move(hz)};
}

/// Receptance at a frequency between rows of a full line, and below of a reduced line.
Eigen::MatrixXcd receptance(const Line& line, const Eigen::MatrixXd& rows, double hz) {
  const Eigen::SparseLU<Eigen::SparseMatrix<Value>> factor(
      dynamic_stiffness(line, {0., 2. * M_PI * hz}));
  return rows.transpose() * factor.solve(rows.cast<Value>().eval());
}
Eigen::MatrixXcd receptance(const ReducedLineModel& model, const Eigen::MatrixXd& rows, double hz) {
  const Value rate(0., 2. * M_PI * hz);
  const Eigen::MatrixXcd shape =
      model.modes.shape.transpose() * (model.basis.shapes.dense().transpose() * rows).cast<Value>();
  const Eigen::VectorXcd along = .5 * (rate - model.modes.rate.array()).inverse(),
                         back = .5 * (rate - model.modes.rate.conjugate().array()).inverse();
  const Eigen::MatrixXcd conjugate = shape.conjugate();
  return shape.transpose() * along.asDiagonal() * shape +
         conjugate.transpose() * back.asDiagonal() * conjugate;
}

Eigen::MatrixXd columns(const std::vector<Eigen::VectorXd>& all) {
  Eigen::MatrixXd result(all[0].size(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t j = 0; j < all.size(); ++j) result.col(static_cast<Eigen::Index>(j)) = all[j];
  return result;
}

Eigen::VectorXd vertical(const Track& track, const Line& line, double x) {
  return Eigen::VectorXd(point_row(track, line, {0, x, 0., 0., 2}));
}

/// Frequencies of dense matrices, Hz, ascending.
Eigen::VectorXd frequencies(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .cwiseSqrt() /
         (2. * M_PI);
}

/// The textbook's dense partition: T of Guyan, and its improvement.
struct Textbook {
  Eigen::MatrixXd T, improved, K, M;

  Textbook(const Line& line, const std::vector<int>& kept) : K(line.stiffness), M(line.mass) {
    const int n = line.unknowns();
    std::vector<int> follow;
    for (int i = 0; i < n; ++i)
      if (!std::binary_search(kept.begin(), kept.end(), i)) follow.push_back(i);
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(K(follow, follow)).inverse();
    T = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(kept.size()));
    T(kept, Eigen::all).setIdentity();
    T(follow, Eigen::all) = -inverse * K(follow, kept);
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
    S(follow, follow) = inverse;
    improved = T + S * M * T * (T.transpose() * M * T).inverse() * (T.transpose() * K * T);
  }
  Eigen::VectorXd hz(const Eigen::MatrixXd& shapes) const {
    return frequencies(shapes.transpose() * K * shapes, shapes.transpose() * M * shapes);
  }
};

}  // namespace

TEST_CASE("every kind except damped modes is a Galerkin projection", "[reduction]") {
  for (const Track& track : {rail(8, 20e3), rail(8, 29e6), paper_track(), s1_track(6, 2)})
    for (const Line& line : assemble(track)) {
      if (modes(line).frequency[0] < 1.) continue;  // free along x
      const Modes exact = modes(line);
      for (const ReductionKind kind : kAll) {
        if (kind == ReductionKind::complex_modes) continue;
        const Basis basis = reduce(track, line, of(kind, track.bays)).basis;
        const auto m = basis.omega.size();
        const Eigen::MatrixXd S = basis.shapes.dense();
        const Eigen::MatrixXd mass = S.transpose() * (line.mass * S);
        const Eigen::MatrixXd stiffness = S.transpose() * (line.stiffness * S);
        const Eigen::MatrixXd square = basis.omega.cwiseAbs2().asDiagonal();
        CAPTURE(static_cast<int>(kind), line.unknowns(), m);
        // As in test_modal: sums of some hundred terms of size 1, with room for cancellation.
        CHECK((mass - Eigen::MatrixXd::Identity(m, m)).cwiseAbs().maxCoeff() < 1e-10);
        CHECK((stiffness - square).cwiseAbs().maxCoeff() < 1e-10 * square.maxCoeff());
        // Rayleigh and Ritz: no frequency is below that of the line, but for rounding of 1e-12 of
        // the highest.
        const double rounding = 1e-12 * square.maxCoeff();
        for (Eigen::Index k = 0; k < std::min(m, exact.frequency.size()); ++k)
          CHECK(square(k, k) >=
                std::pow(2. * M_PI * exact.frequency[k], 2) * (1. - 1e-9) - rounding);
      }
    }
}

TEST_CASE("Guyan's shapes and the improved ones are those of the textbook", "[reduction]") {
  const Track track = rail(8, 0., false);  // without dampers there are no other shapes
  const Line line = assemble(track)[0];
  for (const int nodes : {1, 2, 4}) {
    const std::vector<int> kept = kept_unknowns(track, line, nodes);
    REQUIRE(kept.size() == static_cast<std::size_t>(2 * (8 * nodes + 1) + 9));
    const Textbook book(line, kept);
    const Eigen::VectorXd guyan = book.hz(book.T), improved = book.hz(book.improved);
    Reduction reduction = of(ReductionKind::guyan, 0);
    reduction.nodes_per_bay = nodes;
    const Eigen::VectorXd ours = reduce(track, line, reduction).basis.omega / (2. * M_PI);
    reduction.kind = ReductionKind::irs;
    const Eigen::VectorXd ours_improved = reduce(track, line, reduction).basis.omega / (2. * M_PI);
    REQUIRE(ours.size() == guyan.size());
    REQUIRE(ours_improved.size() == improved.size());
    const Eigen::VectorXd exact = modes(line).frequency;
    for (Eigen::Index k = 0; k < guyan.size(); ++k) {
      // The textbook inverts dense matrices of condition 1e6 or less.
      CHECK_THAT(ours[k], WithinRel(guyan[k], 1e-8));
      CHECK_THAT(ours_improved[k], WithinRel(improved[k], 1e-8));
    }
    // With r = (f / f held)^2, Guyan's shapes leave out r, so that their frequencies err by r. The
    // improved shapes leave out r^2 and err by r^3.
    for (Eigen::Index k = 0; nodes < 4 && k < 4; ++k) {  // 4 nodes leave nothing to condense
      const double left = guyan[k] / exact[k] - 1., left_improved = improved[k] / exact[k] - 1.;
      CAPTURE(nodes, k, left, left_improved);
      CHECK(left > 0.);
      CHECK(left_improved < std::max(10. * left * left, 1e-10));
    }
  }
}

TEST_CASE("static condensation is exact for forces on the unknowns that it keeps", "[reduction]") {
  const Track track = rail(8, 0., false);  // dampers' shapes would answer too
  const Line line = assemble(track)[0];
  const ReducedLineModel model = reduce(track, line, of(ReductionKind::guyan, 0));
  const Statics statics(track);
  for (const double seat : {0., 4., 7.}) {
    const Eigen::VectorXd force = vertical(track, line, seat * track.bay_length);
    const Eigen::VectorXd moved = model.basis.shapes.displacement(
        model.basis.static_response(model.basis.shapes.project(force)));
    const Eigen::VectorXd want = statics.solve({{{0, seat * track.bay_length, 0., 0., 2}, 1.}})[0];
    CHECK((moved - want).cwiseAbs().maxCoeff() < 1e-9 * want.cwiseAbs().maxCoeff());  // rounding
  }
  const Eigen::VectorXd between = vertical(track, line, 4.5 * track.bay_length);
  const Eigen::VectorXd there = model.basis.shapes.displacement(
      model.basis.static_response(model.basis.shapes.project(between)));
  const double got = between.dot(there);
  const RailPoint at{0, 4.5 * track.bay_length, 0., 0., 2};
  CHECK(got < (1. - 1e-3) * statics.flexibility(at, at));  // others need G_res
}

TEST_CASE("Craig and Bampton's parts are bays with held ends, and all of them are the line",
          "[reduction]") {
  const Track track = rail(6, 0., false);
  const Line line = assemble(track)[0];
  const Eigen::VectorXd exact = modes(line).frequency;
  const auto hz = [&](int per_bay) -> Eigen::VectorXd {
    return reduce(track, line, of(ReductionKind::craig_bampton, per_bay * track.bays)).basis.omega /
           (2. * M_PI);
  };
  // 2 elements per bay have 3 nodes of 2 unknowns between seats.
  const Eigen::VectorXd all = hz(6);
  REQUIRE(all.size() == exact.size());
  for (Eigen::Index k = 0; k < exact.size(); ++k) CHECK_THAT(all[k], WithinRel(exact[k], 1e-7));
  double last = 1.;
  for (const int per_bay : {0, 1, 2, 4}) {
    const Eigen::VectorXd found = hz(per_bay);
    CHECK(found.size() == 7 * 3 + 6 * per_bay);
    const double error = found[6] / exact[6] - 1.;
    CAPTURE(per_bay, error);
    CHECK(error > 0.);
    CHECK(error < last);
    last = error;
  }
  // The part itself is one bay clamped at both ends.
  Track bay = track;
  bay.bays = 1;
  bay.ends = {RailEnd::clamped, RailEnd::clamped};
  bay.sleeper.reset();
  const Line held = assemble(bay)[0];
  const Eigen::MatrixXd shapes =
      craig_bampton_shapes(line, kept_unknowns(track, line, 1), 1, kUnlimited).rightCols(6);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const Eigen::VectorXd shape = shapes.col(j);
    const double square = shape.dot(line.stiffness * shape) / shape.dot(line.mass * shape);
    CHECK_THAT(std::sqrt(square) / (2. * M_PI), WithinRel(modes(held).frequency[0], 1e-9));
  }
}

TEST_CASE("rational Krylov shapes have the damped receptance at their expansion points",
          "[reduction]") {
  const std::vector<double> points = {300.};
  for (const double damping : {20e3, 29e6}) {
    Track track = rail(6, damping);
    track.elements_per_bay = 8;
    const Line line = assemble(track)[0];
    const Eigen::MatrixXd rows =
        columns({vertical(track, line, 1.8), vertical(track, line, 2.1)});  // a seat, mid-bay
    const auto miss = [&](const ReducedLineModel& model, double hz) {
      const Eigen::MatrixXcd want = receptance(line, rows, hz);
      return (receptance(model, rows, hz) - want).cwiseAbs().maxCoeff() /
             want.cwiseAbs().maxCoeff();
    };
    const ReducedLineModel all = reduce(track, line, of(ReductionKind::krylov, 1000, points));
    CAPTURE(damping, all.basis.omega.size(), line.unknowns());
    // Shapes below 1e-14 of the strain energy are left out, 1e-7 of the largest amplitude.
    REQUIRE(all.basis.omega.size() < line.unknowns() / 2);
    CHECK(miss(all, 300.) < 1e-7);
    CHECK(miss(all, 1400.) > 1e-4);  // elsewhere it differs from the line
    // A smaller basis misses it, and less so the more it keeps.
    const ReducedLineModel few = reduce(track, line, of(ReductionKind::krylov, 3, points)),
                           more = reduce(track, line, of(ReductionKind::krylov, 18, points));
    CHECK(miss(few, 300.) > 1e-5);
    CHECK(miss(more, 300.) < miss(few, 300.));
  }
}

TEST_CASE("all damped modes are the line, and the slowest ones answer slow forces", "[reduction]") {
  for (const double damping : {20e3, 29e6}) {
    const Track track = rail(6, damping);
    const Line line = assemble(track)[0];
    const Eigen::MatrixXd rows = columns({vertical(track, line, 1.8), vertical(track, line, 2.1)});
    const ReducedLineModel all = reduce(track, line, of(ReductionKind::complex_modes, 10'000));
    const Basis whole = modal_basis(line, {10'000, kUnlimited});
    const Eigen::MatrixXd square = whole.omega.cwiseAbs2().cwiseInverse().asDiagonal();
    // Completeness is 1e-7 at most, in units of the softest mode.
    CHECK((all.basis.flexibility - square).cwiseAbs().maxCoeff() < 1e-7 * square.maxCoeff());
    const ReducedLineModel slow = reduce(track, line, of(ReductionKind::complex_modes, 18));
    CHECK(kept_coordinates(slow.basis, slow.modes) <= 18);
    CHECK(kept_coordinates(slow.basis, slow.modes) >= 16);
    const Eigen::MatrixXd acting = slow.basis.shapes.dense().transpose() * rows;
    const Eigen::MatrixXd whole_acting = whole.shapes.dense().transpose() * rows;
    const Eigen::MatrixXd missing = whole_acting.transpose() * whole.static_response(whole_acting) -
                                    acting.transpose() * slow.basis.static_response(acting);
    for (const double hz : {5., 20., 60.}) {
      const Eigen::MatrixXcd want = receptance(line, rows, hz), got = receptance(slow, rows, hz);
      const double bare = (got - want).cwiseAbs().maxCoeff() / want.cwiseAbs().maxCoeff(),
                   with = (got + missing.cast<Value>() - want).cwiseAbs().maxCoeff() /
                          want.cwiseAbs().maxCoeff();
      CAPTURE(damping, hz, bare, with);
      // The error left with residual flexibility grows from 0 with the frequency over the fastest
      // kept.
      const double fastest = std::abs(slow.modes.rate[slow.modes.rate.size() - 1]);
      CHECK(with < 4. * bare * 2. * M_PI * hz / fastest);
      CHECK(bare > 1e-4);
    }
  }
}

TEST_CASE("with residual flexibility every kind has the static flexibility of the refined rail",
          "[reduction]") {
  const Track track = rail(8, 20e3);
  const Traffic traffic{.loads = {{.start = 1., .speed = 5., .stop = 4., .force = -1e3}}};
  for (const ReductionKind kind : kAll)
    for (const bool residual : {true, false}) {
      PackOptions options{.scheme = held_force(1e-4, .6), .reduction = of(kind, 8)};
      options.residual_flexibility = residual;
      const PackedModel packed(track, traffic, options);
      const double error = static_error(track, packed);
      CAPTURE(static_cast<int>(kind), residual, error);
      // Cubics on tables of 16 intervals err by 1e-5; without tables the missing coordinates count.
      CHECK((residual ? error < 2e-5 : error > 1e-3));
    }
}

TEST_CASE("two real modes that nearly share a shape are kept or left together", "[reduction]") {
  // One mass, y'' + 2.01 y' + 1.01 y: the rates are -1 and -1.01, the squares of the shapes 100 and
  // -100. The slower mode alone is 99 times too soft.
  Line line{};
  line.mass.resize(1, 1);
  line.mass.insert(0, 0) = 1.;
  line.damping = 2.01 * line.mass;
  line.stiffness = 1.01 * line.mass;
  line.end_damping.resize(1, 1);
  line.rail_factor = {1., 0.};
  const Track track = rail(4, 0.);
  CHECK_THROWS_WITH(reduce(track, line, of(ReductionKind::complex_modes, 1)),
                    Contains("E-CONDENSE-22"));
  const ReducedLineModel both = reduce(track, line, of(ReductionKind::complex_modes, 2));
  CHECK_THAT(both.basis.flexibility(0, 0), WithinRel(1. / 1.01, 1e-9));
  CHECK(std::abs(both.basis.at_once(0, 0)) < 1e-9);
}

TEST_CASE("lines that a reduction cannot condense are refused in a sentence", "[reduction]") {
  const Track track = rail(4, 20e3);
  const Line line = assemble(track)[0];
  Reduction odd = of(ReductionKind::guyan, 0);
  odd.nodes_per_bay = 3;
  CHECK_THROWS_WITH(reduce(track, line, odd), Contains("E-CONDENSE-03"));
  CHECK_THROWS_WITH(reduce(track, line, of(ReductionKind::complex_modes, 0)),
                    Contains("E-CONDENSE-22"));
  CHECK_THROWS_WITH(
      reduce(track, line, of(ReductionKind::complex_modes, 4), line.stiffness.leftCols(1)),
      Contains("E-CONDENSE-24"));
  Track massless = rail(4, 0.);
  massless.sleeper->mass = 0.;
  for (const ReductionKind kind : kAll)
    CHECK_THROWS_WITH(reduce(massless, assemble(massless)[0], of(kind, 4)),
                      Contains("E-CONDENSE-21"));
  massless.sleeper->ballast_damping = {};
  for (const ReductionKind kind : kAll)
    CHECK_NOTHROW(reduce(massless, assemble(massless)[0], of(kind, 8)));
  Track loose = rail(4, 20e3);
  loose.sleeper->ballast_stiffness[2] = 0.;
  const Line free = assemble(loose)[0];
  for (const ReductionKind kind : kAll)
    CHECK_THROWS_WITH(reduce(loose, free, of(kind, 4)), Contains("E-TRACK-35"));
}
