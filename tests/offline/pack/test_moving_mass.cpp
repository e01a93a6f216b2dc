// Masses and vehicles that run over a pinned beam: figures of hard-cases.md, and modal solutions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/irregularity/defect.h"
#include "offline/pack/time_schemes.h"
#include "support/crossing.h"
#include "support/model_run.h"
#include "support/sections.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// R4 of hard-cases.md: section F, 6 m; the mass is half the beam's.
Track bending_rail(int elements) {
  BeamSection f = section_f();
  f.shear_factor_z = .472;
  return pinned_beam(f, {}, 6., elements);
}
constexpr double kMass = 204.885;  // kg

/// Yang and Yau's bridge. A = 1e4 m2 makes it Euler and Bernoulli's beam (test_fryba.cpp).
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

/// Deflection of the middle, positive down, m: a node for an even number of elements.
double midspan(const ModelRun& run) {
  const LineModel& line = run.model().line[0];
  return -run.state.u[line.first + line.unknown_of[0][27 * (run.model().elements / 2) + 2]];
}

struct Largest {
  double value = 0., at = 0.;
  void note(double w, double t) {
    if (w > value) *this = {w, t};
  }
};

}  // namespace

TEST_CASE("a mass bonded to the beam under it has the figures of the series", "[vehicle]") {
  // R4 and H15 of hard-cases.md: 5e-4 of the largest deflection. The mass comes from the ground.
  const int steps = 6000;
  const double speed = 30.;
  ModelRun run = from_rest(bending_rail(32), {.vehicles = {one_mass(kMass, -.1 * 6., speed)}},
                           {.scheme = generalised_alpha(6. / speed / steps, .6)});
  const double printed[] = {9.2547e-4, 1.0686e-3, 9.3573e-4, -2.45e-5};  // at quarters of the way
  Largest largest;
  for (int i = 1; i <= steps + steps / 10; ++i) {
    run.step();
    const int on = i - steps / 10;
    largest.note(midspan(run), static_cast<double>(on) / steps);
    if (on > 0 && on % (steps / 4) == 0)
      CHECK_THAT(midspan(run), WithinAbs(printed[on / (steps / 4) - 1], 5e-4 * 1.1188e-3));
  }
  CHECK_THAT(largest.value, WithinRel(1.11880e-3, 5e-4));
  CHECK_THAT(largest.at, WithinAbs(.357, 1e-3));
}

TEST_CASE("Yang and Yau's sprung mass has its figure", "[vehicle]") {
  // R4 of hard-cases.md has a maximum of 2.4073e-3 at .4123, printed to five and four digits.
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

/// Largest differences between a run and its modal solution, in a crossing from ground to ground.
struct Compared {
  double midspan = 0., force = 0., body = 0.;  // largest difference: m, N, m
  double largest_midspan = 0., static_force = 0., largest_body = 0.;
};

/// @param rough  height of the head above the beam, m
Compared crossing(const Track& beam, const RunningVehicle& v, int modes, double dt, double until,
                  const Signal& rough = {}) {
  ModelRun run = from_rest(beam, {.vehicles = {v}, .irregularities = {{0, 2, rough}}},
                           {.scheme = generalised_alpha(dt, 1.)});
  const double k = v.contact == WheelContactKind::linear ? v.stiffness : 1e10;
  ModalCrossing exact(beam, modes, v.vehicle, v.start, v.speed, k, v.damping);
  exact.rough = rough.model();
  Compared c;
  c.static_force = run.state.contact_force[0];
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
      c.force = std::max(c.force, std::abs(run.outputs.contact_force[i] - force[i]));
  }
  return c;
}

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

TEST_CASE("vehicles cross a beam from ground to ground as in the modal solution", "[vehicle]") {
  const Vehicle frame = bogie(kBogie).vehicle, whole = car(kCar).vehicle;
  struct Case {
    RunningVehicle vehicle;
    double until;
  };
  const Case cases[] = {
      {on_springs(point_mass(5750.).vehicle, -1.003, 30., 1595e3, 3e4), 27. / 30.},
      {on_springs(frame, -2.003, 50., 1e8, 0.), 30. / 50.},
      {on_springs(frame, -2.003, 50., 1e8, 1e5), 30. / 50.},
      {on_springs(whole, -12.003, 60., 1e8, 1e5), 50. / 60.}};
  for (const Case& c : cases) {
    const Compared found = crossing(bridge(32), c.vehicle, 20, 2e-4, c.until);
    CAPTURE(c.vehicle.vehicle.wheels.size(), c.vehicle.damping);
    // Both take the trapezoidal rule with the same steps. The mesh errs by 2e-4 of the largest
    // (test_fryba.cpp); the forces, which depend on its slopes, by H15's 5e-4 of the static force.
    CHECK(found.midspan < 2e-4 * found.largest_midspan);
    CHECK(found.body < 2e-4 * found.largest_body);
    CHECK(found.force < 5e-4 * found.static_force);
  }
}

TEST_CASE("vehicles cross a beam with a rough head as in the modal solution", "[vehicle]") {
  // Waves of 3 m and 2 mm under a bogie at 30 m/s have 10 Hz, between its bounce and its wheels.
  // They move the frame by a thousand times the tolerance, which is that above.
  const Signal waves = corrugation(2., 23., 3., 2e-3, {.05});
  for (const double damping : {0., 1e5}) {
    const RunningVehicle v = on_springs(bogie(kBogie).vehicle, -2.003, 30., 1e8, damping);
    const Compared even = crossing(bridge(32), v, 20, 2e-4, 30. / 30.);
    const Compared found = crossing(bridge(32), v, 20, 2e-4, 30. / 30., waves);
    CAPTURE(damping, found.force / found.static_force, found.body / found.largest_body);
    CHECK(found.largest_body - even.largest_body > 1e-3);
    CHECK(found.midspan < 2e-4 * found.largest_midspan);
    CHECK(found.body < 2e-4 * found.largest_body);
    CHECK(found.force < 5e-4 * found.static_force);
  }
}

namespace {

/// A moving mass by its modes: (1 + M phi phi') q'' + 2 v M phi phi_x' q' + (w^2 + v^2 M phi
/// phi_xx') q = -M g phi, phi at v t.
double largest_of_bonded(const Track& beam, double mass, double speed, int count, int steps) {
  const PinnedModes modes(beam, count);
  const Eigen::Index n = modes.count();
  Newmark run{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  const double dt = modes.length / speed / steps;
  double largest = 0.;
  for (int i = 1; i <= steps; ++i) {
    const double x = speed * i * dt;
    const Eigen::VectorXd phi = modes.at(x), slope = modes.at(x, 1), bent = modes.at(x, 2);
    const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(n, n) + mass * phi * phi.transpose();
    const Eigen::MatrixXd C = 2. * speed * mass * phi * slope.transpose();
    Eigen::MatrixXd K = speed * speed * mass * phi * bent.transpose();
    K.diagonal() += modes.squares();
    run.step(M, C, K, -mass * 9.81 * phi, dt);
    largest = std::max(largest, -modes.at(.5 * modes.length).dot(run.u));
  }
  return largest;
}

double largest_of_run(double speed, int elements, int steps, double rho = .6) {
  ModelRun run = from_rest(bending_rail(elements), {.vehicles = {one_mass(kMass, -.6, speed)}},
                           {.scheme = generalised_alpha(6. / speed / steps, rho)});
  double largest = 0.;
  for (int i = 1; i <= steps + steps / 10; ++i) {
    run.step();
    largest = std::max(largest, midspan(run));
  }
  return largest;
}

}  // namespace

TEST_CASE("a bonded mass agrees with the series at half the critical speed too", "[vehicle]") {
  for (const double speed : {30., 100.})
    CHECK_THAT(largest_of_run(speed, 32, 6000),
               WithinRel(largest_of_bonded(bending_rail(2), kMass, speed, 15, 2000), 5e-4));  // H15
}

TEST_CASE("a bonded mass converges with the mesh as the kinks in its way do", "[vehicle]") {
  // With residual flexibility the deflection under the mass is right to h^3 (test_fryba.cpp); half
  // an order is for other errors.
  const double fine = largest_of_run(30., 128, 24000);
  const double coarse = std::abs(largest_of_run(30., 4, 24000) - fine),
               finer = std::abs(largest_of_run(30., 8, 24000) - fine);
  CHECK(std::log2(coarse / finer) > 2.5);
}

TEST_CASE("a sprung mass converges with the second order of the step", "[vehicle]") {
  // This is the middle at one time, on one mesh. The mass comes from the ground, so that no load
  // appears suddenly except its kink of the slope. The steps resolve the mesh's fifth mode, which
  // that kink and the elements' borders excite; a quarter is for higher modes. There is no residual
  // flexibility, which on a section of 1e4 m2 is the rounding of its shear.
  const auto at = [](int steps) {
    RunningVehicle v = one_mass(5750., -2.5, 25.);
    v.contact = WheelContactKind::linear;
    v.stiffness = 1595e3;
    v.damping = 3e4;
    ModelRun run =
        from_rest(bridge(8), {.vehicles = {v}},
                  {.scheme = generalised_alpha(.5 / steps, .6), .residual_flexibility = false});
    run.until(.5);
    CHECK(run.seen == Status::ok);
    return midspan(run);
  };
  const double fine = at(51200);
  const double order = std::log2(std::abs(at(1600) - fine) / std::abs(at(6400) - fine)) / 2.;
  CHECK_THAT(order, WithinAbs(2., .25));
}
