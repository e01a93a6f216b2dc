#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <utility>
#include <vector>

#include "offline/condense/local_inverse.h"
#include "offline/math/sparse.h"
#include "support/fine_track.h"

using namespace railstep;
namespace {

/// Matrix of springs between neighbours up to `width` apart, all held by a weak spring.
Sparse chain(int n, int width, std::mt19937& random) {
  std::uniform_real_distribution<double> value(0., 2.);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, .1);
    for (int j = i + 1; j < std::min(i + width, n); ++j) {
      const double k = value(random);
      entries.insert(entries.end(), {{i, i, k}, {j, j, k}, {i, j, -k}, {j, i, -k}});
    }
  }
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TEST_CASE("near loads and far from them a local inverse gives the solution", "[flexibility]") {
  const int width = GENERATE(1, 2, 5);
  const auto seed = GENERATE(1U, 2U, 3U);
  std::mt19937 random(seed);
  const int n = 40;
  const Sparse matrix = chain(n, width, random);
  const LocalInverse inverse(matrix);
  const Eigen::LDLT<Eigen::MatrixXd> whole{Eigen::MatrixXd(matrix)};
  // One row, rows within a band, rows far apart, rows at both ends.
  for (const std::vector<int>& rows : std::vector<std::vector<int>>{
           {0}, {n - 1}, {17}, {17, 18}, {16, 20}, {3, 4, 30, 31}, {0, n - 1}}) {
    Eigen::SparseVector<double> load(n);
    for (const int row : rows) load.coeffRef(row) = 1. + row;
    const Eigen::VectorXd want = whole.solve(Eigen::VectorXd(load));
    for (const auto& [first, last] : std::vector<std::pair<int, int>>{
             {0, n}, {0, 1}, {n - 1, n}, {17, 18}, {10, 25}, {30, 33}, {5, 5}}) {
      CAPTURE(width, seed, rows, first, last);
      const Stretch got = inverse.solve(load, first, last);
      for (int i = first; i < last; ++i)
        CHECK(std::abs(got[i] - want[i]) < 1e-12 * want.maxCoeff());
      CHECK(got[first - 1] == 0.);
      CHECK(got[last] == 0.);
    }
  }
}

TEST_CASE("a load point's own table is the diagonal of the table between load points",
          "[flexibility]") {
  const auto make = GENERATE(&lopsided_track, &long_pads);
  const Track track = make(1);
  const std::vector<Line> lines = assemble(track);
  double largest = 0., most = 0.;
  for (const Line& line : lines) {
    const auto exact = exact_line(track, line, 4);
    const LoadPoint a{0, kHeadZ}, b{0, 0.};
    if (line.rail_factor[0] == 0. || carried_unknowns(line, 0).empty()) continue;
    const Eigen::VectorXd under = exact->under(a, b, 4);
    const LineFlexibility::Strip strip = exact->between(a, b, 4, 1);
    largest = std::max(largest, under.cwiseAbs().maxCoeff());
    for (int e = 0; e < track.elements(); ++e) {
      const Eigen::MatrixXd row = strip(e);
      for (int p = 0; p <= 4; ++p)
        most = std::max(most, std::abs(under[5 * e + p] - row(p, 5 + p)));
    }
  }
  CHECK(most < kRounding * largest);
}
