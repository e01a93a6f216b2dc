#pragma once
#include <memory>
#include <utility>

#include "offline/start/start.h"
#include "offline/vehicle/kinds.h"
#include "support/condensed_tracks.h"

namespace railstep {

/// The bogie of the Manchester benchmark, on one rail.
inline const BogieData kBogie{.frame_mass = 1307.5,
                              .frame_inertia = 738.,
                              .wheel_mass = 906.5,
                              .wheelbase = 2.56,
                              .axles = 2,
                              .primary_stiffness = 1.22e6,
                              .primary_damping = 4e3,
                              .carried = 8000.};
inline const CarData kCar{.bogie = {1307.5, 738., 906.5, 2.56, 2, 1.22e6, 4e3},
                          .body_mass = 16000.,
                          .body_inertia = 9.85e5,
                          .bogie_distance = 19.,
                          .secondary_stiffness = 4.3e5,
                          .secondary_damping = 2e4};

/// One rail with a stiffness like 60E1 on seats every .6 m.
inline Track one_rail(int bays) {
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

inline RunningVehicle running(const NamedVehicle& what, double start, double speed) {
  RunningVehicle v;
  v.vehicle = what.vehicle;
  v.start = start;
  v.speed = speed;
  return v;
}

/// A run that starts at rest under the vehicles, without the track's own weight.
inline ModelRun from_rest(const Track& track, const Traffic& traffic, const PackOptions& options) {
  auto packed = std::make_unique<PackedModel>(track, traffic, options);
  packed->set_start(start_in_equilibrium(track, *packed, 0.));
  return ModelRun(std::move(packed));
}

/// Options for a condensed model (`modal`) or one in full order.
inline PackOptions options_of(bool modal, const Track& track, double dt, double rho_inf = .6) {
  return modal ? condensed(track, 2, dt, rho_inf) : full_order(dt, rho_inf);
}

}  // namespace railstep
