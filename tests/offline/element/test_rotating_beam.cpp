#include <catch2/catch.hpp>
#include <cmath>

#include "support/reissner_beam.h"
#include "support/rotating_beam.h"
#include "support/sections.h"
#include "support/spin_up.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

/// Nodes rotated about y as a rigid body, x towards z.
VectorXd turned_nodes(const VectorXd& q, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  VectorXd result = q;
  for (int i = 0; i < q.size(); i += 3) {
    result[i] = c * q[i] - s * q[i + 2];
    result[i + 2] = s * q[i] + c * q[i + 2];
  }
  return result;
}

/// Steady shape in axes that rotate with the hub: f(q) = w^2 M q in the plane.
struct Steady {
  VectorXd q;
  double lowest;  // frequency in the plane, rad/s
};

Steady steady(const PlanarBeam& b, double spin) {
  const Structure& s = b.structure;
  Eigen::SparseMatrix<double> plane(s.unknowns(), s.unknowns());
  for (int i = 0; i < s.unknowns(); ++i)
    if (i % 3 != 1) plane.insert(i, i) = 1.;
  const Eigen::SparseMatrix<double> pull = spin * spin * plane * b.mass;
  Steady result{s.rest, 0.};
  Eigen::MatrixXd K;
  for (int i = 0; i < 8; ++i) {
    K = free_part(s, Eigen::SparseMatrix<double>(tangent(s, result.q) - pull));
    const VectorXd step =
        K.partialPivLu().solve(free_part(s, internal_force(s, result.q) - pull * result.q));
    const std::vector<int> free = free_list(s);
    for (std::size_t k = 0; k < free.size(); ++k) result.q[free[k]] -= step[static_cast<int>(k)];
  }
  // Coriolis forces, left out here, couple bending to a stretch 300 times stiffer: (w/wa)^2 = 2e-5.
  const Eigen::MatrixXd M(free_part(s, b.mass));
  const double largest =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(M, K).eigenvalues().maxCoeff();
  result.lowest = 1. / std::sqrt(largest);
  return result;
}

/// Error of the tip of the linearised cantilever when its root rotates by the angle, in the root's
/// axes, over the length.
Vector2d linear_tip_error(const PlanarBeam& b, double angle) {
  const Structure& s = b.structure;
  VectorXd q = s.rest;
  q[6] = -std::sin(angle);
  q[8] = std::cos(angle);
  const Eigen::SparseMatrix<double> K = tangent(s, s.rest);
  const VectorXd step =
      Eigen::MatrixXd(free_part(s, K)).ldlt().solve(free_part(s, VectorXd(K * (q - s.rest))));
  const std::vector<int> free = free_list(s);
  for (std::size_t k = 0; k < free.size(); ++k) q[free[k]] -= step[static_cast<int>(k)];
  const auto tip = s.unknowns() - 9;
  return in_hub({q[tip], q[tip + 2]}, angle, b.length) / b.length;
}

PlanarBeam rail(int elements) { return planar_beam(section_f(), {}, 2., elements); }

}  // namespace

TEST_CASE("a rigid rotation strains the linearised beam by the square of its angle", "[rotating]") {
  const PlanarBeam b = rail(1);
  const Structure& s = b.structure;
  const Eigen::SparseMatrix<double> K = tangent(s, s.rest);
  const auto linear = [&](double angle) {
    return VectorXd(K * (turned_nodes(s.rest, angle) - s.rest));
  };
  const VectorXd unit = linear(std::acos(-1.) / 2.);
  for (const double angle : {1e-3, .01, .1, 1., 3.}) {
    INFO("angle " << angle);
    // It is exactly (1 - cos) K q0; 1 - cos and the positions lose eps/angle^2 of their digits.
    const VectorXd force = linear(angle);
    CHECK((force - (1. - std::cos(angle)) * unit).norm() < 1e-9 * force.norm());
    // Round-off of positions of 2 m, times K, is 1e-15 of the largest possible force.
    CHECK(internal_force(s, turned_nodes(s.rest, angle)).norm() < 1e-14 * unit.norm());
  }
  // Along and upwards the beam strains by e = cos - 1, but not sideways, so the axial force is A (E
  // e + Dv11 e + Dv13 e). On the two end nodes this is 2.5 kN at 1 mrad.
  const Material m;
  const double coupling = m.poisson / ((1. + m.poisson) * (1. - 2. * m.poisson));
  const double axial = section_f().area * m.young * (1. + coupling * (1. + 2. * m.poisson));
  CHECK_THAT(unit[0], WithinRel(axial, 1e-12));
  CHECK_THAT(unit[18], WithinRel(-axial, 1e-12));
  CHECK_THAT(axial * (1. - std::cos(1e-3)) * std::sqrt(2.), WithinAbs(2.5e3, 50.));
}

TEST_CASE("a preloaded rail turns right to the first order of its angle", "[rotating]") {
  // K of Eq. 24 at a preload N turns the preload too: it pushes the end nodes across by N angle.
  // The error stays of second order; with K of the rail without preload it would be of first order.
  PlanarBeam b = rail(1);
  const double N = -1e6, angle = 1e-5;
  b.structure.laws = {beam_element(beam_law(b.section, {}, {}, 0., N), straight_nodes(2.))};
  const Structure& s = b.structure;
  const VectorXd initial = internal_force(s, s.rest);
  const Eigen::SparseMatrix<double> K = tangent(s, s.rest);
  const auto linear = [&](double by) {
    return VectorXd(initial + K * (turned_nodes(s.rest, by) - s.rest));
  };
  const auto missing = [&](double by) {
    return (internal_force(s, turned_nodes(s.rest, by)) - linear(by)).norm();
  };
  CHECK_THAT(linear(angle)[20], WithinRel(N * angle, 1e-6));  // next: angle^2 and K's round-off
  // The error is some 0.2 N; round-off is 1e-15 K L = 1e-5 N.
  CHECK_THAT(std::log2(missing(2. * angle) / missing(angle)), WithinAbs(2., 1e-3));
}

TEST_CASE("the same push accelerates ANCF equally in every shape, but not a frame", "[rotating]") {
  const PlanarBeam b = hubbed(spin_up_beam(4), true);
  const auto undriven = [](Moving&) {};
  AncfBody ancf(b, undriven, VectorXd::Zero(b.structure.unknowns()));
  Moving still = at_rest(b.structure.rest), bent = at_rest(turned_nodes(b.structure.rest, 1.));
  for (int i = 0; i < bent.q.size(); i += 9) bent.q[i + 2] += .01 * bent.q[i] * bent.q[i];
  const VectorXd push = VectorXd::Ones(static_cast<int>(ancf.free_unknowns().size()));
  CHECK((ancf.solve(still, 0., 0., push) - ancf.solve(bent, 0., 0., push)).norm() == 0.);

  // In a frame on mean axes the inertia about the origin changes by the square of the bend, w/L.
  const PlanarBeam thrown = spin_up_beam(4);
  const Eigen::MatrixXd modes = planar_modes(thrown, 3, 1);
  const FramePoint tip = frame_point(thrown.structure, modes, 8, true);
  FloatingBody frame(floating_frame(thrown.structure, thrown.mass, modes, true),
                     {0, 1, 2, 3, 4, 5, 6}, undriven);
  const auto accelerated = [&](double bend) {
    Moving m = at_rest(VectorXd::Zero(7));
    m.q[3] = bend / tip.shape(1, 0);
    frame.residual(m);  // builds the mass matrix
    return frame.solve(m, 0., 0., VectorXd::Unit(7, 2))[2];
  };
  const auto change = [&](double bend) { return accelerated(bend) / accelerated(0.) - 1.; };
  INFO("changes " << change(.05) << " and " << change(.1));
  // The next term is a tenth of the change at .5 m, so 4e-3 at .1 m.
  CHECK_THAT(std::log2(change(.1) / change(.05)), WithinAbs(2., .02));
  CHECK(std::abs(change(.5)) > std::pow(.5 / kSpinUpLength, 2));
}

TEST_CASE("a tangent frame that rotates freely allows only small bending", "[rotating]") {
  // Three clamped modes make a rigid rotation but for .14 % of its inertia. Kinetic energy to
  // second order is negative where shortening takes more than that: at the spin-up's lag of .53 m,
  // but not at 8 cm. On mean axes modes and rotation are separate, and it stays positive.
  const auto lowest = [](const PlanarBeam& b, double bend) {
    const Eigen::MatrixXd modes = planar_modes(b, 3, 1);
    VectorXd q = VectorXd::Zero(7);
    q[3] = bend / frame_point(b.structure, modes, 8, true).shape(1, 0);
    const FloatingFrame f = floating_frame(b.structure, b.mass, modes, true);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
               mass_matrix(f, q).bottomRightCorner<5, 5>())
        .eigenvalues()[0];
  };
  const PlanarBeam clamped = hubbed(spin_up_beam(4), true), thrown = spin_up_beam(4);
  CHECK(lowest(clamped, .08) > 0.);
  CHECK(lowest(clamped, .53) < 0.);
  CHECK(lowest(thrown, .53) > .5);  // modal masses are 1
}

TEST_CASE("a rotated clamp stretches the linearised beam along and bends it across", "[rotating]") {
  const PlanarBeam b = hubbed(rail(2), true);
  const Vector2d half = linear_tip_error(b, .01), whole = linear_tip_error(b, .02);
  // The tip goes straight up and not on a circle, to (L, L sin). Along: cos + sin^2 - 1 =
  // angle^2/2; across: sin cos - sin = -angle^3/2; the next terms are angle^2 of these, 4e-4 at
  // .02. The clamp's slope keeps its height only along z, so Poisson's ratio lengthens the first
  // element of 1 m by at most nu angle^2/2 int N1 = nu angle^2/2 L/12.
  CHECK_THAT(whole[0], WithinRel(.5 * .02 * .02, .3 / 12. + 1e-3));
  CHECK_THAT(whole[1], WithinRel(-.5 * std::pow(.02, 3), .3 / 12. + 1e-3));
  CHECK_THAT(std::log2(whole[0] / half[0]), WithinAbs(2., 1e-3));
  CHECK_THAT(std::log2(whole[1] / half[1]), WithinAbs(3., 1e-3));
}

TEST_CASE("a steadily spinning ANCF beam has the stretch and frequency of the closed forms",
          "[rotating]") {
  const PlanarBeam b = hubbed(spin_up_beam(8), true);
  const Material& m = b.material;
  const double unit = std::sqrt(m.young * b.section.inertia_y / (m.density * b.section.area)) /
                      (b.length * b.length);
  // Wright, Smith, Thresher and Wang (1982), 5 digits; in the plane the square is less by spin^2.
  const double published[][2] = {{0., 3.5160}, {1., 3.6817}, {2., 4.1373},
                                 {4., 5.5850}, {6., 7.3604}, {10., 11.2023}};
  for (const auto& [spin, flap] : published) {
    INFO("spin " << spin);
    const Steady found = steady(b, spin * unit);
    const double square = std::pow(found.lowest / unit, 2) + spin * spin;
    CHECK_THAT(std::sqrt(square), WithinAbs(flap, 5e-5 + 2e-5 * flap));
    // The stretch is rho w^2 L^3/3E; terms of higher order are strains, 1e-4 at most.
    const double stretch =
        m.density * std::pow(spin * unit, 2) * std::pow(b.length, 3) / 3. / m.young;
    CHECK_THAT(found.q[b.structure.unknowns() - 9] - b.length,
               WithinAbs(stretch, 3e-4 * stretch + 1e-13));
  }
}

TEST_CASE("three formulations follow a spin-up over the beam's first frequency", "[rotating]") {
  // The speed is Wu and Haug's 4 rad/s; the beam's first frequency is 2.91 rad/s.
  const SpinUp hub{4.};
  const SpinUpReference reference = spin_up_reference(hub, 8, .01);
  INFO("lag " << reference.largest_lag << ", own error " << reference.own_error);
  const double known = reference.own_error / reference.largest_lag;

  SECTION("ANCF converges to the geometrically exact beam") {
    double error[3];
    for (int k = 0; k < 3; ++k) {
      // The tip is extrapolated to step 0, so that only the mesh's error is left.
      const int elements = 1 << k;
      const SpinUpRun fine = spin_up_ancf(hub, elements, .01);
      SpinUpRun run = spin_up_ancf(hub, elements, .02);
      for (std::size_t i = 0; i < run.tip.size(); ++i)
        run.tip[i] = (4. * fine.tip[i] - run.tip[i]) / 3.;
      error[k] = reference.error(run);
    }
    INFO(error[0] << " " << error[1] << " " << error[2] << ", reference " << known);
    CHECK(error[1] < error[0] / 3.);
    CHECK(error[2] < error[1] / 3.);
  }
  SECTION("a frame with stiffening errs by the terms that it leaves out") {
    // It leaves out terms of the slope squared, (lag/L)^2 = 4.5e-3, and has three modes.
    const double slope = reference.largest_lag / kSpinUpLength;
    CHECK(reference.error(spin_up_frame(hub, 3, 1, true, .01)) < slope * slope);
  }
  SECTION("a frame without stiffening flies apart") {
    CHECK(reference.error(spin_up_frame(hub, 3, 1, false, .01)) > 1e6);
  }
  SECTION("the linearised beam leaves its circular path") {
    // The tip goes along a straight line: beyond a right angle the error is of length L.
    CHECK(reference.error(spin_up_linear(hub, 4, .01)) * reference.largest_lag > kSpinUpLength);
  }
}

TEST_CASE("without stiffening a frame errs by the square of the speed", "[rotating]") {
  double error[2];
  for (const int k : {0, 1}) {
    const SpinUp hub{.25 * (k + 1)};
    error[k] = spin_up_reference(hub, 4, .01).error(spin_up_frame(hub, 3, 1, false, .01));
  }
  // The lag is largest near half the speed: it errs by 1.193 (w/2)^2/w1^2, to terms of (w/w1)^4.
  INFO(error[0] << " " << error[1]);
  CHECK_THAT(error[1] / error[0], WithinAbs(4., .3));
}

namespace {

/// A 2 m rail that falls from the horizontal about a hinge for 1.2 s, until it nearly hangs down.
struct Fall {
  double frame = 0.;  // largest distance between the tips of ANCF and floating frame, m
  double rigid = 0.;  // between those of ANCF and rigid body
  double line = 0.;  // between that of the linearised beam and the straight line of its closed form
  double angle = 0.;        // at the end, rad
  double mass_change = 0.;  // largest change of the frame's inertia about the hinge, over its value
};

Fall fall(double step) {
  const PlanarBeam b = hubbed(rail(2), false), clamped = hubbed(rail(2), true);
  const Vector2d gravity(0., -kGravity);
  const Eigen::MatrixXd modes = planar_modes(clamped, 3, 1);
  const FloatingFrame frame = floating_frame(clamped.structure, clamped.mass, modes, true);
  const FramePoint end = frame_point(clamped.structure, modes, 4, true);
  const auto undriven = [](Moving&) {};
  AncfBody ancf(b, undriven, gravity_load(b, gravity));
  LinearBody linear(b, undriven, gravity_load(b, gravity));
  FloatingBody floating(frame, {2, 3, 4, 5, 6}, undriven, gravity);
  MovingBody* const bodies[3] = {&ancf, &linear, &floating};
  Moving m[3] = {at_rest(b.structure.rest), at_rest(b.structure.rest), at_rest(VectorXd::Zero(7))};
  for (int k = 0; k < 3; ++k) start(*bodies[k], m[k]);
  const GeneralisedAlpha scheme(step, .8);
  const Tip node = tip_node(36);
  // Runge-Kutta solves the rigid body: th'' = -k cos th.
  const double k = kGravity * frame.first[0] / frame.inertia;
  const auto slope = [k](const Vector2d& y) { return Vector2d(y[1], -k * std::cos(y[0])); };
  Vector2d y(0., 0.);
  Fall f;
  for (int i = 1; i <= std::lround(1.2 / step); ++i) {
    for (int body = 0; body < 3; ++body) {
      m[body].time = (i - 1) * step;
      scheme.advance(*bodies[body], m[body], 1e-11);
    }
    const Vector2d k1 = slope(y), k2 = slope(y + .5 * step * k1);
    const Vector2d k3 = slope(y + .5 * step * k2), k4 = slope(y + step * k3);
    y += step / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
    const Vector2d circle = 2. * Vector2d(std::cos(y[0]), std::sin(y[0]));
    const Vector2d line(2., -k * std::pow(i * step, 2));
    f.frame = std::max(f.frame, (node(m[0]) - position(end, m[2].q)).norm());
    f.rigid = std::max(f.rigid, (node(m[0]) - circle).norm());
    f.line = std::max(f.line, (node(m[1]) - line).norm());
    const double inertia = mass_matrix(frame, m[2].q)(2, 2);
    f.mass_change = std::max(f.mass_change, std::abs(inertia / frame.inertia - 1.));
  }
  f.angle = y[0];
  return f;
}

}  // namespace

TEST_CASE("a rail that falls about a hinge needs the nonlinear element or a frame", "[rotating]") {
  const Fall coarse = fall(1e-3), fine = fall(5e-4);
  // ANCF and the frame differ by the error of the time scheme in ANCF's rotation, of second order.
  CHECK_THAT(std::log2(coarse.frame / fine.frame), WithinAbs(2., .1));
  // Both are the same elastic rail: they are nearer to each other than to the rigid one. From the
  // rigid one they differ by less than twice a cantilever's sag, as under a load put on suddenly.
  const BeamSection s = section_f();
  const Material m;
  const double sag = m.density * s.area * kGravity * std::pow(2., 4) / (8. * m.young * s.inertia_y);
  CHECK(fine.frame < fine.rigid);
  CHECK(fine.rigid < 2. * sag);
  // The linearised rail falls along a straight line, z = -L k t^2/2, as if it never turned.
  CHECK(fine.line < 2. * sag);
  CHECK(fine.angle < -3.);
  CHECK(fine.mass_change > 1e-7);
}
