#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "offline/analysis/timoshenko_statics.h"
#include "offline/element/timoshenko.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

Track beam(int elements, double length, RailEnds ends) {
  Track t;
  t.section = section_f();
  t.rails = 1;
  t.bays = elements;
  t.elements_per_bay = 1;
  t.bay_length = length / elements;
  t.ends = ends;
  return t;
}

constexpr RailEnds kCantilever = {RailEnd::clamped, RailEnd::free};

}  // namespace

TEST_CASE("a Timoshenko element has no strain in six rigid motions, and strain in all others",
          "[timoshenko]") {
  const Matrix12 K = timoshenko_stiffness(section_f(), {}, .7);
  CHECK((K - K.transpose()).cwiseAbs().maxCoeff() <= 1e-15 * K.cwiseAbs().maxCoeff());
  // Displacements t + w x (x, 0, 0) and rotations w, for each t and w.
  for (int motion = 0; motion < 6; ++motion) {
    Vector12 u = Vector12::Zero();
    u[motion] = u[6 + motion] = 1.;
    if (motion == 4) u[6 + 2] = -.7;
    if (motion == 5) u[6 + 1] = .7;
    CHECK((K * u).norm() < 1e-15 * K.cwiseAbs().maxCoeff());
  }
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix12>(K).eigenvalues();
  CHECK(std::abs(eigenvalues[5]) < 1e-14 * eigenvalues[11]);
  CHECK(eigenvalues[6] > 1e-8 * eigenvalues[11]);
}

TEST_CASE("a Timoshenko cantilever has the closed forms in every direction", "[timoshenko]") {
  const int elements = GENERATE(1, 7);
  const double L = 2., c = -.0391, y = .03, z = .1;
  const TimoshenkoStatics statics(beam(elements, L, kCantilever), {});
  const BeamSection s = section_f();
  const double E = 210e9, G = E / 2.6;
  const auto moved = [&](int force, int to) {
    const RailPoint at{0, L, y, z, force}, sensor{0, L, 0., 0., to};
    return statics.at(statics.solve({{at, 1.}}), sensor);
  };
  // 1e-9 is the round-off at a condition of about 1e6.
  CHECK_THAT(moved(0, 0), WithinRel(L / (E * s.area), 1e-9));
  CHECK_THAT(moved(0, 2), WithinRel(-z * L * L / (2. * E * s.inertia_y), 1e-9));
  CHECK_THAT(moved(0, 1), WithinRel(-y * L * L / (2. * E * s.inertia_z), 1e-9));
  CHECK_THAT(
      moved(2, 2),
      WithinRel(L * L * L / (3. * E * s.inertia_y) + L / (s.shear_factor_z * G * s.area), 1e-9));
  // A lateral force twists by its height over the shear centre; the axis is -c above that.
  CHECK_THAT(moved(1, 1),
             WithinRel(L * L * L / (3. * E * s.inertia_z) + L / (s.shear_factor_y * G * s.area) +
                           (z - c) * -c * L / (G * s.torsion),
                       1e-9));
  CHECK_THAT(moved(2, 1), WithinRel(y * c * L / (G * s.torsion), 1e-9));
}

TEST_CASE("a Timoshenko cantilever sinks under its own weight", "[timoshenko]") {
  const double L = 3., q = 7850. * 8700e-6 * 9.81, E = 210e9, G = E / 2.6;
  const BeamSection s = section_f();
  const TimoshenkoStatics statics(beam(3, L, kCantilever), {});
  const double sag = statics.at(statics.solve({}, 9.81), {0, L, 0., 0., 2});
  CHECK_THAT(
      sag,
      WithinRel(
          -q * L * L * (L * L / (8. * E * s.inertia_y) + 1. / (2. * s.shear_factor_z * G * s.area)),
          1e-9));
  CHECK(statics.residual(statics.solve({}, 9.81), {}, 9.81, .09) < 1e-9);
}

TEST_CASE("both formulations agree at the nodes of a rail on pads", "[timoshenko]") {
  // At element ends the quadratic element with two points is exact under forces there, as long as
  // nothing stretches the section. So seats and loads are on the axis and Poisson's ratio is 0,
  // since a jump of the axial force needs one of the section's contraction. The condition is 1e8.
  Track t = beam(8, 4.8, {RailEnd::free, RailEnd::pinned});
  t.support.stiffness = {10e6, 30e6, 60e6};
  t.support.roll_stiffness = 2e5;
  t.section.shear_centre_z = 0.;
  t.material.poisson = 0.;
  const Statics ancf(t);
  const TimoshenkoStatics exact(t, {});
  const std::vector<PointForce> forces = {
      {{0, 1.2, 0., 0., 2}, -50e3}, {{0, 1.8, 0., 0., 1}, 10e3}, {{0, 3., 0., 0., 0}, 5e3}};
  const auto a = ancf.solve(forces);
  const Eigen::VectorXd b = exact.solve(forces);
  for (const double x : {0., 1.2, 1.8, 4.2})
    for (const int d : {0, 1, 2}) {
      const RailPoint at{0, x, 0., 0., d};
      CHECK_THAT(exact.at(b, at), WithinRel(ancf.at(a, at), 1e-7));
    }
}

TEST_CASE("forces between element borders are exact too", "[timoshenko]") {
  const TimoshenkoStatics coarse(beam(1, 2., kCantilever), {.3, 1.3}),
      fine(beam(20, 2., kCantilever), {});
  const PointForce force{{0, 1.3, 0., .1, 2}, -63e3};
  const RailPoint at{0, .3, 0., 0., 2};
  CHECK_THAT(coarse.at(coarse.solve({force}), at),
             WithinRel(fine.at(fine.solve({force}), at), 1e-9));
}

TEST_CASE("features that a Timoshenko beam lacks are refused", "[timoshenko]") {
  const auto refused = [](const Track& t) { return TimoshenkoStatics(t, {}); };
  Track two = beam(2, 2., kCantilever), on_sleepers = two, loose = two, off = two, locked = two;
  two.rails = 2;
  on_sleepers.sleeper = Sleeper{};
  loose.ends = {RailEnd::free, RailEnd::free};
  off.axis_z = .01;
  locked.rule.axial_points = 3;
  CHECK_THROWS_WITH(refused(two), Catch::Contains("E-TIMOSHENKO-01"));
  CHECK_THROWS_WITH(refused(on_sleepers), Catch::Contains("E-TIMOSHENKO-04"));
  CHECK_THROWS_WITH(refused(loose), Catch::Contains("E-TRACK-35"));
  CHECK_THROWS_WITH(refused(off), Catch::Contains("E-TIMOSHENKO-08"));
  CHECK_THROWS_WITH(refused(locked), Catch::Contains("E-TIMOSHENKO-09"));
}
