// Vehicles in the step: tests that need no reference, and the shipped scene.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numeric>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "run/simulate.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kBogieLoad = (1307.5 + 8000. + 2. * 906.5) * 9.81 / 2.;  // per wheel, N

}  // namespace

TEST_CASE("a vehicle at rest on a track stays at rest to rounding", "[vehicle]") {
  for (const bool modal : {false, true}) {
    const Track track = one_rail(50);
    ModelRun run = from_rest(track, {.vehicles = {running(car(kCar), 15.13, 0.)}, .head = {.0}},
                             options_of(modal, track, 1e-4));
    std::vector<double> start = run.memory;
    const State before = state_on(run.model(), start.data());
    const SuspendedModel& v = run.model().vehicle[0];
    for (int i = 0; i < 1000; ++i) run.step();
    CHECK(run.seen == Status::ok);
    // With K's condition of 1e8 wheel forces at the start differ by 1e-8 from those of the step.
    // These move the body on its softest springs, 4.3e5 N/m.
    double moved = 0.;
    for (int k = 0; k < v.size; ++k)
      moved = std::max(moved, std::abs(run.state.u[v.first + k] - before.u[v.first + k]));
    CAPTURE(modal);
    CHECK(moved < 1e-8 * before.contact_force[0] / 4.3e5);
    for (int i = 0; i < 4; ++i)
      CHECK_THAT(run.outputs.contact_force[i], WithinRel(before.contact_force[i], 1e-8));
  }
}

TEST_CASE("each wheel of a bogie bears half its weight, and on three axles the springs share it",
          "[vehicle]") {
  for (const bool modal : {false, true}) {
    const Track track = one_rail(20);
    const ModelRun two = from_rest(track, {.vehicles = {running(bogie(kBogie), 5.3, 0.)}},
                                   options_of(modal, track, 1e-4));
    for (int i = 0; i < 2; ++i)  // moments about either wheel: the frame is in the middle
      CHECK_THAT(two.state.contact_force[i], WithinRel(kBogieLoad, 1e-10));
    BogieData data = kBogie;
    data.axles = 3;
    const ModelRun three = from_rest(track, {.vehicles = {running(bogie(data), 6., 0.)}},
                                     options_of(modal, track, 1e-4));
    const double *f = three.state.contact_force, weight = (1307.5 + 8000. + 3. * 906.5) * 9.81;
    CHECK_THAT(f[0] + f[1] + f[2], WithinRel(weight, 1e-10));
    CHECK_THAT(f[0], WithinRel(f[2], 1e-8));  // in the middle of a symmetric track
    // The middle wheel stands in the trough of the three and bears less. Springs of 1.22e6 N/m over
    // a rail of some 2.5e7 leave a few percent.
    CHECK(f[1] < f[0]);
    CHECK(f[1] > .9 * f[0]);
  }
}

TEST_CASE("on rigid ground a vehicle oscillates at its own frequencies", "[vehicle]") {
  // Bounce of the car: body and frames are two masses on two springs (test_vehicle.cpp). The wheels
  // are bonded to the ground ahead of the rail. After a period the phase of the trapezoidal rule
  // errs by 2 pi (w dt)^2/12, its cosine by the square of that.
  CarData undamped = kCar;
  undamped.bogie.primary_damping = undamped.secondary_damping = 0.;
  for (const bool modal : {false, true}) {
    const double u = 8000., l = 1307.5, k = 4.3e5, under = 2.44e6;
    const double b = k / u + (k + under) / l, c = k * under / (u * l);
    const double w2 = .5 * b - std::sqrt(.25 * b * b - c), w = std::sqrt(w2);
    const int steps = 2000;
    const double dt = 2. * M_PI / w / steps;
    RunningVehicle v = running(car(undamped), -100., 0.);
    v.contact = WheelContactKind::bonded;
    v.gravity = 0.;
    const Track track = one_rail(4);
    PackOptions options = options_of(modal, track, dt);
    options.scheme = modal ? held_force(dt, 1.) : generalised_alpha(dt, 1.);
    ModelRun run(track, {.vehicles = {v}}, options);
    double* q = run.state.u + run.model().vehicle[0].first;
    const double start = 1e-2, frame = start * (k - u * w2) / k;
    q[0] = start;
    q[2] = q[4] = frame;
    double* g = run.state.g + run.model().vehicle[0].first;
    double* a = run.state.a + run.model().vehicle[0].first;
    for (const int i : {0, 2, 4}) g[i] = a[i] = -w2 * q[i];
    for (int i = 0; i < steps / 4; ++i) run.step();
    CAPTURE(modal);
    const double phase = .5 * M_PI * std::pow(w * dt, 2) / 12.;
    CHECK_THAT(q[0], WithinAbs(0., 1.1 * phase * start + 1e-9));  // bonds yield by 1e-10 m
    for (int i = steps / 4; i < steps; ++i) run.step();
    CHECK_THAT(q[0], WithinRel(start, 1e-6));
    CHECK_THAT(q[2], WithinRel(frame, 1e-6));
    CHECK(!run.outputs.contact_on_rail[0]);
    CHECK(run.seen == Status::ok);  // the ground is not a loss of contact
  }
}

TEST_CASE("a condensed track carries a bogie as the full one does", "[vehicle]") {
  // Forces are means over frames of 5 ms. With 2 modes per bay a rail's last mode is at 1.5 kHz,
  // and motion above differs (design: outputs of one band). Bound: 1e-3 of the static load.
  const Track track = one_rail(30);
  const Traffic traffic{.vehicles = {running(bogie(kBogie), 4., 20.)}};
  PackOptions options[2] = {options_of(false, track, 1e-4), options_of(true, track, 1e-4)};
  for (PackOptions& o : options) o.steps_per_frame = 50;
  ModelRun full = from_rest(track, traffic, options[0]);
  ModelRun kept = from_rest(track, traffic, options[1]);
  double error = 0., swing = 0.;
  for (int i = 0; i < 80; ++i) {
    full.step();
    kept.step();
    for (int wheel = 0; wheel < 2; ++wheel) {
      const double force = full.outputs.contact_force_mean[wheel];
      error = std::max(error, std::abs(force - kept.outputs.contact_force_mean[wheel]));
      swing = std::max(swing, std::abs(force - kBogieLoad));
    }
  }
  CHECK(swing > .01 * kBogieLoad);
  CHECK(error < 1e-3 * kBogieLoad);
}

TEST_CASE("a vehicle comes and goes without a jolt except at the rail's end", "[vehicle]") {
  // A soft sprung mass goes from ground to ground over a track. Its force differs from the static
  // one only by the springs' force from the rail's sag.
  for (const bool modal : {false, true}) {
    Track track = one_rail(20);
    track.ends = {RailEnd::pinned, RailEnd::pinned};
    RunningVehicle v = running(sprung_mass(4000., 200., 2e5, 1e4), -1.003, 20.);
    ModelRun run = from_rest(track, {.vehicles = {v}}, options_of(modal, track, 1e-4));
    const double load = 4200. * 9.81;
    CHECK_THAT(run.state.contact_force[0], WithinRel(load, 1e-10));
    int on = 0, off = 0;
    while (run.time() < .8) {
      run.step();
      (run.outputs.contact_on_rail[0] ? on : off) += 1;
      CHECK(std::isfinite(run.outputs.contact_force[0]));
      if (!run.outputs.contact_on_rail[0]) CHECK(run.outputs.contact_rail_z[0] == 0.);
    }
    CHECK_THAT(on, WithinAbs(6000., 1.));
    CHECK(off > 0);
    // The track behind it has decayed with some 400 1/s over 60 time constants, to nothing.
    const Configuration standing{run.state.u, {run.state.u, run.state.v}};
    double rest = 0.;
    for (std::int32_t e = 0; e < run.model().elements; ++e)
      rest = std::max(rest, std::abs(axis_height(run.model(), 0, e, 0., standing)));
    CHECK(rest < 1e-7);
    CHECK_THAT(run.outputs.contact_force[0], WithinRel(load, .2));
  }
}

TEST_CASE("vehicles on two rails run beside wheelsets and give the same bits again", "[vehicle]") {
  const auto hash_of = [](int steps_per_frame) {
    Wheelset w;
    w.mass = 1200.;
    w.inertia_roll = w.inertia_yaw = 700.;
    w.inertia_spin = 100.;
    w.weight = 9e4;
    w.start = 1.5;
    w.speed = 20.;
    Traffic traffic{.wheelsets = {w}, .head = kHead};
    for (const int rail : {0, 1}) {
      traffic.vehicles.push_back(running(bogie(kBogie), 3.4, 20.));
      traffic.vehicles.back().rail = rail;
    }
    Track track = paper_track();
    track.bays = 6;
    PackOptions options = full_order(1e-4);
    options.steps_per_frame = steps_per_frame;
    ModelRun run = from_rest(track, traffic, options);
    while (run.state.steps < 400) run.step();
    // Both rails carry the same load: left and right are equal everywhere.
    CHECK_THAT(run.outputs.contact_force[2], WithinRel(run.outputs.contact_force[4], 1e-9));
    CHECK_THAT(run.outputs.contact_force[0], WithinRel(run.outputs.contact_force[1], 1e-9));
    CHECK(run.outputs.contact_force[2] > 1e4);
    return state_hash(run.model(), run.state);
  };
  CHECK(hash_of(1) == hash_of(1));
  CHECK(hash_of(1) == hash_of(10));
}

TEST_CASE("more vehicles than a model has room for are refused", "[vehicle]") {
  const Track track = one_rail(20);
  Traffic traffic;
  for (int i = 0; i < 5; ++i) traffic.vehicles.push_back(running(car(kCar), 5., 0.));
  CHECK_NOTHROW(PackedModel(track, traffic, full_order(1e-4)));
  for (int i = 0; i < 4; ++i) traffic.vehicles.push_back(running(car(kCar), 5., 0.));
  CHECK_THROWS_WITH(PackedModel(track, traffic, full_order(1e-4)),
                    Catch::Contains("32 [E-PACK-16]"));
  traffic.vehicles.assign(17, running(point_mass(1.), 5., 0.));
  CHECK_THROWS_WITH(PackedModel(track, traffic, full_order(1e-4)),
                    Catch::Contains("16 [E-PACK-40]"));
  traffic.vehicles.assign(1, running(point_mass(1.), 5., 0.));
  traffic.vehicles[0].rail = 1;
  CHECK_THROWS_AS(PackedModel(track, traffic, full_order(1e-4)), std::invalid_argument);
}

TEST_CASE("a vehicle that would lift a wheel has no equilibrium", "[vehicle]") {
  RunningVehicle v = running(bogie(kBogie), 5., 0.);
  v.vehicle.bodies[0].place = 2.;  // the frame's weight is ahead of both wheels
  const Track track = one_rail(20);
  PackedModel packed(track, {.vehicles = {v}}, full_order(1e-4));
  CHECK_THROWS_WITH(start_in_equilibrium(track, packed, 0.), Catch::Contains("E-START-10"));
}

TEST_CASE("vehicles keep their energy except for the scheme's loss", "[vehicle][energy]") {
  struct Case {
    bool modal;
    WheelContactKind contact;
    double damping;
  };
  for (const Case& c : {Case{false, WheelContactKind::hertz, 0.},
                        {false, WheelContactKind::linear, 1e5},
                        {false, WheelContactKind::bonded, 0.},
                        {true, WheelContactKind::hertz, 0.},
                        {true, WheelContactKind::linear, 1e5}}) {
    const Track track = one_rail(30);
    RunningVehicle v = running(bogie(kBogie), 4., 60.);
    v.contact = c.contact;
    v.stiffness = 1e9;
    v.damping = c.damping;
    PackOptions options = options_of(c.modal, track, 5e-5);
    ModelRun run = from_rest(track, {.vehicles = {v}}, options);
    run.state.v[run.model().vehicle[0].first] -= .05;  // a kick on the frame
    EnergyAccount energy(*run.packed, run.model(), run.state);
    for (int i = 0; i < 2000; ++i) {
      run.step();
      energy.follow(run.state);
    }
    const double rest = std::abs(energy.imbalance() + energy.flow().loss) / energy.turned_over();
    CAPTURE(c.modal, static_cast<int>(c.contact), rest);
    // With Hertz contacts the balance closes to rounding (test_energy.cpp). Linear ones take the
    // place of their forces in the residual flexibility from the step, but the account takes that
    // at its end: 1e-5. Condensed runs err by the trapezoidal quadrature of dissipation.
    CHECK(rest < (c.modal ? 1e-4 : c.contact == WheelContactKind::hertz ? 1e-7 : 1e-5));
    CHECK(energy.flow().dissipated > 0.);
  }
}

TEST_CASE("a wheel that goes back and forth over bays adds no energy", "[vehicle][energy]") {
  // A mass on a Hertz contact goes 2.2 m back and forth 20 times on rails on springs without
  // dampers. The stored energy less the work of the drive stays below the start but for the error
  // of the contact's frozen geometry, 1e-6 of the energy turned over in a crossing.
  Track track = one_rail(30);
  track.sleeper.reset();
  track.support.stiffness = {0., 0., 3e7};
  track.support.damping = {};
  std::vector<double> zigzag = {0., 20.};
  for (int turn = 1; turn <= 40; ++turn) {
    const double t = .11 * turn, v = turn % 2 == 0 ? 20. : -20.;
    zigzag.insert(zigzag.end(), {t - 1e-3, -v, t + 1e-3, v});
  }
  for (const bool modal : {false, true}) {
    RunningVehicle v = running(point_mass(600.), 7.9, 0.);
    v.speeds = zigzag;
    PackOptions options = options_of(modal, track, 1e-4);
    ModelRun run = from_rest(track, {.vehicles = {v}}, options);
    run.state.v[run.model().vehicle[0].first] -= .05;
    EnergyAccount energy(*run.packed, run.model(), run.state);
    double most = 0., turned = 0.;
    for (int i = 0; i < 40'000; ++i) {
      run.step();
      energy.follow(run.state);
      most = std::max(most, energy.imbalance());
      if (i == 1000) turned = energy.turned_over();
    }
    CAPTURE(modal, most, turned, energy.imbalance());
    CHECK(most < 1e-6 * turned);
    CHECK(energy.imbalance() < 0.);  // the scheme's own loss
  }
}

namespace {

/// A run of the scene, step by step: forces of both wheels, and their sum by the bodies' vertical
/// momentum.
struct BogieRun {
  std::vector<double> force[2];  // N
  std::vector<double> momentum;  // of all bodies, upwards, kg m/s
  std::vector<double> frame;     // height above the mean of the wheels, m
  double dt;

  explicit BogieRun(const std::vector<std::string>& changes) {
    Simulation run(
        read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/bogie_at_speed.toml", changes));
    Model model = run.model();
    model.steps_per_frame = 1;
    dt = model.scheme.dt;
    Outputs outputs{};
    const SuspendedModel& v = model.vehicle[0];
    for (std::int64_t i = 0; i < model.steps; ++i) {
      REQUIRE(advance_frame(model, run.state, run.workspace, outputs) == Status::ok);
      for (std::size_t k = 0; k < 2; ++k) force[k].push_back(outputs.contact_force[k]);
      const double *u = run.state.u + v.first, *speed = run.state.v + v.first;
      momentum.push_back(v.mass[0] * speed[0] + v.mass[2] * speed[2] + v.mass[3] * speed[3]);
      frame.push_back(u[0] - .5 * (u[2] + u[3]));
    }
  }
};

/// Amplitude at a frequency of values at steps dt, from the index `from` on.
double amplitude(const std::vector<double>& f, std::size_t from, double frequency, double dt) {
  std::complex<double> sum = 0.;
  for (std::size_t i = from; i < f.size(); ++i)
    sum += f[i] * std::polar(1., -2. * M_PI * frequency * dt * static_cast<double>(i));
  return 2. * std::abs(sum) / static_cast<double>(f.size() - from);
}

}  // namespace

TEST_CASE("the force of the bogie at speed swings with the sleepers and bears its weight",
          "[vehicle]") {
  // bogie_at_speed.toml in config/scenes: 80 m/s over bays of .6 m are 133.3 Hz, 150 steps a bay.
  const BogieRun run({});
  REQUIRE(run.dt == 5e-5);
  const std::size_t all = run.momentum.size(), from = all - 15 * 150;
  // By Newton, impulses less the weight are the change of momentum. The trapezoidal rule over the
  // forces' harmonics errs by (2 pi/150)^2/12 = 1.5e-4 of their amplitudes' 4 %.
  double impulse = 0.;
  for (std::size_t i = from; i + 1 < all; ++i)
    for (const std::vector<double>& f : run.force) impulse += .5 * run.dt * (f[i] + f[i + 1]);
  const double time = run.dt * static_cast<double>(all - 1 - from);
  const double weight = 2. * kBogieLoad * time;
  CHECK_THAT(impulse - weight,
             WithinAbs(run.momentum[all - 1] - run.momentum[from], 1e-5 * weight));
  // The springs bear the frame and its carried mass, (8000 + 1307.5) g over two of 1.22e6 N/m. The
  // rest of the bounce from the start is a thousandth.
  const double sag =
      std::accumulate(run.frame.begin() + static_cast<std::ptrdiff_t>(from), run.frame.end(), 0.) /
      static_cast<double>(all - from);
  CHECK_THAT(sag, WithinRel(-9307.5 * 9.81 / 2.44e6, 1e-3));
  for (const std::vector<double>& f : run.force) {
    // Over 15 whole bays the harmonics of the passing frequency are lines and hold the force's
    // swing. Other oscillations, with the frame's bounce, are a twentieth.
    double swing = 0., lines = 0.;
    const double mean =
        std::accumulate(f.begin() + static_cast<std::ptrdiff_t>(from), f.end(), 0.) /
        static_cast<double>(all - from);
    for (std::size_t i = from; i < all; ++i)
      swing += 2. * (f[i] - mean) * (f[i] - mean) / static_cast<double>(all - from);
    for (int n = 1; n < 4; ++n) lines += std::pow(amplitude(f, from, n * 80. / .6, run.dt), 2);
    const double first = amplitude(f, from, 80. / .6, run.dt);
    CHECK(lines > .95 * swing);
    CHECK(first > 2. * amplitude(f, from, 2. * 80. / .6, run.dt));
    // Between the lines there is almost nothing.
    CHECK(amplitude(f, from, 1.4 * 80. / .6, run.dt) < .02 * first);
  }
}

TEST_CASE("the energies of the bogie balance, banded and condensed", "[vehicle][energy]") {
  for (const char* kind : {"full", "modal"}) {
    const Simulation run(
        read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/bogie_at_speed.toml",
                   {std::string("condense.kind=\"") + kind + "\"", "step.duration_s=0.02"}));
    const EnergyBalance balance = balance_of(*run.packed(), run.model(), 40);
    CAPTURE(kind, balance.numerical_loss);
    CHECK(balance.error < 1e-3);  // the bound of a shipped scene
    CHECK(balance.error > 0.);
  }
}
