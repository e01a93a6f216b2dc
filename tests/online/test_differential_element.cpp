// Compares the nonlinear element's force and tangent at large rotations and strains with the
// complex step of its energy in long double: every rule, the fast straight kernels, the planar
// ones.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "online/beam/planar.h"
#include "support/naive_beam.h"

using namespace railstep;

namespace {

constexpr double kElement = .6;  // m

BeamLaw random_law(Draw& draw, bool two_points, int section_points) {
  BeamSection f = section_f();
  f.moments = moments(kSectionF, section_points);
  ElementRule rule;
  const std::array<Coupling, 4> couplings = {Coupling::centroid, Coupling::axis, Coupling::section,
                                             Coupling::none};
  const std::array<Shear, 4> shears = {Shear::twist, Shear::factors, Shear::offset,
                                       Shear::published};
  rule.coupling = draw.one_of(couplings);
  rule.shear = draw.one_of(shears);
  if (!two_points) {
    rule.axial_points = draw.whole(1, 5);
    rule.coupling_points = draw.whole(0, 5);
  }
  const double axis_z = draw.chance(.5) ? 0. : draw.between(-.085, .1);
  const double force = draw.chance(.5) ? 0. : draw.between(-1e7, 1e7);
  return beam_law(f, {}, rule, axis_z, force);
}

Nodes complex_nodes(const Vector27& q) {
  Nodes to;
  for (int i = 0; i < 27; ++i) to[static_cast<std::size_t>(i)] = Real(q[i]);
  return to;
}

/// K w by five-point differences of the complex step's force. These are exact, as the force is
/// cubic in q, except for long double's round-off, 1e-17 of K with a step of 1/64.
std::array<Real, 27> tangent_along(const NaiveElement& naive, const Vector27& q,
                                   const Vector27& w) {
  const Real h = 1.L / 64.L;
  std::array<Real, 27> sum{};
  for (const auto& [by, factor] :
       {std::pair(-2.L, 1.L), std::pair(-1.L, -8.L), std::pair(1.L, 8.L), std::pair(2.L, -1.L)}) {
    Nodes at = complex_nodes(q);
    for (int i = 0; i < 27; ++i) at[static_cast<std::size_t>(i)] += by * h * Real(w[i]);
    const std::array<Real, 27> force = naive.force(at);
    for (std::size_t i = 0; i < 27; ++i) sum[i] += factor * force[i] / (12.L * h);
  }
  return sum;
}

/// Force and tangent by a kernel of the library; zero where it has no unknowns.
struct Kernel {
  Vector27 force = Vector27::Zero();
  Matrix27 tangent = Matrix27::Zero();
};

Kernel general(const BeamLaw& law, const Vector27& q) {
  Kernel k;
  beam_tangent(beam_element(law, straight_nodes(kElement)), q.data(), k.force.data(),
               k.tangent.data());
  return k;
}

Kernel straight(const BeamLaw& law, const Vector27& q) {
  Kernel k;
  straight_tangent(straight_beam(law, kElement), q.data(), k.force.data(), k.tangent.data());
  return k;
}

Kernel planar(const BeamLaw& law, const Vector27& q) {
  constexpr int W = kPlanarUnknowns;
  double flat[3 * W], force[3 * W];
  std::vector<double> tangent(kPlanarGroup);
  const auto spatial = [](int i) { return i / W * 9 + kPlanarOf[i % W]; };
  for (int i = 0; i < 3 * W; ++i) flat[i] = q[spatial(i)];
  planar_tangents(straight_beam(law, kElement), 1, flat, nullptr, force, tangent.data());
  Kernel k;
  for (int i = 0; i < 3 * W; ++i) {
    k.force[spatial(i)] = force[i];
    for (int j = 0; j < 3 * W; ++j)
      k.tangent(spatial(i), spatial(j)) = planar_entry(tangent.data(), 0, i, j);
  }
  return k;
}

/// Errors of force and tangent, each over its bound.
///
/// A product of the axis' vectors errs by a few times eps r', where r' = sum N' r has terms up to
/// 5/m of 1 m. A stress errs by C times that, a force by five terms of N' V times that. With K = C
/// N'^2 V^2 and N' up to 5/m this is 100 eps of K's largest entry times 1 m. Each entry of K errs
/// by twice as much.
struct Off {
  double force, tangent, strain_energy;
};

Off off(const NaiveElement& naive, const Kernel& k, const Vector27& q, const Vector27& w) {
  const double eps = std::numeric_limits<double>::epsilon();
  const double size = k.tangent.cwiseAbs().maxCoeff();
  const std::array<Real, 27> force = naive.force(complex_nodes(q));
  const std::array<Real, 27> along = tangent_along(naive, q, w);
  const Vector27 by_kernel = k.tangent * w;
  Real f = 0.L, t = 0.L;
  for (int i = 0; i < 27; ++i) {
    const auto at = static_cast<std::size_t>(i);
    f = std::fmax(f, std::fabs(force[at] - k.force[i]));
    t = std::fmax(t, std::fabs(along[at] - by_kernel[i]));
  }
  return {static_cast<double>(f) / (100. * eps * size),
          static_cast<double>(t) / (200. * eps * size * w.cwiseAbs().sum()),
          static_cast<double>(naive.energy(complex_nodes(q)).real())};
}

template <typename Function>
void compare(std::uint64_t first, int states, bool two_points, bool flat, const Function& kernel) {
  double worst_force = 0., worst_tangent = 0.;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(states); ++seed) {
    Draw draw(seed);
    const int points = draw.whole(1, 3);
    const BeamLaw law = random_law(draw, two_points, points);
    const Vector27 q = random_state(draw, kElement, draw.of_any_size(1e-4, .1), flat);
    Vector27 w;
    for (int i = 0; i < 27; ++i) {
      const bool in = i % 9 == 0 || i % 9 == 2 || i % 9 == 4 || i % 9 == 6 || i % 9 == 8;
      w[i] = !flat || in ? draw.between(-1., 1.) : 0.;
    }
    const Off found = off(NaiveElement(law, kElement, points), kernel(law, q), q, w);
    CAPTURE(seed, points, law.rule.axial_points, law.rule.coupling_points,
            static_cast<int>(law.rule.coupling), static_cast<int>(law.rule.shear),
            found.strain_energy);
    CHECK(found.force <= 1.);
    CHECK(found.tangent <= 1.);
    worst_force = std::max(worst_force, found.force);
    worst_tangent = std::max(worst_tangent, found.tangent);
  }
  CAPTURE(worst_force, worst_tangent);
  CHECK(worst_force > 0.);
}

}  // namespace

TEST_CASE("force and tangent of every rule are the derivatives of the energy as it is defined",
          "[differential][beam]") {
  compare(1, 600, false, false, general);
}

TEST_CASE(
    "the straight kernel's force and tangent are the derivatives of the energy as it is defined",
    "[differential][beam]") {
  compare(1001, 300, true, false, straight);
}

TEST_CASE(
    "the planar kernel's force and tangent are the derivatives of the energy as it is defined",
    "[differential][planar]") {
  compare(2001, 300, true, true, planar);
}
