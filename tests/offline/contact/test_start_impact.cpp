// A track at rest that a load meets suddenly: second order from the first step on.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/pack/time_schemes.h"
#include "offline/start/start_impact.h"
#include "support/model_run.h"

using namespace railstep;

namespace {

constexpr double kMass = 50., kStiffness = 2e6, kDamping = 8e3, kForce = 1e4;  // for the whole rail

/// A rail that moves as one mass on two seats; the force acts in its middle.
Track one_mass_on(double stiffness, double damping) {
  Track t;
  t.section = {.area = 1e3, .inertia_y = 1e3, .inertia_z = 1e3, .torsion = 1e3};
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.elements_per_bay = 1;
  t.material.density = kMass / (t.section.area * t.bay_length);
  t.support.stiffness = {0., 0., stiffness / 2.};
  t.support.damping = {0., 0., damping / 2.};
  return t;
}

/// Solution of m x'' + c x' + k x = F from rest, an oscillation.
double swung(double t) {
  const double decay = kDamping / (2. * kMass), w = std::sqrt(kStiffness / kMass - decay * decay);
  return kForce / kStiffness *
         (1. - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
}

double deflection(const Track& track, double dt, double until) {
  ModelRun run(track, {.loads = {{.start = .3, .stop = .6, .force = -kForce}}},
               {.scheme = generalised_alpha(dt, .6), .residual_flexibility = false});
  run.packed->set_start(start_under_impact(track, *run.packed, 0.));
  reset(run.model(), run.state);
  run.until(until);
  return -run.outputs.load_deflection[0];
}

}  // namespace

TEST_CASE("a mass under a sudden load oscillates with the second order of the step", "[start]") {
  const Track track = one_mass_on(kStiffness, kDamping);
  const double until = .02;
  double before = 0.;
  for (const double dt : {1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5}) {
    const double error = std::abs(deflection(track, dt, until) / swung(until) - 1.);
    CAPTURE(dt, error, before);
    if (before > 0.) CHECK(std::log2(before / error) > 1.8);  // a start from rest has 1
    before = error;
  }
}

TEST_CASE("a mass that dampers hold 500 times stiffer than the step does not lag", "[start]") {
  // The paper's lateral seat has 48.28 1/s and 5.8e5 1/s at steps of 1 ms.
  const double k = 1.4e9, c = 29e6;
  const double exact = kForce / k * (1. - std::exp(-k / c * 1e-3));
  CHECK(deflection(one_mass_on(k, c), 1e-3, 1e-3) == Approx(exact).margin(2e-4 * kForce / k));
}
