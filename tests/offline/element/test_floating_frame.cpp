#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/floating_frame.h"
#include "support/rotating_beam.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

struct FramedBeam {
  PlanarBeam beam;
  MatrixXd modes;
  FloatingFrame frame;
};

/// A floating frame: the tangent frame of a clamped beam, or the mean axes of a free one.
FramedBeam framed(int bending, int axial, bool stiffening, bool clamped = true) {
  FramedBeam f{clamped ? hubbed(spin_up_beam(8), true) : spin_up_beam(8), {}, {}};
  f.modes = planar_modes(f.beam, bending, axial);
  f.frame = floating_frame(f.beam.structure, f.beam.mass, f.modes, stiffening);
  return f;
}

/// A general position, the beam bent by some percent of its length; the last mode is axial.
VectorXd somewhere(const FloatingFrame& f, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1., 1.);
  VectorXd q(3 + f.modes());
  for (int i = 0; i < q.size(); ++i) q[i] = number(random);
  for (int i = 0; i < f.modes(); ++i) q[3 + i] *= i < f.modes() - 1 ? .2 : 1e-4;
  return q;
}

/// Quantities that a free beam keeps: momentum in x, in z and about the origin, and energy.
Eigen::Vector4d kept(const FloatingFrame& f, const Moving& m) {
  const VectorXd p = mass_matrix(f, m.q) * m.v;
  return {p[0], p[1], m.q[0] * p[1] - m.q[1] * p[0] + p[2], energy(f, m.q, m.v, Vector2d::Zero())};
}

}  // namespace

TEST_CASE("the mass matrix of a frame is that of its material points", "[frame]") {
  // The simple twin has 2 x 2 points over the section and 3 along each element, which integrate the
  // shapes exactly; point_row gives the shapes, their motion is by hand.
  const FramedBeam b = framed(3, 1, false);
  const VectorXd q = somewhere(b.frame, 3);
  const double c = std::cos(q[2]), s = std::sin(q[2]), part = kSpinUpLength / 8;
  const double y = std::sqrt(b.beam.section.inertia_z / b.beam.section.area);
  const double z = std::sqrt(b.beam.section.inertia_y / b.beam.section.area);
  MatrixXd M = MatrixXd::Zero(7, 7);
  for (const Structure::Element& e : b.beam.structure.elements)
    for (const GaussPoint& g : gauss(3))
      for (const double side : {-1., 1.})
        for (const double height : {-1., 1.}) {
          Eigen::Matrix<double, 3, 4> shape;
          Eigen::Vector3d at;
          for (int k = 0; k < 3; ++k) {
            const Vector27 row = point_row(g.xi, side * y, height * z, k);
            at[k] = row.dot(b.beam.structure.rest.segment<27>(9 * e.node[0]));
            shape.row(k) = row.transpose() * b.modes.middleRows<27>(9 * e.node[0]);
          }
          at += shape * q.tail<4>();
          MatrixXd J = MatrixXd::Zero(3, 7);
          J(0, 0) = J(2, 1) = 1.;
          J(0, 2) = -s * at[0] - c * at[2];
          J(2, 2) = c * at[0] - s * at[2];
          J.block<1, 4>(0, 3) = c * shape.row(0) - s * shape.row(2);
          J.block<1, 4>(1, 3) = shape.row(1);
          J.block<1, 4>(2, 3) = s * shape.row(0) + c * shape.row(2);
          const double mass = b.beam.material.density * b.beam.section.area * part / 8. * g.weight;
          M += mass * J.transpose() * J;
        }
  // Sums of a hundred products err by 1e-13 of the largest entry.
  CHECK((M - mass_matrix(b.frame, q)).cwiseAbs().maxCoeff() < 1e-13 * M.cwiseAbs().maxCoeff());
}

TEST_CASE("a point's Jacobian is the derivative of its position", "[frame]") {
  const FramedBeam b = framed(3, 1, true);
  const FramePoint tip = frame_point(b.beam.structure, b.modes, 16, true);
  const VectorXd q = somewhere(b.frame, 5);
  const Eigen::Matrix2Xd J = jacobian(tip, q);
  for (int i = 0; i < q.size(); ++i) {
    VectorXd more = q, less = q;
    more[i] += 1e-4;
    less[i] -= 1e-4;
    // The position is quadratic in eta; for the angle h^2/6 of the third derivative, L, is 2e-8.
    CHECK((J.col(i) - (position(tip, more) - position(tip, less)) / 2e-4).norm() < 3e-8);
  }
  // H = 4 W^2/(3 L) for a slope w' = 2 W x/L^2; the first mode's is within a few percent of it.
  const double w = tip.shape(1, 0);
  CHECK_THAT(tip.shortening(0, 0), WithinRel(4. * w * w / (3. * kSpinUpLength), .15));
}

TEST_CASE("a thrown beam keeps its momentum and energy to the scheme's order", "[frame]") {
  // Every velocity force takes part; a wrong one leaves a change that smaller steps do not reduce.
  const bool stiffening = GENERATE(false, true);
  const FramedBeam b = framed(3, 1, stiffening, false);
  const auto lost = [&](double step) {
    FloatingBody body(b.frame, {0, 1, 2, 3, 4, 5, 6}, [](Moving&) {});
    Moving m = at_rest(somewhere(b.frame, 1));
    m.q.tail<4>() *= .5;
    m.v << 1., -.5, 2., .4, -.3, .2, .05;
    start(body, m);
    const Eigen::Vector4d before = kept(b.frame, m);
    const GeneralisedAlpha scheme(step, 1.);
    Eigen::Vector4d most = Eigen::Vector4d::Zero();
    for (int i = 0; i < std::lround(.5 / step); ++i) {
      m.time = i * step;
      scheme.advance(body, m, 1e-13);
      most = most.cwiseMax((kept(b.frame, m) - before).cwiseAbs());
    }
    return most;
  };
  const Eigen::Vector4d coarse = lost(4e-4), fine = lost(2e-4);
  for (int k = 0; k < 4; ++k) {
    INFO("quantity " << k << ": " << coarse[k] << ", " << fine[k]);
    CHECK_THAT(std::log2(coarse[k] / fine[k]), WithinAbs(2., .1));
  }
}

TEST_CASE("a spinning frame has the published frequencies only with its stiffening", "[frame]") {
  // Wright, Smith, Thresher and Wang (1982): flap frequency of a uniform cantilever on a hub
  // without radius, over sqrt(EI/(rho A L^4)), at spins over the same unit. The frequency in the
  // plane is sqrt(flap^2 - spin^2). They print 5 digits; a slenderness of 754 costs 1e-5.
  const double published[][2] = {{0., 3.5160}, {1., 3.6817}, {2., 4.1373},
                                 {4., 5.5850}, {6., 7.3604}, {10., 11.2023}};
  const FramedBeam with = framed(10, 1, true), without = framed(10, 1, false);
  const BeamSection& s = with.beam.section;
  const Material& m = with.beam.material;
  const double unit =
      std::sqrt(m.young * s.inertia_y / (m.density * s.area)) / (kSpinUpLength * kSpinUpLength);
  const auto lowest = [&](const FloatingFrame& f, double spin) {
    const MatrixXd K = f.stiffness - spin * spin * (f.mode_mass - f.shortening_x);
    return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, f.mode_mass).eigenvalues()[0];
  };
  for (const auto& [spin, flap] : published) {
    INFO("spin " << spin);
    const double square = lowest(with.frame, spin * unit) / (unit * unit) + spin * spin;
    CHECK_THAT(std::sqrt(square), WithinAbs(flap, 5e-5 + 2e-5 * flap));
    // Without stiffening the spin lowers the frequency, down to 0 at the frequency at rest.
    CHECK_THAT(lowest(without.frame, spin * unit) / (unit * unit),
               WithinAbs(3.5160 * 3.5160 - spin * spin, 4e-4 + 4e-5 * 3.5160 * 3.5160));
  }
}

TEST_CASE("a frame's mass matrix changes with its rotation and with its bending", "[frame]") {
  const FramedBeam b = framed(3, 1, true);
  VectorXd q = VectorXd::Zero(7);
  const MatrixXd rest = mass_matrix(b.frame, q);
  q[2] = 4. * std::atan(1.);
  const MatrixXd turned = mass_matrix(b.frame, q);
  // The origin's coupling with the rest turns with the frame: half a turn reverses it.
  CHECK((turned.topRightCorner<2, 5>() + rest.topRightCorner<2, 5>()).norm() <
        1e-14 * rest.topRightCorner<2, 5>().norm());
  CHECK((turned.bottomRightCorner<5, 5>() - rest.bottomRightCorner<5, 5>()).norm() == 0.);
  // Bending changes the rest: the inertia about the origin changes with the tip's shortening and
  // lateral position, of order (w/L)^2.
  const FramePoint tip = frame_point(b.beam.structure, b.modes, 16, true);
  q.setZero();
  q[3] = .5 / tip.shape(1, 0);
  const double change = mass_matrix(b.frame, q)(2, 2) / rest(2, 2) - 1.;
  CHECK(std::abs(change) > .1 * (.5 / 8.) * (.5 / 8.));
  CHECK(std::abs(change) < (.5 / 8.) * (.5 / 8.));
}
