#include <Eigen/Sparse>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "offline/pack/band_factor.h"
#include "offline/pack/half_solve.h"
#include "offline/pack/time_schemes.h"
#include "offline/track/track.h"
#include "support/reference_tracks.h"

using namespace railstep;

namespace {

BandFactor step_of(const Line& line, double dt) {
  const Scheme s = generalised_alpha(dt, .6);
  return factor_band(
      Eigen::SparseMatrix<double>(line.stiffness + s.kv * line.damping + s.kg * line.mass));
}

/// All of L^-1 b, not cut.
std::vector<double> whole_forward(const Band& S, std::vector<double> b) {
  solve_forward(S, {0, S.panels}, b.data());
  return b;
}

double square(const Band& S, std::vector<double> y) {
  const std::vector<double> own = y;
  divide_by_pivots(S, {0, S.panels}, y.data());
  return std::inner_product(own.begin(), own.end(), y.begin(), 0.);
}

}  // namespace

TEST_CASE("a solve halfway is cut only where it has faded, within the stated reach", "[half]") {
  for (const double dt : {1e-3, 5e-5}) {
    const Line line = assemble(s1_rail(96)).front();
    const BandFactor factor = step_of(line, dt);
    const Band S = factor.view();
    const std::int32_t reach = reach_of(S);
    CHECK(reach < S.panels / 2);
    std::int32_t farthest = 0;
    for (int unknown = 0; unknown < line.unknowns(); unknown += 5) {
      std::vector<double> b(static_cast<std::size_t>(S.panels) * kLanes, 0.);
      b[static_cast<std::size_t>(unknown)] = 1.;
      const std::vector<double> whole = whole_forward(S, b);
      const HalfSolve half = solve_halfway(S, b);
      std::vector<double> lost = whole;
      for (std::size_t i = 0; i < lost.size(); ++i) lost[i] -= half.forward[i];
      CHECK(square(S, lost) <= kFaded * kFaded * square(S, whole));
      CHECK(half.panels.first == unknown / kLanes);
      CHECK(half.panels.end <= unknown / kLanes + 1 + reach);
      farthest = std::max(farthest, half.panels.end - 1 - half.panels.first);
    }
    CHECK(farthest >= reach - 1);
  }
}

TEST_CASE("two solves halfway give the displacement of one place by a force at another", "[half]") {
  const Line line = assemble(s1_rail(40)).front();
  const BandFactor factor = step_of(line, 2e-4);
  const Band S = factor.view();
  const auto size = static_cast<std::size_t>(S.panels) * kLanes;
  const auto place = static_cast<std::size_t>(line.unknowns() / 2);
  std::vector<double> force(size, 0.);
  force[place] = 1.;
  const HalfSolve by = solve_halfway(S, force);
  std::vector<double> moved = force;
  solve_band(S, moved.data());
  for (int away = -60; away <= 60; ++away) {
    std::vector<double> row(size, 0.);
    const int unknown = line.unknowns() / 2 + away;
    const auto other = static_cast<std::size_t>(unknown);
    row[other] = 1.;
    const HalfSolve at = solve_halfway(S, row);
    const double between =
        panels_dot(common(at.panels, by.panels), at.forward.data(), by.over_pivots.data());
    const double under = panels_dot(at.panels, at.forward.data(), at.over_pivots.data());
    CHECK(std::abs(between - moved[other]) <= 1e-11 * std::sqrt(under * moved[place]));
  }
}
