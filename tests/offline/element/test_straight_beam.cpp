#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/beam/equilibrium.h"
#include "offline/element/straight_beam.h"
#include "support/stored_kernels.h"

using namespace railstep;

namespace {

/// Elements of a row called one by one: forces summed in the batch's order, single tangents.
struct OneByOne {
  std::vector<double> force, tangent;  // [2n + 1][9], [n][27][27]

  OneByOne(const StraightBeam& beam, int n, const std::vector<double>& q)
      : force(q.size()), tangent(static_cast<std::size_t>(n) * 729) {
    for (int e = 0; e < n; ++e) {
      double own[27];
      straight_tangent(beam, q.data() + 18 * e, own, tangent.data() + 729 * e);
      for (int c = 0; c < 27; ++c) {
        double* at = force.data() + 18 * e + c;
        *at = e > 0 && c < 9 ? *at + own[c] : own[c];
      }
    }
  }
};

}  // namespace

TEST_CASE("the straight kernel gives the results of the general kernel", "[straight]") {
  const BeamSection f = full_section_f();
  const struct {
    const char* name;
    ElementRule rule;
    double axis_z, force;
  } cases[] = {{"section F", {}, 0., 0.},
               {"axis at the foot, pulled", {}, -.085, 1e6},
               {"pressed", {}, 0., -1e6},
               {"as published", {.coupling = Coupling::axis, .shear = Shear::published}, .05, 0.},
               {"unsplit", {.coupling = Coupling::section, .shear = Shear::factors}, -.085, 0.},
               {"offset", {.coupling_points = 2, .shear = Shear::offset}, -.085, -1e6}};
  const Eigen::Matrix3d turns[] = {
      Eigen::Matrix3d::Identity(),
      Eigen::AngleAxisd(2., Eigen::Vector3d(.3, -.5, .8).normalized()).toRotationMatrix()};
  for (const auto& c : cases)
    for (const Eigen::Matrix3d& R : turns) {
      INFO(c.name);
      const BeamLaw law = beam_law(f, {}, c.rule, c.axis_z, c.force);
      const Beam general = beam_element(law, straight_nodes(.6));
      const StraightBeam fast = straight_beam(law, .6);
      for (unsigned seed = 1; seed <= 20; ++seed) {
        const std::vector<double> q = shaken_nodes(1, seed, .02, R);
        Vector27 want, got;
        Matrix27 K_want, K_got;
        beam_tangent(general, q.data(), want.data(), K_want.data());
        straight_tangent(fast, q.data(), got.data(), K_got.data());
        // Products near 1 carry 1e-16 each, over strains of 2e-2: 5e-15 in each of some ten terms.
        CHECK((got - want).cwiseAbs().maxCoeff() < 1e-13 * want.cwiseAbs().maxCoeff());
        CHECK((K_got - K_want).cwiseAbs().maxCoeff() < 1e-13 * K_want.cwiseAbs().maxCoeff());
      }
    }
}

TEST_CASE("to the bit, force and tangent agree and the tangent is symmetric", "[straight]") {
  const StraightBeam beam = made_up_beam();
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const std::vector<double> q = shaken_nodes(1, seed, .5);
    Vector27 alone, force;
    Matrix27 K;
    straight_force(beam, q.data(), alone.data());
    straight_tangent(beam, q.data(), force.data(), K.data());
    CHECK(same_bits(alone.data(), force.data(), 27));
    CHECK(K == K.transpose());
  }
}

TEST_CASE("a batch of straight elements gives the bits of its single elements", "[straight]") {
  const StraightBeam beam = made_up_beam();
  for (int n = 1; n <= 9; ++n) {
    INFO(n);
    const std::vector<double> q = shaken_nodes(n, 100 + static_cast<unsigned>(n), .3);
    const OneByOne want(beam, n, q);
    // Outputs hold NaN until they are written; a canary stands behind them.
    const auto filled = [](std::size_t size) {
      return std::vector<double>(size + 1, std::numeric_limits<double>::quiet_NaN());
    };
    std::vector<double> force = filled(q.size()), same = filled(q.size()),
                        tangent = filled(static_cast<std::size_t>(straight_groups(n)) *
                                         static_cast<std::size_t>(kStraightGroup));
    straight_forces(beam, n, q.data(), nullptr, force.data());
    straight_tangents(beam, n, q.data(), nullptr, same.data(), tangent.data());
    CHECK(same_bits(force.data(), want.force.data(), q.size()));
    CHECK(same_bits(same.data(), want.force.data(), q.size()));
    CHECK(std::isnan(force.back()));
    CHECK(std::isnan(tangent.back()));
    std::vector<double> entries;
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 27; ++i)
        for (int j = 0; j < 27; ++j) entries.push_back(straight_entry(tangent.data(), e, i, j));
    CHECK(same_bits(entries.data(), want.tangent.data(), entries.size()));
    // Lanes beyond the last element repeat it, and every double of the layout is set.
    for (std::size_t i = 0; i + 1 < tangent.size(); ++i) REQUIRE(!std::isnan(tangent[i]));
    for (int e = n; e % kStraightLanes != 0; ++e)
      CHECK(straight_entry(tangent.data(), e, 3, 22) ==
            straight_entry(tangent.data(), n - 1, 3, 22));
  }
}

TEST_CASE("the straight kernel gives the same bits on every machine", "[straight]") {
  const StraightBeam beam = made_up_beam();
  std::uint64_t single = kEmpty;
  for (unsigned element = 0; element < 1000; ++element) {
    const std::vector<double> q = shaken_nodes(1, 1000 + element, .3);
    double force[27], tangent[729];
    straight_tangent(beam, q.data(), force, tangent);
    single = hash(hash(single, force, 27), tangent, 729);
  }
  check_stored("a straight element's tangent", single, 0xf09b797caa43c189ULL);
}

TEST_CASE("the batch gives a cantilever's tip as the general kernel does", "[straight]") {
  constexpr int n = 10;
  const BeamLaw law = beam_law(full_section_f(), {});
  const Vector27 rest = straight_nodes(.2);
  Structure structure{.rest = Eigen::VectorXd::Zero(9 * (2 * n + 1)),
                      .held = std::vector<bool>(9 * (2 * n + 1), false),
                      .laws = {beam_element(law, rest)},
                      .elements = chain(n)};
  for (int node = 0; node <= 2 * n; ++node) {
    structure.rest[9 * node] = .1 * node;
    structure.rest[9 * node + 4] = structure.rest[9 * node + 8] = 1.;
  }
  for (std::size_t i = 0; i < 9; ++i) structure.held[i] = true;
  StructureLoad load{.force = Eigen::VectorXd::Zero(structure.unknowns())};
  load.force[9 * 2 * n + 2] = -63e3;
  const Equilibrium want = equilibrium(structure, load);
  REQUIRE(want.converged);

  const StraightBeam beam = straight_beam(law, .2);
  Eigen::VectorXd q = structure.rest, force(q.size());
  std::vector<double> tangents(static_cast<std::size_t>(straight_groups(n) * kStraightGroup));
  for (int iteration = 0; iteration < 12; ++iteration) {
    straight_tangents(beam, n, q.data(), nullptr, force.data(), tangents.data());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(q.size(), q.size());
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 27; ++i)
        for (int j = 0; j < 27; ++j)
          K(18 * e + i, 18 * e + j) += straight_entry(tangents.data(), e, i, j);
    const Eigen::Index free = q.size() - 9;
    q.tail(free) += K.bottomRightCorner(free, free).ldlt().solve((load.force - force).tail(free));
  }
  const double tip = q[18 * n + 2], reference = want.q[18 * n + 2];
  CHECK(reference < -.0199);
  // Newton's residual is 1e-10 of the load at most there, and the tip errs as much.
  CHECK(std::abs(tip - reference) < 1e-10 * std::abs(reference));
}

TEST_CASE("a law that does not fit a straight element is refused", "[straight]") {
  const BeamSection f = full_section_f();
  const auto with = [&](const ElementRule& rule) { return beam_law(f, {}, rule); };
  CHECK_THROWS_WITH(straight_beam(with({.axial_points = 3}), .6), Catch::Contains("E-ELEMENT-05"));
  CHECK_THROWS_WITH(straight_beam(with({.coupling_points = 1}), .6),
                    Catch::Contains("E-ELEMENT-05"));
  CHECK_THROWS_WITH(straight_beam(with({}), 0.), Catch::Contains("E-ELEMENT-04"));
  BeamLaw skew = with({});
  skew.moments.of[1][1] = 1e-8;
  CHECK_THROWS_WITH(straight_beam(skew, .6), Catch::Contains("E-ELEMENT-06"));
  skew = with({});
  skew.moments.of[1][0] = 1e-8;
  CHECK_THROWS_WITH(straight_beam(skew, .6), Catch::Contains("E-ELEMENT-06"));
}
