#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "offline/condense/floquet.h"
#include "online/track/residual.h"
#include "support/endless_tracks.h"

using namespace railstep;

namespace {

/// A ring with all directions and two rails, so that lines couple bending, twist and stretch.
Track full_ring(int bays) {
  Track t = ring_of(endless_track(bays, 2, 2));
  t.unknowns = Unknowns::full;
  t.support.stiffness = {50e6, 50e6, 120e6};
  t.support.damping = {10e3, 10e3, 30e3};
  t.support.roll_stiffness = .3e6;
  t.support.height_z = -.085;
  t.sleeper = Sleeper{300., 169., {20e6, 20e6, 50e6}, {30e3, 30e3, 80e3}};
  return t;
}

double largest(const Eigen::MatrixXd& A) { return A.size() == 0 ? 0. : A.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("waves of all wave numbers have the frequencies of the whole ring") {
  // Both find the eigenvalues of one matrix. Lowest omega^2 over highest is 1e-7 and rounding is
  // 1e-16 of the highest: 1e-9 of omega^2, 1e-8 with room.
  for (const int bays : {7, 8})
    for (const Track& ring : {ring_of(endless_track(bays, 2)), full_ring(bays)})
      for (const Line& line : assemble(ring)) {
        const Modes whole = modes(line);
        const RingModes waves =
            ring_modes(ring, line, {6 * bays, std::numeric_limits<double>::infinity()});
        std::vector<double> hz;
        for (const double omega : waves.basis.omega) hz.push_back(omega / (2. * M_PI));
        std::sort(hz.begin(), hz.end());
        // The lowest two of every wave number are pure; the dampers' shapes mix with the others.
        REQUIRE(hz.size() >= static_cast<std::size_t>(bays));
        for (std::size_t i = 0; i < static_cast<std::size_t>(bays); ++i)
          CHECK(std::abs(hz[i] / whole.frequency[static_cast<Eigen::Index>(i)] - 1.) < 1e-8);
      }
}

TEST_CASE("ring modes are normal over the mass and stiffness of the ring") {
  const Track ring = full_ring(6);
  for (const Line& line : assemble(ring)) {
    const RingModes waves = ring_modes(ring, line, {18, std::numeric_limits<double>::infinity()});
    const Eigen::MatrixXd S = waves.basis.shapes.dense();
    const Eigen::VectorXd square = waves.basis.omega.cwiseAbs2();
    const Eigen::Index n = square.size();
    // Rounding times the condition of K over the kept shapes (below 1e6).
    CHECK(largest(S.transpose() * (line.mass * S) - Eigen::MatrixXd::Identity(n, n)) < 1e-10);
    CHECK(largest(S.transpose() * (line.stiffness * S) - Eigen::MatrixXd(square.asDiagonal())) <
          1e-9 * square.maxCoeff());
    // Damping does not couple two waves: the whole of it is in the small systems.
    const Eigen::MatrixXd damping(waves.modes.damping());
    CHECK(largest(S.transpose() * (line.damping * S) - damping) <
          1e-9 * std::max(1., largest(damping)));
  }
}

TEST_CASE("shapes kept wave by wave agree with the whole ring's, in rows and in products") {
  // Both sum some hundred terms of size 1, but in another order.
  for (const int bays : {6, 7}) {
    const Track ring = full_ring(bays);
    for (const Line& line : assemble(ring)) {
      const Shapes shapes =
          ring_modes(ring, line, {3 * bays, std::numeric_limits<double>::infinity()}).basis.shapes;
      const Eigen::MatrixXd S = shapes.dense();
      REQUIRE(S.rows() == line.unknowns());
      REQUIRE(S.cols() == shapes.cols());
      const Eigen::VectorXd load = Eigen::VectorXd::Random(S.rows()),
                            y = Eigen::VectorXd::Random(S.cols());
      const double scale = 1e-13 * largest(S) * std::sqrt(static_cast<double>(S.rows()));
      CHECK(largest(shapes.project(load) - S.transpose() * load) < scale);
      CHECK(largest(shapes.displacement(y) - S * y) < scale);
      const Eigen::VectorXd one = Eigen::VectorXd::Unit(S.rows(), S.rows() / 2);
      CHECK(largest(shapes.project(one) - S.transpose() * one) < scale);
    }
  }
}

TEST_CASE("a step back by a bay rotates the coordinates of each wave") {
  const Track ring = full_ring(6);
  for (const Line& line : assemble(ring)) {
    const RingModes waves = ring_modes(ring, line, {18, std::numeric_limits<double>::infinity()});
    const Eigen::MatrixXcd shape = waves.basis.shapes.dense() * waves.modes.shape();
    Eigen::VectorXcd z(waves.modes.rate().size()), turned(z.size());
    for (Eigen::Index k = 0; k < z.size(); ++k)
      z[k] = {std::cos(1. + 3. * static_cast<double>(k)), std::sin(2. + static_cast<double>(k))};
    for (Eigen::Index k = 0; k < z.size(); ++k)
      turned[k] =
          waves.cosine[k] * z[k] + waves.sine[k] * z[waves.partner[static_cast<std::size_t>(k)]];
    const Eigen::VectorXd here = (shape * z).real(), back = (shape * turned).real();
    const double scale = here.cwiseAbs().maxCoeff();
    for (int node = 0; node + 4 < ring.nodes(); ++node)
      for (int k = 0; k < 9; ++k)
        if (const int at = line.unknown(line.first_rail(), node, k); at >= 0) {
          const int ahead = line.unknown(line.first_rail(), node + 4, k);
          CHECK(std::abs(back[at] - here[ahead]) < 1e-12 * scale);  // sums of 60 terms
        }
  }
}

TEST_CASE("a ring's table of one bay gives the flexibility between two places of any bay") {
  // Modes and residual flexibility are compared with the ring of 16 times the elements at their
  // ends. An element is exact there and so are the tables; between two places the beam is a cubic,
  // like their interpolation. 1e-16 times K's condition of 1e7 and 512 elements leave 1e-9.
  const Track ring = ring_of(endless_track(16, 2));
  const Traffic traffic{.loads = {moving_load(0.), moving_load(1.5)}};
  const PackedModel packed(ring, traffic, ring_options(ring, 1));
  const Model& model = packed.model();
  const PackedLine& own = packed.lines()[0];
  CHECK(model.residual.elements == 2);
  CHECK(model.residual.pair[0][0].range <= 7);  // 1.5 m of .3 m, and one on each side
  Track fine = ring;
  fine.elements_per_bay *= 16;
  const Statics exact(fine);
  double worst = 0., missed = 0., peak = 0.;
  for (const int bay : {0, 6, 11})
    for (const double within : {.05625, .1875, .35625, .46875})
      for (const double apart : {0., -1.5, 1.5}) {
        const double x = 1.8 + bay * .6 + within, to = x + apart;
        if (to > ring.length()) continue;
        const RailPoint a{0, x, 0., 0., 2}, b{0, to, 0., 0., 2};
        const auto row = [&](const RailPoint& at) -> Eigen::VectorXd {
          return own.basis.shapes.project(Eigen::VectorXd(point_row(ring, own.line, at)));
        };
        const double modes =
            row(a).cwiseProduct(row(b)).cwiseQuotient(own.basis.omega.cwiseAbs2()).sum();
        const RailForce from = rail_force(model, 0, x, 1.), there = rail_force(model, 0, to, 0.);
        const double residual =
            apart == 0. ? residual_under(model, from) : residual_between(model, from, there);
        const double want = exact.flexibility(a, b);
        peak = std::max(peak, std::abs(want));
        worst = std::max(worst, std::abs(modes + residual - want));
        missed = std::max(missed, std::abs(modes - want));
      }
  CAPTURE(worst / peak, missed / peak);
  CHECK(worst < 1e-8 * peak);
  CHECK(missed > 1e-2 * peak);  // modes without residual flexibility
}
