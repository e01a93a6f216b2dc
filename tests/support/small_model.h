#pragma once
#include <memory>
#include <string>

#include "offline/vehicle/kinds.h"
#include "support/block_fields.h"

namespace railstep {

/// Small models of both kinds, with loads that have tables, wheelsets, vehicles, irregular rails
/// and wheels, track sensors and pair tables.
inline std::unique_ptr<PackedModel> small_model(bool modal, bool wheels) {
  Track track = wheels ? paper_track() : peers_pair(1);
  track.bays = 2;
  Traffic traffic;
  for (const double x : {.2, .5})
    traffic.loads.push_back(
        {.start = x, .speed = 10., .stop = 1., .force = -50e3, .table = {0., 0., .01, 1.}});
  if (wheels) {
    Wheelset w = paper_wheelset(1.2);
    w.forces = {{1, {0., 10., .01, 0.}}};
    w.tread[1] = fit_signal({0., 1e-5, -1e-5}, 0., .3, true);
    w.flange = Flange{.clearance = 1e-5, .angle = 1.2, .stiffness = 1e7, .damping = 1e4};
    traffic.wheelsets = {w};
    traffic.irregularities = {{0, 2, fit_signal({0., 1e-5}, 1., .1, false)},
                              {1, 1, fit_signal({1e-5, 0., 2e-5}, 0., .5, true)}};
    traffic.head = kHead;
    RunningVehicle v;
    v.vehicle = bogie({.frame_mass = 1000.,
                       .frame_inertia = 700.,
                       .wheel_mass = 500.,
                       .wheelbase = .9,
                       .axles = 2,
                       .primary_stiffness = 1e6,
                       .primary_damping = 1e4})
                    .vehicle;
    v.start = .1;  // a wheel comes from before the rail
    v.speeds = {0., 10., .01, 20.};
    v.tread = {fit_signal({0., 1e-5, -1e-5}, 0., .3, true), {}};
    traffic.vehicles = {v, v};
    traffic.vehicles[1].rail = 1;
    traffic.vehicles[1].contact = WheelContactKind::linear;
    traffic.vehicles[1].stiffness = 1e8;
    traffic.vehicles[1].damping = 1e4;
    traffic.loads[0].amplitude = 1e3;
    traffic.loads[0].frequency = 50.;
    traffic.loads[1].speeds = {0., 10., .01, 20.};
    traffic.track_sensors = {
        {.displacement = 1., .runner = RunnerSum{RunnerSum::Of::wheelset, 0, {{2, 1.}}}},
        {.displacement = 1., .runner = RunnerSum{RunnerSum::Of::vehicle, 1, {{1, 1.}}}}};
  }
  traffic.track_sensors.push_back({.rest = .1,
                                   .displacement = 1.,
                                   .velocity = .01,
                                   .track = {.rail = {{{0, .4, 0., 0., 2}, 1.}}}});
  PackOptions options = modal ? condensed(track, 3, 1e-4) : full_order(1e-4);
  options.residual_points = 4;
  options.steps_per_frame = 2;
  options.steps = 40;
  return std::make_unique<PackedModel>(track, traffic, options);
}

inline const std::string kText = "time_s\nsome.column_m";

inline Block small_block(bool modal, bool wheels) {
  return to_block(small_model(modal, wheels)->model(), kText);
}

/// Block of one load on a bay, so small that a test can try every bit.
inline Block smallest_block() {
  Track track = peers_pair(1);
  track.rails = 1;
  track.bays = 1;
  Traffic traffic;
  traffic.loads.push_back({.start = .2, .speed = 10., .stop = .5, .force = -50e3});
  PackOptions options = condensed(track, 1, 1e-4);
  options.residual_flexibility = false;
  return to_block(PackedModel(track, traffic, options).model(), kText, {.about = "of one bay\n"});
}

}  // namespace railstep
