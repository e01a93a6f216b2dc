#include <catch2/catch.hpp>
#include <cmath>

#include "support/beams.h"
#include "support/system_run.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector3d;

namespace {

/// A soft beam of .4 m by 20 mm by 30 mm, as in the double pendulum, thrown with a spin that bends
/// and stretches it: w^2 L^2 rho / 12 E = 1 % at 30 rad/s.
System thrown(bool planar, const Vector3d& gravity = Vector3d::Zero()) {
  System s;
  s.planar = planar;
  s.gravity = gravity;
  FlexibleBeam b;
  b.section = rectangle_section(.02, .03, 1.);
  b.material = {.young = 210e6, .poisson = .3, .density = 7900.};
  b.elements = 2;
  b.length = .4;
  b.half_height = .01;
  b.angular_velocity = planar ? Vector3d(0., -30., 0.) : Vector3d(5., -30., 12.);
  // The centre flies only 4 m in 100 s: momentum about the origin is not that of a far flight.
  b.velocity =
      Vector3d(.03, planar ? 0. : .01, .02) - b.angular_velocity.cross(Vector3d(.2, 0., 0.));
  s.beams = {b};
  return s;
}

/// Mass of 1.9 kg; its ends move at 6 m/s.
constexpr double kBeamMass = 7900. * .02 * .03 * .4, kEndSpeed = 30. * .2;

/// Largest changes: of momentum over kBeamMass kEndSpeed, of the others over their values at the
/// start.
struct Kept {
  double linear = 0., angular = 0., energy = 0.;
  Status seen = Status::ok;
  int iterations = 0;
};
Kept kept(const System& scene, const SystemOptions& options, int steps, int each) {
  SystemRun r(scene, options);
  const Eigen::Matrix<double, 6, 1> before = r.momentum();
  const double energy = r.energy();
  Kept k;
  for (int i = 1; i <= steps; ++i) {
    r.frame();
    if (i % each != 0) continue;
    const Eigen::Matrix<double, 6, 1> change = r.momentum() - before;
    k.linear = std::max(k.linear, change.head<3>().norm() / (kBeamMass * kEndSpeed));
    k.angular = std::max(k.angular, change.tail<3>().norm() / before.tail<3>().norm());
    k.energy = std::max(k.energy, std::abs(r.energy() / energy - 1.));
  }
  k.seen = r.seen;
  k.iterations = r.iterations;
  return k;
}

}  // namespace

TEST_CASE("a thrown beam starts as a rigid body does", "[system]") {
  const bool planar = GENERATE(true, false);
  const SystemRun r(thrown(planar), sharp(energy_momentum(1e-3)));
  const FlexibleBeam& b = r.system.beams[0];
  const double mass = kBeamMass;
  const Vector3d arm(.2, 0., 0.), speed = b.velocity + b.angular_velocity.cross(arm);
  const double x = mass * (.02 * .02 + .03 * .03) / 12.;
  const Vector3d inertia(x, mass * (.4 * .4 + .02 * .02) / 12., mass * (.4 * .4 + .03 * .03) / 12.);
  const Vector3d turning = arm.cross(mass * speed) + inertia.cwiseProduct(b.angular_velocity);
  // Gauss's rules are exact here, to round-off.
  CHECK((r.momentum().head<3>() - mass * speed).norm() < 1e-13 * mass * kEndSpeed);
  CHECK((r.momentum().tail<3>() - turning).norm() < 1e-12 * turning.norm());
  const double energy = .5 * mass * speed.squaredNorm() +
                        .5 * b.angular_velocity.dot(inertia.cwiseProduct(b.angular_velocity));
  CHECK_THAT(r.energy(), WithinAbs(energy, 1e-12 * energy));
}

TEST_CASE("energy-momentum keeps a thrown beam's momenta and energy over 1e5 steps", "[system]") {
  const bool planar = GENERATE(true, false);
  const Kept k = kept(thrown(planar), sharp(energy_momentum(1e-3)), 100000, 50);
  INFO((planar ? "planar" : "spatial")
       << ": linear " << k.linear << ", angular " << k.angular << ", energy " << k.energy
       << ", iterations " << k.iterations);
  CHECK(k.seen == Status::ok);
  // Each step rounds some 10 times by 1e-16, all to one side. Newton leaves 1e-11 of the forces by
  // which momentum flows through a node in a step, in either direction.
  CHECK(k.linear < 1e-9);
  CHECK(k.angular < 1e-9);
  CHECK(k.energy < 1e-9);
}

TEST_CASE("generalised-alpha keeps a thrown beam's momentum, and its spin by its order",
          "[system]") {
  const bool planar = GENERATE(true, false);
  const auto at = [&](double h, int steps) {
    return kept(thrown(planar), sharp(generalised_alpha(h, .9)), steps, 10);
  };
  const Kept long_run = at(1e-3, 20000);
  const Kept coarse = at(5e-4, 400), fine = at(2.5e-4, 800);
  INFO((planar ? "planar" : "spatial")
       << ": over 20 s linear " << long_run.linear << ", angular " << long_run.angular
       << ", energy " << long_run.energy << "; angular over .2 s " << coarse.angular << " "
       << fine.angular);
  CHECK(long_run.seen == Status::ok);
  // Forces within a body cancel in any sum of accelerations.
  CHECK(long_run.linear < 1e-9);
  // The spin is damped like the bending: it may not grow.
  CHECK(long_run.energy < 1.);
  CHECK(long_run.angular < .1);
  CHECK_THAT(order(coarse.angular, fine.angular), WithinAbs(2., .3));
}

TEST_CASE("the centre of a thrown beam flies along its parabola", "[system]") {
  const bool planar = GENERATE(true, false);
  const Vector3d g(0., 0., -9.81);
  for (const Scheme& scheme : {energy_momentum(1e-3), generalised_alpha(1e-3, .8)}) {
    SystemRun r(thrown(planar, g), sharp(scheme));
    const FlexibleBeam& b = r.system.beams[0];
    const Vector3d speed = b.velocity + b.angular_velocity.cross(Vector3d(.2, 0., 0.));
    r.until(1.);
    // Both schemes are exact for a steady acceleration; the centre follows from linear momentum.
    CHECK(largest(r.momentum().head<3>() / kBeamMass - (speed + g)) < 1e-9);
    CHECK(largest(r.beam_centre(0) - (Vector3d(.2, 0., 0.) + speed + .5 * g)) < 1e-9);
  }
}
