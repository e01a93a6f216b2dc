#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/pendulum_ancf.h"
#include "support/pendulum_frame.h"
#include "support/pendulum_ida.h"
#include "support/pendulum_rigid.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::Vector2d;

namespace {

const DoublePendulum kScene;

PendulumPath stored() {
  return read_pendulum_path(std::string(RAILSTEP_SOURCE) + "/tests/data/double_pendulum.csv");
}

template <typename Model>
PendulumRun followed(const Model& model, double until) {
  return swing(model, until, steps_for(model.highest_frequency()));
}

PendulumRun ancf(const DoublePendulum& scene, int elements, double until) {
  return followed(AncfPendulum(scene, elements), until);
}

/// The frame's oscillations grow faster at large bending: eight times the steps that rest needs.
PendulumRun tangent_frame(const DoublePendulum& scene, double until) {
  const FramePendulum model(scene, {.tangent = true});
  return swing(model, until, 8 * steps_for(model.highest_frequency()));
}

DoublePendulum stiffer(double times) {
  DoublePendulum scene;
  scene.material.young *= times;
  return scene;
}

double bending_stiffness(const DoublePendulum& scene) {
  return scene.material.young * scene.section().inertia_y;
}

/// Mean axial force of the first link where its ends are farthest apart, N; bending only moves them
/// closer.
double largest_tension(const DoublePendulum& scene, const PendulumPath& path) {
  double longest = 0.;
  for (const HingeAndEnd& at : path.at) longest = std::max(longest, at.head<2>().norm());
  return scene.material.young * scene.section().area * (longest / scene.link - 1.);
}

/// Energy of a velocity error: links of 3.8 kg move at less than 6 m/s.
double worth(double velocity) { return 2. * kScene.link_mass() * 6. * velocity; }

}  // namespace

TEST_CASE("extrapolated midpoint steps converge with their order", "[pendulum]") {
  const RigidPendulum links(kScene);
  const auto slope = [&](double, const Eigen::VectorXd& at) {
    Eigen::VectorXd dy(4);
    links.slope(at, dy);
    return dy;
  };
  const auto end = [&](int rows, int steps) {
    Eigen::VectorXd y = links.start();
    for (int i = 0; i < steps; ++i) y = extrapolated_step(slope, 0., y, .4 / steps, rows);
    return y;
  };
  const Eigen::VectorXd exact = end(6, 800);
  for (const int rows : {1, 2}) {
    INFO("rows " << rows);
    // At 1 and .5 ms terms that are two orders higher are less than a tenth of the ratio.
    const double coarse = (end(rows, 400) - exact).norm(), fine = (end(rows, 800) - exact).norm();
    CHECK_THAT(std::log2(coarse / fine), WithinAbs(2. * rows, .15));
  }
}

TEST_CASE("the stored double pendulum agrees with the published table", "[pendulum]") {
  // The table is from another program with 16 elements and energy-momentum: uncertain by 1e-5 m.
  const double table[4][5] = {{.1, .395226, -.061927, .794770, -.042493},
                              {.2, .337426, -.214950, .736686, -.190388},
                              {.3, .197918, -.347682, .569036, -.497033},
                              {.4, .089146, -.390236, .099862, -.790218}};
  const PendulumPath path = stored();
  CHECK(path.at.size() == 21);
  CHECK_THAT(path.end(), WithinAbs(1., 1e-12));
  for (const auto& row : table)
    for (int k = 0; k < 4; ++k) CHECK_THAT(path.when(row[0])[k], WithinAbs(row[k + 1], 1e-5));
}

TEST_CASE("IDA and extrapolation compute the same pendulum", "[pendulum][ida]") {
  const double tolerance = 1e-8;
  const AncfPendulum model(kScene, 4);
  IdaPendulum ida(model, tolerance);
  const PendulumRun by_ida = ida.run(.3), by_extrapolation = followed(model, .3);
  const Vector2d gap = apart(by_ida.path, by_extrapolation.path, .3);
  INFO("B " << gap[0] << ", C " << gap[1] << " m; energy " << by_ida.energy_change << " and "
            << by_extrapolation.energy_change << " J; " << ida.count().steps << " steps");
  // Stability and not accuracy limits the steps, so errors stay below the tolerance of q; the
  // tolerance of v is 100 times as large.
  CHECK(gap.maxCoeff() < tolerance);
  CHECK(by_ida.energy_change < worth(100. * tolerance));
  // Order 12 leaves the round-off of some 1e5 evaluations of energies of 10 J.
  CHECK(by_extrapolation.energy_change < 1e5 * 10. * 2.2e-16);
  CHECK(ida.count().failed_error_tests < ida.count().steps / 100);
}

TEST_CASE("IDA limited to order 2 has that order", "[pendulum][ida]") {
  // From order 3 on backward differences are not stable along the imaginary axis, and the steps no
  // longer follow the tolerance.
  const AncfPendulum model(kScene, 4);
  const PendulumPath exact = followed(model, .2).path;
  Vector2d error[2];
  double steps[2];
  for (const int k : {0, 1}) {
    IdaPendulum ida(model, k == 0 ? 1e-4 : 1e-6, 2);
    error[k] = apart(ida.run(.2).path, exact, .2);
    steps[k] = static_cast<double>(ida.count().steps);
  }
  // Steps vary in a run, and a little between the runs: a tenth of the exponent and some more.
  for (const int k : {0, 1})
    CHECK_THAT(std::log(error[0][k] / error[1][k]) / std::log(steps[1] / steps[0]),
               WithinAbs(2., .3));
}

TEST_CASE("meshes of the double pendulum converge to the stored one", "[pendulum]") {
  const PendulumPath fine = stored();
  double error[3];
  for (const int k : {0, 1, 2})
    error[k] = apart(ancf(kScene, 2 << k, .3).path, fine, .3).maxCoeff();
  INFO(error[0] << " " << error[1] << " " << error[2]);
  // Quadratic elements with axial stretch and shear at two points have at least order 2.
  CHECK(error[1] < error[0] / 4.);
  CHECK(error[2] < error[1] / 4.);
  CHECK(error[2] > 10. * kPendulumKnown);  // these are not the stored path's own error
}

TEST_CASE("rigid links err by the bending of the links", "[pendulum]") {
  const PendulumRun rigid = swing(RigidPendulum(kScene), 1., 1);
  CHECK(rigid.energy_change < 1e5 * 10. * 2.2e-16);
  const PendulumPath fine = stored();
  HingeAndEnd most = HingeAndEnd::Zero();
  for (int i = 0; i <= 20; ++i)
    most = most.cwiseMax((rigid.path.when(.05 * i) - fine.when(.05 * i)).cwiseAbs());
  // The figure is published to .1 mm, against a path known to 1e-5 m.
  CHECK_THAT(most.head<2>().maxCoeff(), WithinAbs(11.5e-3, 6e-5));
  CHECK_THAT(most.tail<2>().maxCoeff(), WithinAbs(16.2e-3, 6e-5));
}

TEST_CASE("the difference of stiff links from rigid ones falls with the modulus", "[pendulum]") {
  double gap[2];
  for (const int k : {0, 1}) {
    const DoublePendulum scene = stiffer(k == 0 ? 4. : 16.);
    gap[k] = apart(ancf(scene, 2, .3).path, swing(RigidPendulum(scene), .3, 1).path, .3)[1];
  }
  // Deflections go with 1/E. The next term is the share of tension in bending (below), .38 at E: a
  // tenth of the ratio at 4 E.
  INFO(gap[0] << " " << gap[1]);
  CHECK_THAT(gap[0] / gap[1], WithinAbs(4., .4));
}

TEST_CASE("modal links keep their energy and their joints", "[pendulum][frame]") {
  const bool stiffening = GENERATE(false, true);
  const FramePendulum model(kScene, {.stiffening = stiffening});
  double joint = 0.;
  const PendulumRun run =
      swing(model, 1., steps_for(model.highest_frequency()),
            [&](const auto& y) { joint = std::max(joint, model.joint_gap(y)); });
  // Nothing damps and the joints do no work: only round-off is left, over 1000 steps.
  CHECK(run.energy_change < 1e5 * 10. * 2.2e-16);
  CHECK(joint < 1e5 * 2.2e-16);
}

TEST_CASE("modal links err by the stiffness from tension", "[pendulum][frame]") {
  const PendulumPath fine = stored();
  const Vector2d elastic = apart(swing(RigidPendulum(kScene), 1., 1).path, fine, 1.);
  // Under tension P a pinned link bends less by P / (pi^2 EI / L^2), over Euler's load. Without
  // this a linear link errs by that share of all elastic effects, with it by its square.
  const double share = largest_tension(kScene, ancf(kScene, 2, .4).path) /
                       (std::pow(std::numbers::pi / kScene.link, 2) * bending_stiffness(kScene));
  CHECK(share < .5);
  const auto drift = [&](bool stiffening) {
    const LinkModes kept{.bending = 6, .axial = 2, .stiffening = stiffening};
    return apart(followed(FramePendulum(kScene, kept), 1.).path, fine, 1.);
  };
  const Vector2d without = drift(false), with = drift(true);
  INFO("share " << share << "; C is off by " << without[1] << " without, by " << with[1]
                << " with it, rigid by " << elastic[1]);
  for (const int k : {0, 1}) {
    CHECK(without[k] < share * elastic[k]);
    CHECK(with[k] < share * share * elastic[k]);
    CHECK(with[k] < share * without[k]);
  }
}

TEST_CASE("a linear link in a tangent frame buckles in tension", "[pendulum][frame]") {
  // The link from A to B is at an angle w/L to its frame, which can rotate. So tension pulls the
  // tip sideways by P w/L against 3 EI w/L^3: at P = 3 EI/L^2 nothing holds it. A real link is
  // stiffer under tension; the frame's strain does not know that its rotation stretches nothing.
  const double limit = 3. * bending_stiffness(kScene) / std::pow(kScene.link, 2);
  double drift[2];
  for (const int k : {0, 1}) {
    const DoublePendulum scene = stiffer(k == 0 ? 1. : 2.);
    const PendulumPath exact = ancf(scene, 2, .4).path;
    const double tension = largest_tension(scene, exact);
    INFO("tension " << tension << " of " << limit * (k + 1));
    CHECK((tension > limit * (k + 1)) == (k == 0));
    drift[k] = apart(tangent_frame(scene, .4).path, exact, .4)[0];
  }
  // Below the limit the error is a share of the deflection, as in every linear link. Beyond it the
  // deflection itself grows, to more than all elastic effects.
  const double elastic = apart(swing(RigidPendulum(kScene), .4, 1).path, stored(), .4)[0];
  INFO(drift[0] << " and " << drift[1] << ", elastic " << elastic);
  CHECK(drift[0] > elastic);
  CHECK(drift[1] < elastic / 2.);
}
