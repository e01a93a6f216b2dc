#pragma once
#include <limits>
#include <memory>

#include "offline/pack/time_schemes.h"
#include "offline/start/start.h"
#include "support/model_run.h"
#include "support/sections.h"

namespace railstep {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The peers' scene of reference.md: two rails, 16 bays of 0.6 m, springs at each border.
inline Track peers_pair(int elements_per_bay) {
  Track t;
  t.section = peers_rectangle();
  t.unknowns = Unknowns::vertical;
  t.bays = 16;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {3e6, 3e7, 3e7};
  t.support.damping = {3e4, 3e4, 3e4};
  return t;
}

/// 60E1 rails on pads, sleepers and ballast: parameter set S1 per rail, as in the ballasted scene.
inline Track s1_track(int bays, int elements_per_bay) {
  Track t;
  t.section = {.area = 7670e-6,
               .inertia_y = 30.383e-6,
               .inertia_z = 5.123e-6,
               .torsion = 2.2e-6,
               .shear_factor_y = .53,
               .shear_factor_z = .40,
               .shear_centre_z = -.035};
  t.bays = bays;
  t.elements_per_bay = elements_per_bay;
  t.support = {.stiffness = {50e6, 50e6, 200e6},
               .damping = {20e3, 20e3, 20e3},
               .roll_stiffness = .3e6,
               .height_z = -.081};
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  return t;
}

/// Options for these modes per bay of every line, with forces held over a step.
inline PackOptions condensed(const Track& track, double modes_per_bay, double dt,
                             double rho_inf = .6) {
  return {.scheme = held_force(dt, rho_inf),
          .reduction = Reduction{.limit = {static_cast<int>(modes_per_bay * track.bays),
                                           std::numeric_limits<double>::infinity()}}};
}

inline PackOptions full_order(double dt, double rho_inf = .6) {
  return {.scheme = generalised_alpha(dt, rho_inf)};
}

inline const Railhead kHead{.1007375, .3, .038};  // of section F

/// The paper's wheelset, on section F.
inline Wheelset paper_wheelset(double start) {
  Wheelset w;
  w.mass = 100.;
  w.inertia_roll = w.inertia_yaw = 8.3;
  w.inertia_spin = 1.1;
  w.weight = 981.;
  w.radius = .148;
  w.start = start;
  return w;
}

inline ModelRun in_equilibrium(const Track& track, const Traffic& traffic,
                               const PackOptions& options) {
  auto packed = std::make_unique<PackedModel>(track, traffic, options);
  packed->set_start(start_in_equilibrium(track, *packed, options.gravity));
  return ModelRun(std::move(packed));
}

}  // namespace railstep
