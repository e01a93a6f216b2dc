// Vehicles in the step: what no reference is needed for, and the shipped scene.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numeric>
#include <string>
#include <vector>

#include "condensed.h"
#include "energy.h"
#include "offline/pack/start.h"
#include "offline/vehicle/kinds.h"
#include "simulate.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

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
constexpr double kBogieLoad = (1307.5 + 8000. + 2. * 906.5) * 9.81 / 2.;  // of a wheel, N

/// One rail of 60E1-like stiffness on seats each .6 m.
Track one_rail(int bays) {
  Track t;
  t.section = r60_section();
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = bays;
  t.bay_length = .6;
  t.elements_per_bay = 2;
  t.support.stiffness = {0., 0., 4e7};
  t.support.damping = {0., 0., 3e4};
  return t;
}

RunningVehicle running(const NamedVehicle& what, double start, double speed) {
  RunningVehicle v;
  v.vehicle = what.vehicle;
  v.start = start;
  v.speed = speed;
  return v;
}

ModelRun from_rest(const Track& track, const Traffic& traffic, const PackOptions& options) {
  auto packed = std::make_unique<PackedModel>(track, traffic, options);
  packed->set_start(start_in_equilibrium(track, *packed, 0.));
  return ModelRun(std::move(packed));
}

/// Of both kinds of model.
PackOptions options_of(bool modal, const Track& track, double dt) {
  return modal ? condensed(track, 2, dt) : full_order(dt);
}

}  // namespace

TEST_CASE("a vehicle at rest on a track stays at rest to rounding", "[vehicle]") {
  for (const bool modal : {false, true}) {
    const Track track = one_rail(50);
    ModelRun run = from_rest(track, {.vehicles = {running(car(kCar), 15.13, 0.)}, .head = {.0}},
                             options_of(modal, track, 1e-4));
    const std::vector<double> start = run.memory;
    const VehicleModel& v = run.model().vehicle[0];
    for (int i = 0; i < 1000; ++i) run.step();
    CHECK(run.seen == Status::ok);
    // Forces of 5e4 N rounded to 1e-16 of themselves, over the vehicle's softest stiffness, 4e5
    // N/m: 1e-17 m; the static solution's own rounding, with a condition of 1e8: 1e-8 of 1e-4 m.
    double moved = 0.;
    for (int k = 0; k < v.size; ++k)
      moved = std::max(
          moved, std::abs(run.state.u[v.first + k] - start[static_cast<std::size_t>(v.first + k)]));
    CAPTURE(modal);
    CHECK(moved < 1e-8 * start[static_cast<std::size_t>(4 * run.model().unknowns)] / 4.3e5);
    for (int i = 0; i < 4; ++i)
      CHECK_THAT(run.outputs.wheel_force[i],
                 WithinRel(start[static_cast<std::size_t>(4 * run.model().unknowns + i)], 1e-8));
  }
}

TEST_CASE("a bogie's wheels bear half its weight each, three axles what gives way", "[vehicle]") {
  for (const bool modal : {false, true}) {
    const Track track = one_rail(20);
    const ModelRun two = from_rest(track, {.vehicles = {running(bogie(kBogie), 5.3, 0.)}},
                                   options_of(modal, track, 1e-4));
    for (int i = 0; i < 2; ++i)  // moments about either wheel: the frame is in the middle
      CHECK_THAT(two.state.wheel_force[i], WithinRel(kBogieLoad, 1e-10));
    BogieData data = kBogie;
    data.axles = 3;
    const ModelRun three = from_rest(track, {.vehicles = {running(bogie(data), 6., 0.)}},
                                     options_of(modal, track, 1e-4));
    const double *f = three.state.wheel_force, weight = (1307.5 + 8000. + 3. * 906.5) * 9.81;
    CHECK_THAT(f[0] + f[1] + f[2], WithinRel(weight, 1e-10));
    CHECK_THAT(f[0], WithinRel(f[2], 1e-8));  // in the middle of a symmetric track
    // The middle one stands in the trough of the three and bears less; springs of 1.22e6 N/m over
    // a rail of some 2.5e7 leave a few percent.
    CHECK(f[1] < f[0]);
    CHECK(f[1] > .9 * f[0]);
  }
}

TEST_CASE("on rigid ground a vehicle swings at its own frequencies", "[vehicle]") {
  // Bounce of the car: body and frames, two masses on two springs (test_vehicle.cpp). The wheels
  // are bonded to the ground before the rail. The trapezoidal rule's phase after a period is 2 pi
  // (w dt)^2/12 off, its cosine the square of that.
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
    CHECK_THAT(q[0], WithinAbs(0., 1.1 * phase * start + 1e-9));  // bonds give way by 1e-10 m
    for (int i = steps / 4; i < steps; ++i) run.step();
    CHECK_THAT(q[0], WithinRel(start, 1e-6));
    CHECK_THAT(q[2], WithinRel(frame, 1e-6));
    CHECK(!run.outputs.wheel_on_rail[0]);
    CHECK(run.seen == Status::ok);  // the ground is no loss of contact
  }
}

TEST_CASE("a condensed track carries a bogie as the full one does", "[vehicle]") {
  // Forces over frames of 5 ms: of a rail's modes of 2 a bay the last has some 1.5 kHz, and what is
  // above rings otherwise (design: outputs of one band). 1e-3 of the static load.
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
      const double force = full.outputs.wheel_force_mean[wheel];
      error = std::max(error, std::abs(force - kept.outputs.wheel_force_mean[wheel]));
      swing = std::max(swing, std::abs(force - kBogieLoad));
    }
  }
  WARN(error / kBogieLoad);
  CHECK(swing > .01 * kBogieLoad);
  CHECK(error < 1e-3 * kBogieLoad);
}

TEST_CASE("a vehicle comes and goes without a jolt but the rail's end", "[vehicle]") {
  // A soft sprung mass from ground to ground over a track: its force never leaves the static one by
  // more than the springs feel of the rail's sag.
  for (const bool modal : {false, true}) {
    Track track = one_rail(20);
    track.ends = {RailEnd::pinned, RailEnd::pinned};
    RunningVehicle v = running(sprung_mass(4000., 200., 2e5, 1e4), -1.003, 20.);
    ModelRun run = from_rest(track, {.vehicles = {v}}, options_of(modal, track, 1e-4));
    const double load = 4200. * 9.81;
    CHECK_THAT(run.state.wheel_force[0], WithinRel(load, 1e-10));
    int on = 0, off = 0;
    while (run.time() < .8) {
      run.step();
      (run.outputs.wheel_on_rail[0] ? on : off) += 1;
      CHECK(std::isfinite(run.outputs.wheel_force[0]));
      if (!run.outputs.wheel_on_rail[0]) CHECK(run.outputs.wheel_rail_z[0] == 0.);
    }
    CHECK_THAT(on, WithinAbs(6000., 1.));
    CHECK(off > 0);
    double rest = 0.;  // of the track that it has left behind, .15 s later
    for (std::int32_t i = 0; i < run.model().bodies; ++i)
      rest = std::max(rest, std::abs(run.state.u[i]));
    WARN(modal << ' ' << rest);
    CHECK_THAT(run.outputs.wheel_force[0], WithinRel(load, .2));
  }
}

TEST_CASE("vehicles on two rails, wheelsets beside them, and the same bits again", "[vehicle]") {
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
    // Both rails carry the same: left and right of everything are alike.
    CHECK_THAT(run.outputs.wheel_force[2], WithinRel(run.outputs.wheel_force[4], 1e-9));
    CHECK_THAT(run.outputs.wheel_force[0], WithinRel(run.outputs.wheel_force[1], 1e-9));
    CHECK(run.outputs.wheel_force[2] > 1e4);
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
                    "more than 32 wheels of wheelsets and vehicles");
  traffic.vehicles.assign(17, running(point_mass(1.), 5., 0.));
  CHECK_THROWS_WITH(PackedModel(track, traffic, full_order(1e-4)), "more than 16 vehicles");
  traffic.vehicles.assign(1, running(point_mass(1.), 5., 0.));
  traffic.vehicles[0].rail = 1;
  CHECK_THROWS_AS(PackedModel(track, traffic, full_order(1e-4)), std::invalid_argument);
}

TEST_CASE("a vehicle that would lift a wheel has no equilibrium", "[vehicle]") {
  RunningVehicle v = running(bogie(kBogie), 5., 0.);
  v.vehicle.bodies[0].place = 2.;  // the frame's weight ahead of both wheels
  const Track track = one_rail(20);
  PackedModel packed(track, {.vehicles = {v}}, full_order(1e-4));
  CHECK_THROWS_WITH(start_in_equilibrium(track, packed, 0.),
                    "no equilibrium with all of a vehicle's wheels on the rail");
}

TEST_CASE("energy of vehicles is kept but for the scheme's loss", "[vehicle][energy]") {
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
    // Hertz contacts close to rounding (test_energy.cpp); linear ones keep their forces' place in
    // the residual flexibility from the step, where the account has them at its end: 1e-5.
    // Condensed: the trapezoidal quadrature of dissipation.
    CHECK(rest < (c.modal ? 1e-4 : c.contact == WheelContactKind::hertz ? 1e-7 : 1e-5));
    CHECK(energy.flow().dissipated > 0.);
  }
}

TEST_CASE("the bogie at speed beats with its sleepers and bears its weight", "[vehicle]") {
  // config/scenes/bogie_at_speed.toml: 80 m/s over bays of .6 m is 133.3 Hz.
  Simulation run(read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/bogie_at_speed.toml"));
  const Model& model = run.model();
  Outputs outputs{};
  const double dt = model.scheme.dt, bay = .6 / 80.;
  const int per_bay = static_cast<int>(std::lround(bay / dt));  // steps
  REQUIRE(per_bay == 150);
  Model fine = model;
  fine.steps_per_frame = 1;
  std::vector<double> force[2];
  for (std::int64_t i = 0; i < model.steps; ++i) {
    REQUIRE(advance_frame(fine, run.state, run.workspace, outputs) == Status::ok);
    for (std::size_t k = 0; k < 2; ++k) force[k].push_back(outputs.wheel_force[k]);
  }
  // The last 15 bays, a fourth of the way: means are the static loads, as the frame no longer falls
  // or rises: its bounce has sqrt(2 1.22e6/1307.5)/2 pi = 6.9 Hz and a damping ratio of .07, e^-...
  const int from = static_cast<int>(model.steps) - 15 * per_bay;
  for (const std::vector<double>& f : force) {
    const double mean = std::accumulate(f.begin() + from, f.end(), 0.) / (15. * per_bay);
    std::complex<double> line[4] = {};
    for (int i = from; i < model.steps; ++i)
      for (int n = 1; n < 4; ++n)
        line[n] += 2. / (15. * per_bay) * (f[static_cast<std::size_t>(i)] - mean) *
                   std::polar(1., -2. * M_PI * n * (i - from) / per_bay);
    double swing = 0.;
    for (int i = from; i < model.steps; ++i)
      swing += std::pow(f[static_cast<std::size_t>(i)] - mean, 2);
    swing = std::sqrt(2. * swing / (15. * per_bay));
    WARN("mean " << mean / kBogieLoad << " lines " << std::abs(line[1]) << " " << std::abs(line[2])
                 << " " << std::abs(line[3]) << " all " << swing);
  }
}
