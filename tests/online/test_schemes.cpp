// Compares the named time schemes with textbooks step by step, and checks their orders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "offline/pack/time_schemes.h"
#include "support/dense_line.h"
#include "support/model_run.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Eigen::VectorXd;

namespace {

/// One rail on three pads, in bending only, with a load that stands between two of them.
Track small_track() {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = 2;
  t.elements_per_bay = 1;
  t.support.stiffness = {0., 0., 3e7};
  t.support.damping = {0., 0., 3e4};
  return t;
}
constexpr double kPlace = .41, kForce = -50e3, kHz = 40.;  // m, N, Hz

MovingLoad raised_cosine() {  // kForce (1 - cos(2 pi kHz t))
  return {.start = kPlace,
          .stop = 2.,
          .force = kForce,
          .amplitude = kForce,
          .frequency = kHz,
          .phase = -.25};
}

PackOptions plain(const Scheme& scheme) {
  return {.scheme = scheme, .residual_flexibility = false};
}

DenseLine dense(const Track& track) {
  const std::vector<Line> lines = assemble(track);
  REQUIRE(lines.size() == 1);
  return {track, lines[0], {0, kPlace, 0., 0., 2}};
}

double cosine_force(double t) { return kForce * (1. - std::cos(2. * M_PI * kHz * t)); }

struct Member {
  std::string name;
  Scheme scheme;
  Textbook textbook;
};

/// As Chung and Hulbert 1993, eqs. 17 and 25, print them.
Textbook optimal(double rho) {
  const double m = (2. * rho - 1.) / (rho + 1.), f = rho / (rho + 1.);
  return {m, f, .25 * (1. - m + f) * (1. - m + f), .5 - m + f};
}

}  // namespace

namespace {

/// Compares u, v and a step by step. Both sides solve matrices of condition 1e4 (EI/l^3 beside
/// M/h^2), so they differ by 1e-12 a step; undamped members add this up over 200 steps, and a
/// factor remains. Accelerations are differences of u over h^2: another factor.
void check_steps(const Scheme& scheme, const std::vector<DenseMotion>& wanted) {
  ModelRun run(small_track(), {.loads = {raised_cosine()}}, plain(scheme));
  double miss[3] = {}, most[3] = {};
  for (const DenseMotion& at : wanted) {
    const VectorXd* const of[3] = {&at.u, &at.v, &at.a};
    const double* const state[3] = {run.state.u, run.state.v, run.state.a};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Map<const VectorXd> own(state[i], at.u.size());
      miss[i] = std::max(miss[i], (*of[i] - own).cwiseAbs().maxCoeff());
      most[i] = std::max(most[i], of[i]->cwiseAbs().maxCoeff());
    }
    run.step();
  }
  CHECK(miss[0] < 1e-9 * most[0]);
  CHECK(miss[1] < 1e-9 * most[1]);
  CHECK(miss[2] < 1e-8 * most[2]);
}

}  // namespace

TEST_CASE("every named scheme agrees with the textbook step by step", "[schemes]") {
  constexpr double h = 5e-4;
  constexpr int kSteps = 200;
  const Member members[] = {
      {"trapezoidal", newmark(h), {0., 0., .25, .5}},
      {"Newmark, damped", newmark(h, .6, .3025), {0., 0., .3025, .6}},
      {"Newmark, stiffer", newmark(h, .5, .5), {0., 0., .5, .5}},
      {"HHT 0", hilber_hughes_taylor(h, 0.), {0., 0., .25, .5}},
      {"HHT -0.1", hilber_hughes_taylor(h, -.1), {0., .1, .3025, .6}},
      {"HHT -1/3", hilber_hughes_taylor(h, -1. / 3.), {0., 1. / 3., 4. / 9., 5. / 6.}},
      {"generalised-alpha 0.6", generalised_alpha(h, .6), optimal(.6)},
      {"generalised-alpha 0", generalised_alpha(h, 0.), optimal(0.)},
      {"generalised-alpha 1", generalised_alpha(h, 1.), optimal(1.)}};
  for (const Member& member : members) {
    CAPTURE(member.name);
    check_steps(member.scheme, by_textbook(dense(small_track()), member.textbook, h, kSteps,
                                           [](int n) { return cosine_force(h * n); }));
  }
}

TEST_CASE("TR-BDF2 agrees with the textbook step by step", "[schemes]") {
  constexpr double h = 5e-4;
  check_steps(tr_bdf2(h), by_tr_bdf2(dense(small_track()), h, 200, cosine_force));
}

namespace {

/// Largest error of all unknowns up to 50 ms, over the largest value.
double error(const Scheme& scheme, const std::vector<VectorXd>& exact, int exact_per_step) {
  ModelRun run(small_track(), {.loads = {raised_cosine()}}, plain(scheme));
  double worst = 0., most = 0.;
  for (std::size_t i = 0; i < exact.size(); i += static_cast<std::size_t>(exact_per_step)) {
    const Eigen::Map<const VectorXd> u(run.state.u, exact[i].size());
    worst = std::max(worst, (exact[i] - u).cwiseAbs().maxCoeff());
    most = std::max(most, exact[i].cwiseAbs().maxCoeff());
    run.step();
  }
  return worst / most;
}

}  // namespace

TEST_CASE("every scheme has its order on a smooth problem", "[schemes]") {
  constexpr double h = 2e-4;  // and half of it
  std::vector<VectorXd> exact = exact_response(dense(small_track()), 2. * M_PI * kHz, h / 2., 500);
  for (VectorXd& u : exact) u *= kForce;
  struct Ordered {
    std::string name;
    Scheme (*scheme)(double dt);
    double order;
  };
  const Ordered schemes[] = {
      {"backward Euler", backward_euler, 1.},
      {"Newmark", [](double dt) { return newmark(dt); }, 2.},
      {"Newmark, gamma 0.75", [](double dt) { return newmark(dt, .75, .390625); }, 1.},
      {"HHT -0.1", [](double dt) { return hilber_hughes_taylor(dt, -.1); }, 2.},
      {"HHT -0.3", [](double dt) { return hilber_hughes_taylor(dt, -.3); }, 2.},
      {"generalised-alpha 0", [](double dt) { return generalised_alpha(dt, 0.); }, 2.},
      {"generalised-alpha 0.6", [](double dt) { return generalised_alpha(dt, .6); }, 2.},
      {"generalised-alpha 1", [](double dt) { return generalised_alpha(dt, 1.); }, 2.},
      {"TR-BDF2", tr_bdf2, 2.}};
  for (const Ordered& own : schemes) {
    const double coarse = error(own.scheme(h), exact, 2),
                 fine = error(own.scheme(h / 2.), exact, 1);
    CAPTURE(own.name, coarse, fine);
    // The track's lowest rates are 9e2 1/s, so the next term of the error is at most h 9e2 = 0.18
    // of the first. It halves with the step, which changes the order by 0.13.
    CHECK_THAT(std::log2(coarse / fine), WithinAbs(own.order, .15));
  }
}

TEST_CASE("parameters of schemes that are not stable at every step are refused", "[schemes]") {
  const double nan = std::nan("");
  const double refused[][2] = {{.49, .3}, {.5, .24},  {.6, .29}, {1.1, .6},
                               {.5, 1.1}, {nan, .25}, {.5, nan}};
  for (const auto& own : refused)
    CHECK_THROWS_AS(newmark(1e-3, own[0], own[1]), std::invalid_argument);
  for (const double alpha : {-.34, .01, nan})
    CHECK_THROWS_AS(hilber_hughes_taylor(1e-3, alpha), std::invalid_argument);
}

TEST_CASE("an infinitely stiff motion is damped by the radius at infinity of each scheme",
          "[schemes]") {
  // The roots are triple: the cube root of 1e-16, and a factor of 10.
  for (const double rho : {0., .3, .6, .9, 1.})
    CHECK_THAT(radius_at_infinity(generalised_alpha(1e-3, rho)), WithinAbs(rho, 1e-4));
  for (const double alpha : {0., -.05, -.1, -.3, -1. / 3.})
    CHECK_THAT(radius_at_infinity(hilber_hughes_taylor(1e-3, alpha)),
               WithinAbs((1. + alpha) / (1. - alpha), 1e-4));
  CHECK_THAT(radius_at_infinity(newmark(1e-3)), WithinAbs(1., 1e-4));
  CHECK(radius_at_infinity(newmark(1e-3, .6, .3025)) < .9);
  CHECK_THAT(radius_at_infinity(backward_euler(1e-3)), WithinAbs(0., 1e-4));
}
