#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

#include "fine_track.h"
#include "offline/condense/selected_inverse.h"

using namespace railstep;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

/// Of a chain of groups of unknowns, closed to a ring or not, held at each by a little.
Sparse chain(int n, int width, bool ring, std::mt19937& random) {
  std::uniform_real_distribution<double> value(-1., 1.);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, .1);
    for (int d = 1; d < width; ++d) {
      if (!ring && i + d >= n) continue;
      const int j = (i + d) % n;
      const double k = 1. + value(random);
      entries.insert(entries.end(), {{i, i, k}, {j, j, k}, {i, j, -k}, {j, i, -k}});
    }
  }
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TEST_CASE("the inverse where its factor has entries", "[flexibility]") {
  const bool ring = GENERATE(false, true);
  const int width = GENERATE(2, 5);
  const auto seed = GENERATE(1U, 2U, 3U);
  CAPTURE(ring, width, seed);
  std::mt19937 random(seed);
  const Sparse matrix = chain(60, width, ring, random);
  const Eigen::MatrixXd whole = Eigen::MatrixXd(matrix).inverse();
  const Eigen::SimplicialLDLT<Sparse> factor(matrix);
  const SelectedInverse inverse(factor);
  double most = 0.;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry) {
      const auto i = static_cast<int>(entry.row());
      most = std::max(most, std::abs(inverse.at(i, j) - whole(i, j)));
    }
  CHECK(most < 1e-12 * whole.maxCoeff());
}

TEST_CASE("groups bring rows together that the matrix does not", "[flexibility]") {
  std::mt19937 random(4);
  const Sparse matrix = chain(40, 2, false, random);
  const Eigen::SimplicialLDLT<Sparse> bare(matrix), factor(grouped(matrix, {{-1, 3, 30}, {7}}));
  CHECK_THROWS_AS(SelectedInverse(bare).at(3, 30), std::out_of_range);
  const Eigen::MatrixXd whole = Eigen::MatrixXd(matrix).inverse();
  CHECK(std::abs(SelectedInverse(factor).at(30, 3) - whole(30, 3)) < 1e-12 * whole(30, 30));
}

TEST_CASE("a port's own table is the diagonal of that between ports", "[flexibility]") {
  const auto make = GENERATE(&lopsided_track, &long_pads);
  const Track track = make(1);
  const std::vector<Line> lines = assemble(track);
  double largest = 0., most = 0.;
  for (const Line& line : lines) {
    const auto exact = exact_line(track, line, 4);
    const Port a{0, kHeadZ}, b{0, 0.};
    if (line.rail_factor[0] == 0. || carried_unknowns(line, 0).empty()) continue;
    const Eigen::VectorXd under = exact->under(a, b, 4);
    const LineFlexibility::Strip strip = exact->between(a, b, 4);
    largest = std::max(largest, under.cwiseAbs().maxCoeff());
    for (int e = 0; e < track.elements(); ++e) {
      const Eigen::MatrixXd row = strip(e);
      for (int p = 0; p <= 4; ++p)
        most = std::max(most, std::abs(under[5 * e + p] - row(p, 5 * e + p)));
    }
  }
  CHECK(most < kRounding * largest);
}
