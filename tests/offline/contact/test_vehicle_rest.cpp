// Vehicles at rest on one-sided supports: pads and ballast that do not pull, and hanging sleepers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "offline/analysis/statics.h"
#include "support/one_sided_tracks.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// S1 with ballast that does not pull under some seats and a gap under others. The bogie's wheels,
/// 2.56 m apart, stand on both sides of the gaps.
Track hanging() {
  Track track = s1_rail(24);
  track.support.damping[2] *= 10.;
  for (int seat = 8; seat <= 18; ++seat) {
    Seat own = track.seat(seat);
    own.ballast[0].unilateral = own.ballast[1].unilateral = true;
    track.changed_seats[seat] = own;
  }
  for (const int seat : {12, 13}) track = with_gap(track, seat, .5e-3);
  return track;
}

double load_of(const NamedVehicle& what) {
  double sum = 0.;
  for (const Vehicle::Body& body : what.vehicle.bodies) sum += (body.mass + body.carried) * 9.81;
  return sum;
}

}  // namespace

TEST_CASE("a vehicle at rest on one-sided supports stays at rest", "[vehicle][supports]") {
  BogieData three = kBogie;
  three.axles = 3;
  for (const bool modal : {false, true})
    for (const NamedVehicle& what : {bogie(kBogie), bogie(three)}) {
      const Track track = hanging();
      ModelRun run = from_rest(track, {.vehicles = {running(what, 7.5, 0.)}, .head = {.0}},
                               options_of(modal, track, 1e-4));
      const auto wheels = static_cast<int>(what.vehicle.wheels.size());
      double open = 1e9, pressed = 0., sum = 0.;
      for (int j = 0; j < run.model().fixed.count; ++j) {
        open = std::min(open, run.state.port_force[j]);
        pressed = std::max(pressed, run.state.port_force[j]);
      }
      CHECK(open == 0.);
      CHECK(pressed > 1e3);
      const std::vector<double> before(run.state.contact_force, run.state.contact_force + wheels);
      const std::vector<double> ports(run.state.port_force,
                                      run.state.port_force + run.model().fixed.count);
      for (const double force : before) sum += force;
      CHECK_THAT(sum, WithinRel(load_of(what), 1e-10));
      for (int i = 0; i < 500; ++i) run.step();
      CAPTURE(modal, wheels);
      CHECK(run.seen == Status::ok);
      for (std::size_t i = 0; i < before.size(); ++i)  // as on a track that pulls, test_vehicle_run
        CHECK_THAT(run.outputs.contact_force[i], WithinRel(before[i], 1e-8));
      for (std::size_t j = 0; j < ports.size(); ++j)
        CHECK_THAT(run.state.port_force[j], WithinAbs(ports[j], 1e-8 * before[0]));
    }
}

TEST_CASE("a bogie rests on hanging sleepers as its two wheel loads do", "[vehicle][supports]") {
  // The statics of the track alone has the forces at the railhead, where they act in the same way.
  const Track track = hanging();
  const NamedVehicle what = bogie(kBogie);
  const ModelRun run =
      from_rest(track, {.vehicles = {running(what, 7.5, 0.)}, .head = {.0}}, full_order(1e-4));
  const Statics statics(track);
  const double load = .5 * load_of(what);
  const auto lines =
      statics.solve({{{0, 7.5 + 1.28, 0., 0., 2}, -load}, {{0, 7.5 - 1.28, 0., 0., 2}, -load}});
  const std::vector<double> pressed = statics.port_forces(lines);
  REQUIRE(static_cast<int>(pressed.size()) == run.model().fixed.count);
  for (std::size_t j = 0; j < pressed.size(); ++j)
    CHECK_THAT(run.state.port_force[j], WithinAbs(pressed[j], 1e-8 * load));
}

TEST_CASE("a released vehicle settles where the start finds it", "[vehicle][supports]") {
  // It is dropped with its springs free of force; its dampers end the bounce of 8 rad/s.
  BogieData three = kBogie;
  three.axles = 3;
  three.primary_damping = 4e4;
  const Track track = hanging();
  const Traffic traffic{.vehicles = {running(bogie(three), 7.5, 0.)}, .head = {.0}};
  const ModelRun rest = from_rest(track, traffic, full_order(1e-3));
  ModelRun run(track, traffic, full_order(1e-3));
  run.until(3.);
  for (int i = 0; i < 3; ++i)
    CHECK_THAT(run.outputs.contact_force[i], WithinRel(rest.state.contact_force[i], 1e-6));
  for (int j = 0; j < run.model().fixed.count; ++j)
    CHECK_THAT(run.state.port_force[j],
               WithinAbs(rest.state.port_force[j], 1e-6 * rest.state.contact_force[0]));
}

TEST_CASE("vehicles without support have no equilibrium on such a track", "[vehicle]") {
  RunningVehicle v = running(bogie(kBogie), 7.5, 0.);
  v.vehicle.bodies[0].place = 2.;  // the frame's weight is ahead of both wheels
  const Track track = hanging();
  PackedModel packed(track, {.vehicles = {v}}, full_order(1e-4));
  CHECK_THROWS_WITH(start_in_equilibrium(track, packed, 0.), Catch::Contains("E-START-10"));
}
