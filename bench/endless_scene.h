#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "offline/irregularity/generate.h"
#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "offline/vehicle/kinds.h"
#include "online/step/step.h"

namespace railstep {

inline constexpr double kSpeed = 30.;  // m/s

/// A vertical ballasted track of 60E1; its ends are free unless it is made a ring.
inline Track track_of(int bays, int elements_per_bay, int rails) {
  Track t;
  t.section = {.area = 76.7e-4,
               .inertia_y = 3038e-8,
               .inertia_z = 512e-8,
               .torsion = 209e-8,
               .shear_factor_y = .4,
               .shear_factor_z = .4};
  t.unknowns = Unknowns::vertical;
  t.rails = rails;
  t.bays = bays;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {0., 0., 200e6};
  t.support.damping = {0., 0., 20e3};
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  return t;
}

inline Track ring_of(int bays, int rails, int elements_per_bay = 4) {
  Track ring = track_of(bays, elements_per_bay, rails);
  ring.ring = true;
  return ring;
}

inline PackOptions ring_options(int bays, int modes, double dt) {
  PackOptions o;
  o.scheme = held_force(dt, .6);
  o.reduction = Reduction{.limit = {modes * bays, std::numeric_limits<double>::infinity()}};
  o.endless = EndlessTrack{bays / 2};
  return o;
}

/// Half a bogie of the Manchester benchmark's passenger vehicle on one irregular rail, with half of
/// the body that the bogie carries.
/// @param x  on the track, of where x = 0 of the irregularity and the bogie's middle start, m
inline Traffic bogie_over(double x, const Spectrum& spectrum, const GenerateOptions& waves) {
  RunningVehicle v;
  v.vehicle = bogie({.frame_mass = 1307.5,
                     .frame_inertia = 738.,
                     .wheel_mass = 906.5,
                     .wheelbase = 2.56,
                     .axles = 2,
                     .primary_stiffness = 1.22e6,
                     .primary_damping = 4e3,
                     .carried = 8000.})
                  .vehicle;
  v.start = x;
  v.speed = kSpeed;
  Signal rail = generate(spectrum, waves, 0);
  rail.start += x;
  return {.vehicles = {v}, .head = {.081, .3, .035}, .irregularities = {{0, 2, std::move(rail)}}};
}

/// A model with its state, run from its start.
class Run {
 public:
  explicit Run(const PackedModel& packed)
      : model_(packed.model()),
        memory_(static_cast<std::size_t>(state_doubles(model_))),
        scratch_(static_cast<std::size_t>(workspace_doubles(model_))),
        state_(state_on(model_, memory_.data())),
        workspace_(workspace_on(model_, scratch_.data())) {
    reset(model_, state_);
  }
  const Outputs& frame() {
    static_cast<void>(advance_frame(model_, state_, workspace_, outputs_));
    return outputs_;
  }
  const State& state() const { return state_; }
  const Outputs& outputs() const { return outputs_; }

 private:
  const Model& model_;
  std::vector<double> memory_, scratch_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
};

/// Largest difference over the peak of `want`.
inline double error_over_peak(const std::vector<double>& got, const std::vector<double>& want) {
  double worst = 0., peak = 0.;
  for (std::size_t i = 0; i < want.size(); ++i) {
    worst = std::max(worst, std::abs(got[i] - want[i]));
    peak = std::max(peak, std::abs(want[i]));
  }
  return worst / peak;
}

}  // namespace railstep
