#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "online/beam/planar.h"
#include "support/beam_energy.h"
#include "support/stored_kernels.h"

using namespace railstep;

namespace {

/// Nodes of n elements of 0.6 m along x, rotated by an angle in the plane and shaken.
std::vector<double> planar_nodes(int n, std::uint64_t seed, double shake, double angle = 0.) {
  Numbers numbers(seed);
  std::vector<double> q;
  for (int node = 0; node <= 2 * n; ++node) {
    const double x = .3 * node, c = std::cos(angle), s = std::sin(angle);
    for (const double rest : {x * c, x * s, 1., -s, c}) q.push_back(rest + shake * numbers.next());
  }
  return q;
}

/// Planar numbers at their places among the spatial ones.
std::vector<double> in_space(const std::vector<double>& planar) {
  std::vector<double> q(planar.size() / kPlanarUnknowns * 9, 0.);
  for (std::size_t i = 0; i < planar.size(); ++i)
    q[i / kPlanarUnknowns * 9 + static_cast<std::size_t>(kPlanarOf[i % kPlanarUnknowns])] =
        planar[i];
  return q;
}

std::vector<double> half_of(const std::vector<double>& q0, const std::vector<double>& q1,
                            double sign) {
  std::vector<double> half(q0.size());
  for (std::size_t i = 0; i < q0.size(); ++i) half[i] = .5 * (q1[i] + sign * q0[i]);
  return half;
}

double largest_entry(const std::vector<double>& x) {
  double peak = 0.;
  for (const double v : x) peak = std::max(peak, std::abs(v));
  return peak;
}

/// NaN where nothing has been written yet, and one more at the end that must stay NaN.
std::vector<double> unset(std::size_t size) {
  return std::vector<double>(size + 1, std::numeric_limits<double>::quiet_NaN());
}

/// Forces and tangents of a row, in the plane or in space; element entries by the accessor.
struct Row {
  std::vector<double> force, alone, tangent;

  Row(bool planar, const StraightBeam& beam, int n, const std::vector<double>& q, const double* d)
      : force(unset(q.size())),
        alone(unset(q.size())),
        tangent(unset(static_cast<std::size_t>(straight_groups(n)) *
                      static_cast<std::size_t>(planar ? kPlanarGroup : kStraightGroup))) {
    (planar ? planar_forces : straight_forces)(beam, n, q.data(), d, alone.data());
    (planar ? planar_tangents : straight_tangents)(beam, n, q.data(), d, force.data(),
                                                   tangent.data());
    CHECK(same_bits(force.data(), alone.data(), q.size()));
    CHECK(std::isnan(force.back()));
    CHECK(std::isnan(alone.back()));
    CHECK(std::isnan(tangent.back()));
    for (std::size_t i = 0; i + 1 < tangent.size(); ++i) REQUIRE(!std::isnan(tangent[i]));
    force.pop_back();
  }
};

}  // namespace

TEST_CASE("the planar element agrees with the spatial one in the plane", "[planar]") {
  const BeamSection f = full_section_f();
  const double axis_z = GENERATE(0., -.085);
  const bool half = GENERATE(false, true);
  const StraightBeam beam = straight_beam(beam_law(f, {}, {}, axis_z, 1e6), .6);
  for (int n = 1; n <= 9; ++n) {
    const auto seed = static_cast<std::uint64_t>(n);
    const std::vector<double> q = planar_nodes(n, seed, .1, .5 * n);
    const std::vector<double> d = planar_nodes(n, 50 + seed, .1, .1);
    const Row got(true, beam, n, q, half ? d.data() : nullptr);
    const Row want(false, beam, n, in_space(q), half ? in_space(d).data() : nullptr);

    // The same products in another order: some ten roundings of 1e-16 of the largest terms.
    const double force_peak = largest_entry(want.force), tolerance = 1e-14;
    std::vector<double> embedded = in_space(got.force);
    for (std::size_t i = 0; i < embedded.size(); ++i)
      REQUIRE(std::abs(embedded[i] - want.force[i]) <= tolerance * force_peak);
    double peak = 0.;
    for (int i = 0; i < 27; ++i)
      peak = std::max(peak, std::abs(straight_entry(want.tangent.data(), 0, i, i)));
    const auto spatial = [](int i) {
      return i / kPlanarUnknowns * 9 + kPlanarOf[i % kPlanarUnknowns];
    };
    for (int e = 0; e < kStraightLanes * straight_groups(n); ++e)
      for (int i = 0; i < 3 * kPlanarUnknowns; ++i)
        for (int j = 0; j < 3 * kPlanarUnknowns; ++j) {
          const double K = planar_entry(got.tangent.data(), e, i, j);
          REQUIRE(K == planar_entry(got.tangent.data(), e, j, i));
          REQUIRE(std::abs(K - straight_entry(want.tangent.data(), e, spatial(i), spatial(j))) <=
                  tolerance * peak);
        }
  }
}

TEST_CASE("with half a change the force is the energy's discrete gradient", "[planar][straight]") {
  const BeamLaw law = beam_law(full_section_f(), {}, {}, -.085, -1e6);
  const Beam general = beam_element(law, straight_nodes(.6));
  const StraightBeam beam = straight_beam(law, .6);
  const bool planar = GENERATE(false, true);
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto nodes = [&](unsigned s) {
      return planar ? planar_nodes(1, s, .4, .3 * s) : shaken_nodes(1, s, .4);
    };
    const std::vector<double> q0 = nodes(seed), q1 = nodes(100 + seed);
    const std::vector<double> d = half_of(q0, q1, -1.);
    const Row mean(planar, beam, 1, half_of(q0, q1, 1.), d.data());
    const auto energy = [&](const std::vector<double>& q) {
      return beam_energy(general, planar ? in_space(q).data() : q.data());
    };
    double work = 0., size = 0.;
    for (std::size_t i = 0; i < d.size(); ++i) {
      work += mean.force[i] * 2. * d[i];
      size += std::abs(mean.force[i] * 2. * d[i]);
    }
    const double U0 = energy(q0), U1 = energy(q1);
    CHECK(size > 1e8);  // J: the strains of these steps are not small
    // Round-off of some ten operations relative to the summed terms.
    CHECK(std::abs(work - (U1 - U0)) <= 1e-14 * (size + std::abs(U0) + std::abs(U1)));
  }
}

TEST_CASE("the tangent is the force's derivative at a constant half change", "[planar][straight]") {
  const StraightBeam beam = straight_beam(beam_law(full_section_f(), {}, {}, .05, 1e6), .6);
  const bool planar = GENERATE(false, true);
  const int unknowns = planar ? 15 : 27;
  const auto nodes = [&](unsigned s) {
    return planar ? planar_nodes(1, s, .1, .7) : shaken_nodes(1, s, .1);
  };
  const std::vector<double> q = nodes(1), d = nodes(2);
  const Row at(planar, beam, 1, q, d.data());
  const auto entry = planar ? planar_entry : straight_entry;
  double peak = 0.;
  for (int i = 0; i < unknowns; ++i)
    peak = std::max(peak, std::abs(entry(at.tangent.data(), 0, i, i)));
  for (int j = 0; j < unknowns; ++j) {
    const auto slope = [&](double h, std::size_t i) {
      std::vector<double> ahead = q, behind = q;
      ahead[static_cast<std::size_t>(j)] += h;
      behind[static_cast<std::size_t>(j)] -= h;
      return (Row(planar, beam, 1, ahead, d.data()).force[i] -
              Row(planar, beam, 1, behind, d.data()).force[i]) /
             (2. * h);
    };
    for (int i = 0; i < unknowns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      // The force is cubic in q, so two differences give its derivative except for round-off: 1e-15
      // of forces at 1 m over steps of 1/8 m.
      const double want = (4. * slope(.125, k) - slope(.25, k)) / 3.;
      REQUIRE(std::abs(entry(at.tangent.data(), 0, i, j) - want) <= 1e-13 * peak);
    }
  }
}

TEST_CASE("the planar kernel's bits are the same everywhere", "[planar]") {
  const StraightBeam beam = made_up_beam();
  std::uint64_t plain = kEmpty, half = kEmpty, spatial = kEmpty;
  const auto take = [](std::uint64_t h, const Row& row) {
    return hash(hash(h, row.force.data(), row.force.size()), row.tangent.data(),
                row.tangent.size() - 1);
  };
  for (unsigned seed = 0; seed < 100; ++seed) {
    const std::vector<double> q = planar_nodes(5, seed, .3), d = planar_nodes(5, 500 + seed, .3);
    plain = take(plain, Row(true, beam, 5, q, nullptr));
    half = take(half, Row(true, beam, 5, q, d.data()));
    spatial = take(spatial, Row(false, beam, 5, shaken_nodes(5, seed, .3),
                                shaken_nodes(5, 500 + seed, .3).data()));
  }
  check_stored("planar tangents", plain, 0x8dcc341fb2267907ULL);
  check_stored("planar mean tangents", half, 0xc5588291c4bee376ULL);
  check_stored("spatial mean tangents", spatial, 0x2049aac3a597998ULL);
}
