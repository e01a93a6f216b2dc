#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "offline/irregularity/defect.h"
#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "offline/start/start.h"
#include "online/math/pi.h"
#include "online/step/step.h"

using namespace railstep;

namespace {

constexpr double kRailMass = 150., kRailStiffness = 6e7, kRailDamping = 6e4;  // hard-cases.md, R5
constexpr double kWheelMass = 600., kLoad = 60e3;
constexpr double kMiddle = 300.;  // m

/// Rails that each move as one mass under a wheel near their middle: stiff bars 600 m long with a
/// seat at each end. A wheel at a distance e from the middle meets 12 (e / 600 m)^2 less of the
/// mass, 2e-4 at 2.5 m.
Track rigid_rails() {
  Track t;
  t.section = {.area = 1e6, .inertia_y = 1e12, .inertia_z = 1e12, .torsion = 1e12};
  t.unknowns = Unknowns::vertical;
  t.bays = 1;
  t.bay_length = 2. * kMiddle;
  t.elements_per_bay = 1;
  t.material.density = kRailMass / (t.section.area * t.bay_length);
  t.support.stiffness = {0., 0., kRailStiffness / 2.};
  t.support.damping = {0., 0., kRailDamping / 2.};
  return t;
}

/// A wheelset of two such wheels that starts in equilibrium.
Wheelset wheels(double start, double speed) {
  Wheelset w;
  w.mass = 2. * kWheelMass;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 2. * kLoad;
  w.start = start;
  w.speed = speed;
  return w;
}

struct Ride {
  Track track = rigid_rails();
  std::unique_ptr<PackedModel> packed;
  std::vector<double> memory, scratch;
  State state;
  Workspace workspace;
  Outputs outputs{};
  Status met = Status::ok;

  Ride(const Traffic& traffic, double dt) {
    packed = std::make_unique<PackedModel>(
        track, traffic,
        PackOptions{.scheme = generalised_alpha(dt, .6), .residual_flexibility = false});
    packed->set_start(start_in_equilibrium(track, *packed, 0.));
    memory.assign(static_cast<std::size_t>(state_doubles(model())), 0.);
    scratch.assign(static_cast<std::size_t>(workspace_doubles(model())), 0.);
    state = state_on(model(), memory.data());
    workspace = workspace_on(model(), scratch.data());
    reset(model(), state);
  }
  const Model& model() const { return packed->model(); }
  double time() const { return static_cast<double>(state.steps) * model().scheme.dt; }
  void step() { met = met | advance_frame(model(), state, workspace, outputs); }
};

struct Peak {
  double force, time, least;  // N, s, N: of the left wheel
};

Peak peak_of(Ride& ride, double until) {
  Peak peak{0., 0., 1e300};
  while (ride.time() < until) {
    ride.step();
    const double force = ride.outputs.contact_force[0];
    peak.least = std::min(peak.least, force);
    if (force > peak.force) peak = {force, ride.time(), peak.least};
    CHECK(ride.outputs.contact_force[1] == Approx(force).epsilon(1e-9));
  }
  return peak;
}

constexpr DefectGrid kFine = {2e-4, 0.};

/// A wheel passes a joint dipped by 10 mm with ramps of 1 m; time counts from the joint.
Peak over_dip(double speed, double dt) {
  const double start = kMiddle - 1.05;
  Traffic traffic{.wheelsets = {wheels(start, speed)}};
  for (const int rail : {0, 1})
    traffic.irregularities.push_back({rail, 2, dipped_joint(kMiddle, .01, 1., kFine)});
  Ride ride(traffic, dt);
  const double at_joint = 1.05 / speed;
  Peak before = peak_of(ride, at_joint);
  Peak peak = peak_of(ride, at_joint + 4e-3);
  peak.time -= at_joint;
  peak.least = std::min(peak.least, before.least);
  return peak;
}

/// A wheel passes on a rounded flat of 50 mm; time counts from the start of the flat.
Peak over_flat(double speed, double dt) {
  const double radius = .46, length = .05, half_turn = kPi * radius;
  const Signal flat = rounded_flat(radius, length, length * length / (16. * radius), {1e-4, 0.});
  Wheelset set = wheels(kMiddle - half_turn, speed);
  set.tread = {flat, flat};
  Ride ride(Traffic{.wheelsets = {set}}, dt);
  const double begins = (half_turn - .5 * length) / speed;
  static_cast<void>(peak_of(ride, begins));
  Peak peak = peak_of(ride, begins + 6e-3);
  peak.time -= begins;
  return peak;
}

}  // namespace

TEST_CASE(
    "R5: a wheel over a dipped joint meets the reference's peak, which Jenkins' formula bounds") {
  // R5 of hard-cases.md has 146.965 kN at 0.4745 ms past the joint, to 1e-6. The demand is 1 % at
  // 50 us and 1e-3 at 10 us.
  const Peak coarse = over_dip(10., 50e-6), fine = over_dip(10., 10e-6);
  CHECK(coarse.force == Approx(146.965e3).epsilon(1e-2));
  CHECK(fine.force == Approx(146.965e3).epsilon(1e-3));
  CHECK(fine.time == Approx(.4745e-3).margin(20e-6));
  CHECK(fine.least > 0.);  // it stays on the rail
  // Jenkins, Stephenson, Clayton, Morland and Lyon (1974): 2 alpha = 0.02, contact linear at P0.
  const double angle = .02, contact = 1.2151e9, both = kRailMass / kWheelMass;
  const double p1 = kLoad + angle * 10. * std::sqrt(contact * kRailMass / (1. + both));
  CHECK(p1 == Approx(136.4e3).epsilon(1e-3));
  CHECK(fine.force == Approx(p1).epsilon(.25));
  // At three times the speed it leaves the rail.
  CHECK(over_dip(30., 10e-6).least == 0.);
}

TEST_CASE("R5: behind the joint wheel and rail move down together with the force P2 of Jenkins") {
  constexpr double kStep = 20e-6, kSpeed = 10., kAhead = 1.05;
  Traffic traffic{.wheelsets = {wheels(kMiddle - kAhead, kSpeed)}};
  for (const int rail : {0, 1})
    traffic.irregularities.push_back({rail, 2, dipped_joint(kMiddle, .01, 1., kFine)});
  Ride ride(traffic, kStep);
  while (ride.time() < kAhead / kSpeed) ride.step();
  // The force's running mean from the joint on, over one oscillation of wheel against rail: 120 kg
  // on 1.2151e9 N/m. The oscillation on a nonlinear contact is longer and leaves a ripple of 3 %.
  const auto window = static_cast<std::size_t>(2. * kPi * std::sqrt(120. / 1.2151e9) / kStep);
  std::vector<double> force;
  double highest = 0.;
  while (ride.time() < kAhead / kSpeed + 12e-3) {
    ride.step();
    force.push_back(ride.outputs.contact_force[0]);
    if (force.size() < window) continue;
    double mean = 0.;
    for (std::size_t k = force.size() - window; k < force.size(); ++k)
      mean += force[k] / static_cast<double>(window);
    highest = std::max(highest, mean);
  }
  const double both = kWheelMass + kRailMass, stiff = kRailStiffness;
  const double p2 = kLoad + .02 * kSpeed * std::sqrt(kWheelMass / both) *
                                (1. - kRailDamping * kPi / (4. * std::sqrt(stiff * both))) *
                                std::sqrt(stiff * kWheelMass);
  CHECK(p2 == Approx(86.4e3).epsilon(1e-3));  // hard-cases.md, R5
  CHECK(highest == Approx(p2).epsilon(.05));
}

TEST_CASE("R5: a wheel flat meets the reference's peak at both speeds") {
  CHECK(over_flat(10., 50e-6).force == Approx(121.273e3).epsilon(1e-2));
  const Peak slow = over_flat(10., 10e-6);
  CHECK(slow.force == Approx(121.273e3).epsilon(1e-3));
  CHECK(over_flat(20., 50e-6).force == Approx(451.527e3).epsilon(1e-2));
  const Peak fast = over_flat(20., 10e-6);
  CHECK(fast.force == Approx(451.527e3).epsilon(1e-3));
  CHECK(fast.time == Approx(1.88605e-3).margin(10e-6));
  CHECK(fast.least == 0.);
}

TEST_CASE("a slow ride follows the irregularity of rail and tread") {
  // At 0.1 m/s over waves of 5 m accelerations are 1e-4 m/s2 and forces 0.1 N of 60 kN. Both rails
  // and both wheels have one shape: a wheelset that rolls would slide sideways without friction.
  const double amplitude = 1e-3, speed = .1;
  std::vector<double> samples(50);
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] = amplitude * std::sin(2. * 3.14159265358979323846 * static_cast<double>(k) / 50.);
  const Signal wave = fit_signal(samples, kMiddle, .1, true);
  Wheelset set = wheels(kMiddle, speed);
  set.tread[0] = set.tread[1] = out_of_round(.46, 1, 2e-4, {.01, 0.});
  Ride ride({.wheelsets = {set}, .irregularities = {{0, 2, wave}, {1, 2, wave}}}, 1e-3);
  const double* z = ride.state.u + ride.model().wheelset[0].first + 2;
  const auto lifted = [&](double rolled) {
    return signal_at(wave.model(), kMiddle + rolled).value +
           signal_at(set.tread[0].model(), rolled).value;
  };
  const double level = *z - lifted(0.);
  // At most 1.25 m from the middle, the bar sinks by 4 (e / 600 m)^2 more; 0.6 N are 1e-8 m.
  const double sunk = kLoad / kRailStiffness * 4. * std::pow(1.25 / 600., 2) + 1e-8;
  for (int k = 0; k < 12500; ++k) {  // a quarter of a wave
    ride.step();
    if (k % 500 != 499) continue;
    CHECK(*z - level == Approx(lifted(speed * ride.time())).margin(sunk));
    CHECK(ride.outputs.contact_force[0] == Approx(kLoad).margin(.6));
  }
  CHECK(lifted(1.25) > .7e-3);
  CHECK(ride.met == Status::ok);
}

TEST_CASE("irregularities of missing rails or directions are refused") {
  const Track track = rigid_rails();
  const PackOptions options{.scheme = generalised_alpha(1e-3, .6), .residual_flexibility = false};
  Traffic traffic{.wheelsets = {wheels(kMiddle, 1.)}};
  const Signal dip = dipped_joint(kMiddle, .01, 1., {.01, 0.});
  traffic.irregularities = {{2, 2, dip}};
  CHECK_THROWS_AS(PackedModel(track, traffic, options), std::invalid_argument);
  traffic.irregularities = {{0, 0, dip}};
  CHECK_THROWS_AS(PackedModel(track, traffic, options), std::invalid_argument);
  traffic.irregularities.assign(33, {0, 2, dip});
  CHECK_THROWS_AS(PackedModel(track, traffic, options), std::invalid_argument);
}
