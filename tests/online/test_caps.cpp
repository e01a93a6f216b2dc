// Caps of a model: each kind is tested at its cap against a second way to the same numbers, and one
// more is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/irregularity/spline.h"
#include "online/model/external_input.h"
#include "support/flanged.h"
#include "support/system_run.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Contains;

namespace {

Track two_rails(int bays) {
  Track t = one_rail(bays);
  t.rails = 2;
  return t;
}

/// Displacements of a track and its traffic some steps after rest.
std::vector<double> moved(const Track& track, const Traffic& traffic, int steps = 20) {
  PackOptions options = full_order(1e-3);
  ModelRun run = from_rest(track, traffic, options);
  for (int n = 0; n < steps; ++n) run.step();
  CHECK(!has(run.seen, Status::cap_reached));
  CHECK(!has(run.seen, Status::nonfinite_state));
  return {run.state.u, run.state.u + run.model().unknowns};
}

double largest(const std::vector<double>& a) {
  double most = 0.;
  for (const double x : a) most = std::max(most, std::abs(x));
  return most;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

void refused(const Track& track, const Traffic& traffic, const std::string& id) {
  CHECK_THROWS_WITH(PackedModel(track, traffic, full_order(1e-3)), Contains(id));
}

Signal dip(double depth) {
  std::vector<double> samples(41);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = -depth * (1. - std::cos(2. * M_PI * static_cast<double>(i) / 40.));
  return fit_signal(samples, 4., .02, false);
}

Traffic bogies(int count) {
  Traffic traffic;
  for (int i = 0; i < count; ++i) {
    const int pair = i / 2;
    traffic.vehicles.push_back(running(bogie(kBogie), 3. + 3. * pair, 20.));
    traffic.vehicles.back().rail = i % 2;
  }
  traffic.head = kHead;
  return traffic;
}

}  // namespace

TEST_CASE("loads up to their cap act as the sum of their forces", "[caps]") {
  const Track track = two_rails(20);
  Traffic many, few;
  for (int i = 0; i < kMaxLoads; ++i)
    many.loads.push_back({.rail = i % 2, .start = 5., .speed = 30., .stop = 99., .force = -1e3});
  for (int rail : {0, 1})
    few.loads.push_back(
        {.rail = rail, .start = 5., .speed = 30., .stop = 99., .force = -1e3 * kMaxLoads / 2});
  const std::vector<double> want = moved(track, few);
  CHECK(apart(moved(track, many), want) <= 1e-13 * largest(want));
  many.loads.push_back(many.loads[0]);
  refused(track, many, "32 [E-PACK-05]");
}

TEST_CASE("irregularities up to their cap act as their sum", "[caps]") {
  const Track track = two_rails(30);
  Traffic many = bogies(4), few = many;
  constexpr int kOfARail = kMaxSignals / 2;
  for (int i = 0; i < kMaxSignals; ++i)
    many.irregularities.push_back({i % 2, 2, dip(2e-3 / kOfARail)});
  for (int rail : {0, 1}) few.irregularities.push_back({rail, 2, dip(2e-3)});
  const std::vector<double> want = moved(track, few);
  CHECK(apart(moved(track, many), want) <= 1e-10 * largest(want));
  CHECK(apart(moved(track, bogies(4)), want) > 1e-3 * largest(want));  // the dip has an effect
  many.irregularities.push_back(many.irregularities[0]);
  refused(track, many, "32 [E-PACK-07]");
}

TEST_CASE("forces on a body up to their cap act as their sum", "[caps]") {
  const Track track = two_rails(20);
  Traffic many = bogies(2), few = many;
  for (RunningVehicle& v : many.vehicles)
    v.forces.assign(kMaxBodyForces, {.direction = 0, .table = {0., 0., .01, -1e4}});
  for (RunningVehicle& v : few.vehicles)
    v.forces = {{.direction = 0, .table = {0., 0., .01, -1e4 * kMaxBodyForces}}};
  const std::vector<double> want = moved(track, few);
  CHECK(apart(moved(track, many), want) <= 1e-12 * largest(want));
  many.vehicles[0].forces.push_back(many.vehicles[0].forces[0]);
  refused(track, many, "on a vehicle; expected at most 4 [E-PACK-13]");
}

TEST_CASE("wheels, vehicles and wheelsets beyond their caps are refused", "[caps]") {
  const Track track = two_rails(60);
  CHECK_NOTHROW(PackedModel(track, bogies(kMaxVehicles), full_order(1e-3)));
  Traffic one_more = bogies(kMaxVehicles);
  one_more.vehicles.push_back(running(point_mass(1.), 1., 0.));
  refused(track, one_more, "16 [E-PACK-40]");
  one_more = bogies(kMaxVehicles);
  one_more.vehicles.back() = running(car(kCar), 15., 0.);
  refused(track, one_more, "32 [E-PACK-16]");
  Traffic sets;
  sets.head = kFlangedHead;
  Track full = peers_pair(1);
  full.unknowns = Unknowns::full;
  full.support.roll_stiffness = 1e5;
  for (int i = 0; i < kMaxWheelsets; ++i) {
    sets.wheelsets.push_back(flanged_wheelset(5e7, 0.));
    sets.wheelsets.back().start = 2. + i;
  }
  const std::vector<Wheelset> at_cap = sets.wheelsets;
  CHECK_NOTHROW(PackedModel(full, sets, full_order(1e-3)));
  sets.wheelsets.push_back(sets.wheelsets[0]);
  refused(full, sets, "4 [E-PACK-11]");
  sets.wheelsets = at_cap;
  for (int i = 0; i < 8; ++i) sets.vehicles.push_back(running(bogie(kBogie), 4., 0.));
  CHECK_NOTHROW(PackedModel(full, sets, full_order(1e-3)));
  sets.vehicles.push_back(running(point_mass(1.), 4., 0.));
  refused(full, sets, "32 [E-PACK-16]");
}

TEST_CASE("heights at which vertical forces act are counted rail by rail", "[caps]") {
  Traffic traffic;
  for (int i = 0; i < kMaxLoadPoints; ++i)
    traffic.loads.push_back({.rail = 0, .start = 5., .stop = 99., .force = -1e3, .z = .01 * i});
  const Track track = one_rail(20);
  CHECK_NOTHROW(PackedModel(track, traffic, full_order(1e-3)));
  traffic.loads.push_back({.rail = 0, .start = 5., .stop = 99., .force = -1e3, .z = .09});
  refused(track, traffic, "4 [E-PACK-04]");
}

TEST_CASE("a track may split into as many lines as a model has room for", "[caps]") {
  // Under gravity each sleeper without pads is a line, two in mirror coordinates; the rails are
  // further lines.
  const auto hanging = [](int count) {
    Track t = s1_track(24, 1);
    t.unknowns = Unknowns::vertical;
    for (int i = 0; i < count; ++i) {
      Seat seat = t.seat(2 + i);
      for (Support& pad : seat.pad) pad = {};
      t.changed_seats[2 + i] = seat;
    }
    PackOptions options = full_order(1e-3);
    options.gravity = 9.81;
    return PackedModel(t, {.loads = {{.start = 5., .stop = 99., .force = -1e4}}}, options)
        .model()
        .lines;
  };
  int most = 0, count = 0;
  for (; count < 20 && most < kMaxLines; ++count) most = hanging(count);
  CHECK(most == kMaxLines);
  CHECK_THROWS_WITH(hanging(count), Contains("E-PACK-34"));
}

TEST_CASE("external wheels and inputs up to their caps act as the sum of each alone", "[caps]") {
  const Track track = two_rails(20);
  const auto displacement = [&](int pressing) {
    Traffic traffic;
    traffic.head = kHead;
    traffic.input_limits.assign(kMaxInputs - kExternalInputs * kMaxExternalWheels, 1e6);
    for (int i = 0; i < kMaxExternalWheels; ++i) traffic.external_wheels.push_back({i % 2, 1e6});
    ModelRun run(track, traffic, full_order(1e-3));
    REQUIRE(run.model().inputs == kMaxInputs);
    std::vector<double> input(kMaxInputs, 0.), u;
    for (int n = 0; n < 10; ++n) {
      for (int i = 0; i < kMaxExternalWheels; ++i) {
        double* const own = input.data() + run.model().external_wheel[i].input;
        own[kExternalX] = 2. + .5 * i + .02 * n;
        own[kExternalForce + 2] = pressing < 0 || pressing == i ? -2e4 - 1e3 * i : 0.;
      }
      CHECK(advance_frame(run.model(), input.data(), run.state, run.workspace, run.outputs) ==
            Status::ok);
    }
    return std::vector<double>(run.state.u, run.state.u + run.model().unknowns);
  };
  const std::vector<double> together = displacement(-1);
  std::vector<double> sum(together.size(), 0.);
  for (int i = 0; i < kMaxExternalWheels; ++i) {
    const std::vector<double> own = displacement(i);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += own[k];
  }
  CHECK(apart(together, sum) <= 1e-12 * largest(together));
  Traffic more;
  more.head = kHead;
  more.external_wheels.assign(kMaxExternalWheels + 1, {0, 1e6});
  refused(track, more, "16 [E-PACK-22]");
  more.external_wheels.assign(kMaxExternalWheels, {0, 1e6});
  more.input_limits.assign(kMaxInputs - kExternalInputs * kMaxExternalWheels + 1, 1e6);
  refused(track, more, "96 [E-PACK-28]");
}

TEST_CASE("bodies and rows up to their caps move as each pendulum does alone", "[caps]") {
  // Planar pendulums of different lengths, two rows each; a body without a joint falls.
  const auto pendulum = [](int i, std::vector<RigidBody>& bodies, std::vector<Joint>& joints) {
    const double length = .5 + .01 * i;
    RigidBody rod{.mass = 2., .position = {3. * i + length, 0., 0.}};
    rod.inertia = Eigen::Vector3d(.01, .17, .17).asDiagonal();
    bodies.push_back(rod);
    joints.push_back({.kind = JointKind::revolute,
                      .a = ground(),
                      .b = body(static_cast<int>(bodies.size()) - 1),
                      .point = {3. * i, 0., 0.}});
    joints.back().axis = Eigen::Vector3d::UnitY();
  };
  const SystemOptions options{.scheme = generalised_alpha(2e-3, .9)};
  System all{.planar = true};
  for (int i = 0; i < kMaxSystemParts; ++i) pendulum(i, all.bodies, all.joints);
  SystemRun run(all, options);
  REQUIRE(system_rows(run.model().system) == kMaxSystemRows);
  for (int n = 0; n < 3; ++n) run.frame();
  CHECK(run.seen == Status::ok);
  for (const int i : {0, 1, 100, kMaxSystemParts - 1}) {
    System alone{.planar = true};
    pendulum(i, alone.bodies, alone.joints);
    SystemRun one(alone, options);
    for (int n = 0; n < 3; ++n) one.frame();
    const Eigen::Vector3d fall = one.body_position(0) - alone.bodies[0].position;
    CHECK(fall.norm() > 1e-5);
    CHECK((run.body_position(i) - one.body_position(0)).norm() <= 1e-8 * fall.norm());
  }
  System more = all;
  more.bodies.push_back(more.bodies[0]);
  CHECK_THROWS_WITH(SystemRun(more, options), Contains("256") && Contains("E-SYSTEM-45"));
  more = all;
  more.joints.push_back(more.joints[0]);
  CHECK_THROWS_WITH(SystemRun(more, options), Contains("512") && Contains("E-SYSTEM-26"));
}
