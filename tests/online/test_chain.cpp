#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "online/beam/chain.h"
#include "support/stored_kernels.h"

using namespace railstep;

namespace {

using Long = long double;
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double kLength = .6;       // m, of an element
constexpr double kMassFactor = 4e6;  // 4 / dt2 of the midpoint rule, dt 1 ms

/// Number of the spatial unknown that is unknown i of the chain.
template <int W>
int spatial_of(int i) {
  return W == 9 ? i : i / W * 9 + kPlanarOf[i % W];
}

/// A chain of n elements of section F in a shaken state, and its matrices, dense.
template <int W>
struct Case {
  BeamLaw law;
  Matrix27 element_mass;
  std::vector<std::int32_t> held;
  Chain chain;
  std::vector<double> tangents;
  Eigen::MatrixXd K, M;

  Case(int n, double axis_z, double shake, std::vector<std::int32_t> held_unknowns = {},
       double axial_force = 0.)
      : law(beam_law(full_section_f(), {}, {}, axis_z, axial_force)),
        element_mass(element_matrices(full_section_f(), law, kLength).mass),
        held(std::move(held_unknowns)),
        tangents(static_cast<std::size_t>(chain_tangent_doubles<W>(n)) + 1,
                 std::numeric_limits<double>::quiet_NaN()) {
    chain = {.beam = straight_beam(law, kLength),
             .mass = {},
             .held = held.data(),
             .held_count = static_cast<std::int32_t>(held.size()),
             .elements = n};
    const auto mass = chain_mass(full_section_f(), law);
    for (std::size_t i = 0; i < 4; ++i) chain.mass[i] = mass[i];
    set_tangents(shake);
    const Eigen::Index size = W * chain_nodes(n);
    K = M = Eigen::MatrixXd::Zero(size, size);
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 3 * W; ++i)
        for (int j = 0; j < 3 * W; ++j) {
          const auto entry = W == 9 ? straight_entry : planar_entry;
          K(2 * W * e + i, 2 * W * e + j) += entry(tangents.data(), e, i, j);
          M(2 * W * e + i, 2 * W * e + j) += element_mass(spatial_of<W>(i), spatial_of<W>(j));
        }
  }

  void set_tangents(double shake) {
    const std::vector<double> nodes = shaken_nodes(chain.elements, 7, shake);
    std::vector<double> q, force(nodes.size());
    for (int i = 0; i < W * chain_nodes(chain.elements); ++i)
      q.push_back(nodes[static_cast<std::size_t>(spatial_of<W>(i))]);
    (W == 9 ? straight_tangents : planar_tangents)(chain.beam, chain.elements, q.data(), nullptr,
                                                   force.data(), tangents.data());
  }

  /// k K + m M, with rows and columns of the identity at held unknowns.
  Eigen::MatrixXd dense(double mass_factor, double k_factor) const {
    Eigen::MatrixXd S = k_factor * K + mass_factor * M;
    for (const std::int32_t h : held) {
      S.row(h).setZero();
      S.col(h).setZero();
      S(h, h) = 1.;
    }
    return S;
  }

  /// Factor of k K + m M; also checks that nothing is written behind it.
  std::vector<double> factor(double mass_factor, double k_factor, int& bad) {
    std::vector<double> found(static_cast<std::size_t>(chain_factor_doubles<W>(chain.elements)) + 1,
                              std::numeric_limits<double>::quiet_NaN());
    bad = chain_factor<W>(chain, mass_factor, k_factor, tangents.data(), found.data());
    CHECK(std::isnan(found.back()));
    CHECK(std::isnan(tangents.back()));
    return found;
  }
};

std::vector<double> random_sides(Eigen::Index size, std::uint64_t seed) {
  Numbers numbers(seed);
  std::vector<double> b;
  for (Eigen::Index i = 0; i < size * kChainSides; ++i) b.push_back(numbers.next());
  return b;
}

/// Factors and solves four random sides; checks them against the dense matrix.
template <int W>
void check_solution(Case<W> c, double k_factor) {
  const Eigen::MatrixXd S = c.dense(kMassFactor, k_factor);
  const Eigen::Index size = S.rows();
  // Scaled to a unit diagonal, so that metres and slopes can be compared.
  const Eigen::VectorXd scale = S.diagonal().cwiseSqrt();
  Eigen::MatrixXd b = Eigen::Map<const Eigen::Matrix<double, kChainSides, Eigen::Dynamic>>(
                          random_sides(size, 3).data(), kChainSides, size)
                          .transpose();
  b = scale.asDiagonal() * b;
  std::vector<double> x(static_cast<std::size_t>(size * kChainSides));
  for (Eigen::Index i = 0; i < size; ++i)
    for (int s = 0; s < kChainSides; ++s)
      x[static_cast<std::size_t>(i * kChainSides + s)] = b(i, s);
  for (const std::int32_t h : c.held) b.row(h).setZero();

  int bad = -1;
  const std::vector<double> factor = c.factor(kMassFactor, k_factor, bad);
  CHECK(bad == 0);
  std::vector<double> one(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = x[i * kChainSides + 2];
  chain_solve<W>(c.chain, factor.data(), x.data());
  chain_solve_one<W>(c.chain, factor.data(), one.data());
  Eigen::MatrixXd got(size, kChainSides);
  for (Eigen::Index i = 0; i < size; ++i)
    for (int s = 0; s < kChainSides; ++s)
      got(i, s) = x[static_cast<std::size_t>(i * kChainSides + s)];
  for (std::size_t i = 0; i < one.size(); ++i) REQUIRE(one[i] == x[i * kChainSides + 2]);
  for (const std::int32_t h : c.held) CHECK(got.row(h).cwiseAbs().maxCoeff() == 0.);

  const LongMatrix scaled =
      (scale.cwiseInverse().asDiagonal() * S * scale.cwiseInverse().asDiagonal()).cast<Long>();
  const LongMatrix y = (scale.asDiagonal() * got).cast<Long>();
  const LongMatrix rhs = (scale.cwiseInverse().asDiagonal() * b).cast<Long>();
  const LongMatrix want = scaled.ldlt().solve(rhs);
  const auto condition = [&] {
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled.cast<double>()).eigenvalues();
    return values[size - 1] / values[0];
  }();
  const auto residual =
      static_cast<double>((scaled * y - rhs).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff());
  const auto error =
      static_cast<double>((y - want).cwiseAbs().maxCoeff() / want.cwiseAbs().maxCoeff());
  INFO("condition " << condition << " residual " << residual << " error " << error);
  // The backward error is 1.1e-16 for each of some 27 terms of a row and for those of the factor's
  // rows behind it (Higham, theorem 10.4: at most 4 * 27). The error is larger by the condition.
  CHECK(residual <= 27. * 1.2e-16);
  CHECK(error <= condition * 27. * 1.2e-16);
}

/// Clamped start, pinned end, and one held unknown of a mid node and of an inner end node.
template <int W>
std::vector<std::int32_t> held_somewhere(int n) {
  std::vector<std::int32_t> held;
  held.reserve(2 * W);
  for (int i = 0; i < W; ++i) held.push_back(i);
  for (int i = 0; i < (W == 9 ? 3 : 2); ++i) held.push_back(2 * n * W + i);
  held.push_back(W + 1);
  if (n > 2) held.push_back(4 * W + W - 1);
  return held;
}

/// Number of eigenvalues below 0, without the chain's own functions.
int negative(const Eigen::MatrixXd& S) {
  const Eigen::VectorXd scale = S.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * S * scale.asDiagonal())
          .eigenvalues();
  int count = 0;
  for (const double value : values) count += value < 0. ? 1 : 0;
  return count;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a chain's solution is that of the dense matrix", "[chain]", ((int W), W), 9,
                       5) {
  const double k_factor = GENERATE(1., .5);
  for (int n = 1; n <= 9; ++n) {
    INFO(n << " elements");
    check_solution(Case<W>(n, -.085, 1e-5), k_factor);
    check_solution(Case<W>(n, 0., 1e-5, held_somewhere<W>(n)), k_factor);
  }
}

TEMPLATE_TEST_CASE_SIG("without stiffness the chain's factor is that of the mass matrix", "[chain]",
                       ((int W), W), 9, 5) {
  for (const int n : {1, 4, 6}) check_solution(Case<W>(n, -.085, 1e-3), 0.);
}

TEMPLATE_TEST_CASE_SIG("a chain's inertia is that of the element's mass matrix", "[chain]",
                       ((int W), W), 9, 5) {
  for (const double axis_z : {0., -.085, .1})
    for (int n = 1; n <= 5; ++n) {
      const Case<W> c(n, axis_z, 0.);
      Numbers numbers(11);
      const Eigen::Index size = c.M.rows();
      Eigen::VectorXd g(size), force(size);
      for (Eigen::Index i = 0; i < size; ++i) {
        g[i] = numbers.next();
        force[i] = numbers.next();
      }
      const Eigen::VectorXd want = force + c.M * g;
      const Eigen::VectorXd size_of = force.cwiseAbs() + c.M.cwiseAbs() * g.cwiseAbs();
      chain_inertia<W>(c.chain, g.data(), force.data());
      // Round-off of ten operations relative to the summed terms of each row.
      for (Eigen::Index i = 0; i < size; ++i)
        CHECK(std::abs(force[i] - want[i]) <= 1e-15 * size_of[i]);
    }
}

TEMPLATE_TEST_CASE_SIG("the number of pivots that are not positive is that of negative eigenvalues",
                       "[chain]", ((int W), W), 9, 5) {
  for (const int n : {1, 2, 3, 4, 7}) {
    for (const double mass_factor : {0., 1e3, 1e6, 4e6}) {
      // Compressed by a tenth of E A: many modes have buckled, fewer with more mass.
      Case<W> c(n, 0., 1e-3, held_somewhere<W>(n), -1.8e8);
      const int want = negative(c.dense(mass_factor, .5));
      int bad = -1;
      c.factor(mass_factor, .5, bad);
      INFO(n << " elements, mass " << mass_factor);
      CHECK(bad == want);
      if (mass_factor == 0. && n > 1) CHECK(want > 0);
    }
  }
}

TEST_CASE("the chain's bits are the same everywhere", "[chain]") {
  std::uint64_t bits = kEmpty;
  const auto take = [&]<int W>(std::integral_constant<int, W>) {
    for (int n = 1; n <= 9; ++n) {
      Chain chain{.beam = made_up_beam(),
                  .mass = {67.9, .0468, .304, -5.77},
                  .held = nullptr,
                  .held_count = 0,
                  .elements = n};
      const std::vector<double> nodes = shaken_nodes(n, 7, .3);
      std::vector<double> force(nodes.size());
      std::vector<double> tangents(static_cast<std::size_t>(chain_tangent_doubles<W>(n)));
      std::vector<double> factor(static_cast<std::size_t>(chain_factor_doubles<W>(n)));
      (W == 9 ? straight_tangents : planar_tangents)(chain.beam, n, nodes.data(), nullptr,
                                                     force.data(), tangents.data());
      const int bad = chain_factor<W>(chain, 4e9, 1., tangents.data(), factor.data());
      std::vector<double> x = random_sides(W * chain_nodes(n), 5);
      chain_solve<W>(chain, factor.data(), x.data());
      chain_inertia<W>(chain, x.data(), force.data());
      const double count = bad;
      bits = hash(hash(hash(bits, x.data(), x.size()), force.data(), x.size() / kChainSides),
                  &count, 1);
    }
  };
  take(std::integral_constant<int, 9>{});
  take(std::integral_constant<int, 5>{});
  check_stored("a chain's solution and inertia", bits, 0xf1aea3d8508929e0ULL);
}
