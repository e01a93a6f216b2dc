// A start in equilibrium under wheelsets is a state that the step keeps, with its contacts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/flanged.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// The paper's rails; the right one has seats of another stiffness.
Track unequal_track(double softer) {
  Track t;
  t.section = section_f();
  t.bays = 4;
  t.bay_length = 1.6;
  t.rail_spacing = 1.;
  t.support.stiffness = {3e6, 14e6, 6e6};
  t.support.damping = {3e4, 3e4, 3e4};
  t.support.roll_stiffness = 1e6;
  t.support.roll_damping = 1e3;
  t.right = t.bar(0);
  for (int seat = 0; seat <= t.bays; ++seat) {
    Seat own = t.seat(seat);
    own.pad[1].stiffness[2] /= softer;
    t.changed_seats[seat] = own;
  }
  return t;
}

struct Named {
  std::string name;
  PackOptions options;
};

std::vector<Named> all_schemes(const Track& track, double dt) {
  return {{"generalised-alpha 0.6", full_order(dt)},
          {"generalised-alpha 0", full_order(dt, 0.)},
          {"generalised-alpha 1", full_order(dt, 1.)},
          {"Newmark", {.scheme = newmark(dt)}},
          {"HHT", {.scheme = hilber_hughes_taylor(dt, -.1)}},
          {"backward Euler", {.scheme = backward_euler(dt)}},
          {"TR-BDF2", {.scheme = tr_bdf2(dt)}},
          {"held", condensed(track, 3., dt)},
          {"held 1", condensed(track, 3., dt, 1.)},
          {"held mean",
           {.scheme = held_mean_force(dt), .reduction = condensed(track, 3., dt).reduction}}};
}

}  // namespace

TEST_CASE("a wheelset on rails that sink differently starts in a state that the step keeps",
          "[start]") {
  const double softer = GENERATE(2., 8.), dt = 1e-5;
  const Track track = unequal_track(softer);
  Wheelset set = paper_wheelset(3.5);
  set.weight = 40e3;
  set.mass = 4e3;
  for (const Named& each : all_schemes(track, dt)) {
    ModelRun run = in_equilibrium(track, {.wheelsets = {set}, .head = kHead}, each.options);
    const double start[2] = {run.state.contact_force[0], run.state.contact_force[1]};
    const double roll = run.body()[3];
    CHECK(roll > 1e-3);
    const double depth = std::pow(start[0] / run.model().contact[0].law.hertz, 2. / 3.);
    for (int n = 1; n <= 20; ++n) {
      run.step();
      // Without lateral support it slides down its own slope by g roll t^2/2, and leaves its rails
      // by roll times that. The force goes with the depth to the power 1.5.
      const double t = n * dt, off = 1.5 * .5 * 9.81 * std::pow(roll * t, 2) / depth;
      for (const int wheel : {0, 1}) {
        CAPTURE(each.name, n, wheel, off);
        CHECK_THAT(run.outputs.contact_force[wheel], WithinRel(start[wheel], 1e-9 + off));
      }
    }
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("a flange that roll would push into its rail starts clear of it", "[start]") {
  const double softer = GENERATE(2., 8.), dt = 1e-5;
  const Track track = unequal_track(softer);
  Wheelset set = flanged_wheelset(1e7, 1e4);
  set.flange->clearance = 1e-4;  // less than roll times the wheel's radius
  set.start = 3.5;
  set.weight = 40e3;
  set.mass = 4e3;
  for (const Named& each : all_schemes(track, dt)) {
    ModelRun run = in_equilibrium(track, {.wheelsets = {set}, .head = kFlangedHead}, each.options);
    const double* const force = run.state.contact_force;
    const double start[2] = {force[0], force[1]}, aside = run.body()[1], roll = run.body()[3];
    CAPTURE(each.name, softer, aside, roll);
    CHECK(roll > 1e-3);
    CHECK(std::abs(aside) > .2 * (roll * .148 - 1e-4));
    for (int n = 1; n <= 20; ++n) {
      run.step();
      CHECK(force[2] == 0.);
      CHECK(force[3] == 0.);
      for (const int wheel : {0, 1}) CHECK_THAT(force[wheel], WithinRel(start[wheel], 1e-3));
    }
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("a wheelset that leans on its flange on unequal rails stays at rest", "[start]") {
  const double softer = GENERATE(1., 2., 8.), dt = 1e-4;
  const Track track = unequal_track(softer);
  Wheelset set = flanged_wheelset(1e7, 1e4);
  set.start = 3.5;
  set.weight = 40e3;
  set.mass = 4e3;
  set.forces = {{.direction = 1, .table = {0., 2e3}}};
  for (const Named& each : all_schemes(track, dt)) {
    ModelRun run = in_equilibrium(track, {.wheelsets = {set}, .head = kFlangedHead}, each.options);
    const std::vector<double> start(run.state.contact_force, run.state.contact_force + 4);
    CHECK(start[2] > 1e3);
    for (int n = 1; n <= 100; ++n) {
      run.step();
      for (std::size_t contact = 0; contact < 4; ++contact) {
        CAPTURE(each.name, n, contact);
        CHECK(std::abs(run.state.contact_force[contact] - start[contact]) < 1e-9 * 20e3);
      }
    }
    CHECK(run.seen == Status::ok);
  }
}

TEST_CASE("wheelsets that lean on their flanges beside each other and a vehicle stay at rest",
          "[start]") {
  const double softer = GENERATE(1., 2.), dt = 1e-4;
  const Track track = unequal_track(softer);
  Wheelset left = flanged_wheelset(1e7, 1e4);
  left.start = 2.4;
  left.weight = 40e3;
  left.mass = 4e3;
  left.forces = {{.direction = 1, .table = {0., 2e3}}};
  Wheelset right = left;
  right.start = 4.1;
  right.forces[0].table = {0., -1.5e3};
  RunningVehicle mass = running(point_mass(900.), 3.1, 0.);
  mass.gravity = 9.81;
  for (const Named& each : all_schemes(track, dt)) {
    ModelRun run = in_equilibrium(
        track, {.wheelsets = {left, right}, .vehicles = {mass}, .head = kFlangedHead},
        each.options);
    const int contacts = contact_count(run.model());
    const std::vector<double> start(run.state.contact_force, run.state.contact_force + contacts);
    REQUIRE(contacts == 9);
    CHECK(start[4] > 8e3);  // the vehicle
    CHECK(start[5] > 1e3);  // the left flange of the first
    CHECK(start[6] == 0.);
    CHECK(start[7] == 0.);
    CHECK(start[8] > 1e3);  // the right flange of the second
    for (int n = 1; n <= 100; ++n) {
      run.step();
      for (std::size_t contact = 0; contact < 9; ++contact) {
        CAPTURE(each.name, softer, n, contact);
        CHECK(std::abs(run.state.contact_force[contact] - start[contact]) < 1e-9 * 20e3);
      }
    }
    CHECK(run.seen == Status::ok);
  }
}
