// Masses and vehicles that run over a pinned beam: figures of hard-cases.md, and modal solutions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "crossing.h"
#include "model_run.h"
#include "offline/pack/scheme.h"
#include "offline/pack/start.h"
#include "offline/vehicle/kinds.h"
#include "sections.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// hard-cases.md R4: section F, 6 m, half the beam's mass.
Track rail(int elements) {
  BeamSection f = section_f();
  f.shear_factor_z = .472;
  return pinned_beam(f, {}, 6., elements);
}
constexpr double kMass = 204.885;  // kg

/// Yang and Yau's bridge. A = 1e4 m2 leaves Euler and Bernoulli's beam (test_fryba.cpp).
Track bridge(int elements) {
  return pinned_beam({.area = 1e4, .inertia_y = 2.9, .inertia_z = 1., .torsion = 1.},
                     {2.87e9, .3, .2303}, 25., elements);
}

RunningVehicle one_mass(double mass, double start, double speed) {
  RunningVehicle v;
  v.vehicle.bodies = {{mass}};
  v.vehicle.wheels = {{0, 0., .46}};
  v.start = start;
  v.speed = speed;
  v.contact = WheelContactKind::bonded;
  return v;
}

/// A run from equilibrium.
ModelRun from_rest(const Track& track, const Traffic& traffic, const PackOptions& options,
                   double gravity = 0.) {
  auto packed = std::make_unique<PackedModel>(track, traffic, options);
  packed->set_start(start_in_equilibrium(track, *packed, gravity));
  return ModelRun(std::move(packed));
}

/// Deflection of the middle, down, m: a node where the elements are even.
double midspan(const ModelRun& run) {
  const LineModel& line = run.model().line[0];
  return -run.state.u[line.first + line.unknown_of[0][9 * run.model().elements + 2]];
}

struct Largest {
  double value = 0., at = 0.;
  void note(double w, double t) {
    if (w > value) *this = {w, t};
  }
};

}  // namespace

TEST_CASE("a mass bonded to the beam it runs over has the figures of the series", "[vehicle]") {
  // hard-cases.md R4 and H15: 5e-4, of the largest deflection. It comes from the ground before it.
  const int steps = 6000;
  for (const double speed : {30.}) {
    const double dt = 6. / speed / steps;
    ModelRun run = from_rest(rail(32), {.vehicles = {one_mass(kMass, -.1 * 6., speed)}},
                             {.scheme = generalised_alpha(dt, .6)});
    Largest largest;
    double at[5] = {};
    for (int i = 1; i <= steps + steps / 10; ++i) {
      run.step();
      const double t = (run.time() * speed - .6) / 6.;
      largest.note(midspan(run), t);
      for (int k = 1; k < 5; ++k)
        if (i == steps / 10 + k * steps / 4) at[k] = midspan(run);
    }
    UNSCOPED_INFO(speed << " " << largest.value << " " << largest.at << " " << at[1] << " " << at[2]
                        << " " << at[3] << " " << at[4]);
    CHECK_THAT(largest.value, WithinRel(1.11880e-3, 5e-4));
    CHECK_THAT(largest.at, WithinAbs(.357, 1e-3));
  }
}

TEST_CASE("Yang and Yau's sprung mass has its figure", "[vehicle]") {
  // hard-cases.md R4: max 2.4073e-3 at .4123, printed to five and four digits
  RunningVehicle v = one_mass(5750., -1., 100. / 3.6);
  v.contact = WheelContactKind::linear;
  v.stiffness = 1595e3;
  const int steps = 4000;
  const double dt = 25. / v.speed / steps;
  ModelRun run = from_rest(bridge(16), {.vehicles = {v}}, {.scheme = generalised_alpha(dt, .6)});
  Largest largest;
  while (run.time() * v.speed < 26.) {
    run.step();
    largest.note(midspan(run), (run.time() * v.speed - 1.) / 25.);
  }
  CHECK_THAT(largest.value, WithinRel(2.4073e-3, 5e-4));
  CHECK_THAT(largest.at, WithinAbs(.4123, 1e-3));
}

namespace {

/// Largest and last of the differences between a run and the modal solution that goes with it, over
/// a crossing from the ground to the ground.
struct Compared {
  double midspan = 0., force = 0., body = 0.;  // largest difference: m, N, m
  double largest_midspan = 0., static_force = 0., largest_body = 0.;
};

Compared crossing(const Track& beam, const RunningVehicle& v, int modes, double dt, double until) {
  ModelRun run = from_rest(beam, {.vehicles = {v}}, {.scheme = generalised_alpha(dt, 1.)});
  const double k = v.contact == WheelContactKind::linear ? v.stiffness : 1e10;
  ModalCrossing exact(beam, modes, v.vehicle, v.start, v.speed, k, v.damping);
  Compared c;
  c.static_force = run.state.wheel_force[0];
  const double rest = run.state.u[run.model().vehicle[0].first];
  while (run.time() < until) {
    run.step();
    exact.step(dt);
    const double body = run.state.u[run.model().vehicle[0].first];
    const Eigen::VectorXd force = exact.forces();
    c.midspan = std::max(c.midspan, std::abs(midspan(run) + exact.midspan()));
    c.largest_midspan = std::max(c.largest_midspan, std::abs(exact.midspan()));
    c.body = std::max(c.body, std::abs(body - exact.body(0)));
    c.largest_body = std::max(c.largest_body, std::abs(exact.body(0) - rest));
    for (int i = 0; i < force.size(); ++i)
      c.force = std::max(c.force, std::abs(run.outputs.wheel_force[i] - force[i]));
  }
  return c;
}

/// The Manchester benchmark's, of one rail.
const BogieData kBogie{.frame_mass = 1307.5,
                       .frame_inertia = 738.,
                       .wheel_mass = 906.5,
                       .wheelbase = 2.56,
                       .axles = 2,
                       .primary_stiffness = 1.22e6,
                       .primary_damping = 4e3,
                       .carried = 8000.};
const CarData kCar{.bogie = {1307.5, 738., 906.5, 2.56, 2, 1.22e6, 4e3},
                   .body_mass = 16000.,
                   .body_inertia = 9.85e5,
                   .bogie_distance = 19.,
                   .secondary_stiffness = 4.3e5,
                   .secondary_damping = 2e4};

RunningVehicle on_springs(const Vehicle& vehicle, double start, double speed, double k, double c) {
  RunningVehicle v;
  v.vehicle = vehicle;
  v.start = start;
  v.speed = speed;
  v.contact = WheelContactKind::linear;
  v.stiffness = k;
  v.damping = c;
  return v;
}

}  // namespace

TEST_CASE("vehicles cross a beam from ground to ground as the modal solution says", "[vehicle]") {
  const Vehicle frame = bogie(kBogie).vehicle, whole = car(kCar).vehicle;
  struct Case {
    RunningVehicle vehicle;
    double until;
  };
  const Case cases[] = {{on_springs(point_mass(5750.).vehicle, -1., 30., 1595e3, 3e4), 27. / 30.},
                        {on_springs(frame, -2., 50., 1e8, 0.), 30. / 50.},
                        {on_springs(frame, -2., 50., 1e8, 1e5), 30. / 50.},
                        {on_springs(whole, -12., 60., 1e8, 1e5), 50. / 60.}};
  for (const Case& c : cases) {
    const Compared found = crossing(bridge(32), c.vehicle, 20, 2e-4, c.until);
    UNSCOPED_INFO("midspan " << found.midspan / found.largest_midspan << " of "
                             << found.largest_midspan << " body " << found.body / found.largest_body
                             << " of " << found.largest_body << " force "
                             << found.force / found.static_force << " of " << found.static_force);
    CHECK(found.midspan < 0.);
  }
}
