// The largest growth factor of a step against closed forms, so that maps of it can be trusted.
#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "hard/growth.h"

using namespace railstep;

namespace {

/// The scene's rail without dampers: 50 kg, 0.1 m long, whose sections turn with rho I L = 5 kg m2,
/// on 0.7e9 N/m at each end. Its pitch is its slowest motion.
const double kPitchRate = std::sqrt(.25 * 1.4e9 * .1 * .1 / (50. * .1 * .1 / 12. + 5.));  // rad/s

/// The rail gives way by 4e-4 of its seats; backward Euler's loss goes with the rate's square.
constexpr double kGives = 1e-3;

double growth(const std::string& scheme, double dt) {
  Simulation run(
      read_scene(RAILSTEP_SOURCE "/config/hard/h01_stiff_damper.toml",
                 {"support.damping_z_n_s_per_m=0.0", scheme, fmt::format("step.dt_s={}", dt)}));
  return growth_of(run);
}

/// Largest factor of generalised-alpha with equilibrium at the step's end, for u, v dt, a dt^2 and
/// g dt^2 of one mass.
/// @param turn  omega dt
double of_one_mass(double rho, double turn) {
  const double am = (2. * rho - 1.) / (rho + 1.), af = rho / (1. + rho);
  const double gamma = .5 - am + af, beta = .25 * (1. + af - am) * (1. + af - am);
  const double part = (1. - af) / (1. - am);
  // a1 = part g1 + a*, u1 = u* + beta part g1 with a* and u* of the step's start; g1 = -turn^2 u1
  const Eigen::RowVector4d a_star(0., 0., -am / (1. - am), af / (1. - am));
  const Eigen::RowVector4d u_star = Eigen::RowVector4d(1., 1., .5 - beta, 0.) + beta * a_star;
  const Eigen::RowVector4d g1 = -turn * turn / (1. + turn * turn * beta * part) * u_star;
  const Eigen::RowVector4d a1 = part * g1 + a_star;
  Eigen::Matrix4d map;
  map << u_star + beta * part * g1, Eigen::RowVector4d(0., 1., 1. - gamma, 0.) + gamma * a1, a1, g1;
  return map.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("backward Euler's largest factor is 1 / sqrt(1 + w^2 dt^2) of the slowest mode",
          "[stability]") {
  for (const double dt : {1e-5, 1e-4, 1e-3}) {
    CAPTURE(dt);
    const double want = 1. / std::sqrt(1. + kPitchRate * kPitchRate * dt * dt);
    CHECK(1. - growth("step.scheme=\"backward-euler\"", dt) == Approx(1. - want).epsilon(kGives));
  }
}

TEST_CASE("the trapezoidal rule neither grows nor shrinks", "[stability]") {
  for (const double dt : {1e-5, 1e-3, 2e-2})
    CHECK(growth("step.scheme=\"newmark\"", dt) == Approx(1.).margin(1e-6));
}

TEST_CASE("generalised-alpha's largest factor is that of one mass", "[stability]") {
  for (const double rho : {.3, .6, .9})
    for (const double dt : {1e-4, 1e-3, 1e-2}) {
      CAPTURE(rho, dt);
      const double want = of_one_mass(rho, kPitchRate * dt);
      CHECK(1. - growth(fmt::format("step.rho_inf={}", rho), dt) ==
            Approx(1. - want).epsilon(2. * kGives).margin(1e-12));
    }
}

TEST_CASE("a condensed track's largest factor is that of its slowest decay", "[stability]") {
  // k u + c u' = 0 for the seats, whose forces are far larger than those of the rail's mass.
  for (const double dt : {1e-5, 1e-3}) {
    CAPTURE(dt);
    Simulation run(read_scene(RAILSTEP_SOURCE "/config/hard/h01_stiff_damper.toml",
                              {"condense.kind=\"modal\"", fmt::format("step.dt_s={}", dt)}));
    CHECK(1. - growth_of(run) == Approx(1. - std::exp(-.7e9 / 14.5e6 * dt)).epsilon(kGives));
  }
}

TEST_CASE("a wheel on a condensed track is damped by the track's dampers", "[stability]") {
  // Its bounce on the seats is slow: a step of 0.1 ms damps it little, but far more than nothing.
  const std::vector<std::string> condensed = {"condense.kind=\"modal\"", "step.dt_s=1e-4",
                                              "step.rho_inf=1.0",
                                              "condense.residual_flexibility=false"};
  std::vector<std::string> damped = condensed;
  damped.emplace_back("support.damping_z_n_s_per_m=3e4");
  Simulation keeps(read_scene(RAILSTEP_SOURCE "/config/hard/h49_stability.toml", condensed));
  Simulation takes(read_scene(RAILSTEP_SOURCE "/config/hard/h49_stability.toml", damped));
  CHECK(std::abs(growth_of(keeps) - 1.) < 1e-10);
  CHECK(growth_of(takes) < 1. - 1e-4);
}

TEST_CASE("a search for the growth factor leaves the state as it was", "[stability]") {
  Simulation run(read_scene(RAILSTEP_SOURCE "/config/hard/h49_stability.toml"));
  const std::uint64_t before = state_hash(run.model(), run.state);
  static_cast<void>(growth_of(run));
  CHECK(state_hash(run.model(), run.state) == before);
}
