#pragma once
#include <limits>

#include "offline/pack/time_schemes.h"
#include "offline/start/start.h"
#include "support/model_run.h"
#include "support/sections.h"

namespace railstep {

/// A vertical ballasted track with soft pads; its ends are free unless it is made a ring or a
/// window.
inline Track endless_track(int bays, int elements_per_bay, int rails = 1) {
  Track t;
  t.section = section_f();
  t.unknowns = Unknowns::vertical;
  t.rails = rails;
  t.bays = bays;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {0., 0., 120e6};
  t.support.damping = {0., 0., 30e3};
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  return t;
}

inline Track ring_of(Track track) {
  track.ring = true;
  return track;
}

/// -50 kN at 30 m/s: 20 steps of 1 ms per bay of 0.6 m.
inline constexpr double kForce = -50e3, kSpeed = 30.;
inline MovingLoad moving_load(double start, int rail = 0) {
  return {.rail = rail,
          .start = start,
          .speed = kSpeed,
          .stop = std::numeric_limits<double>::infinity(),
          .force = kForce};
}

/// A ring of Floquet modes with x = 0 in its middle.
inline PackOptions ring_options(const Track& ring, int modes_per_bay, double dt = 1e-3) {
  PackOptions o;
  o.scheme = held_force(dt, .6);
  o.reduction =
      Reduction{.limit = {modes_per_bay * ring.bays, std::numeric_limits<double>::infinity()}};
  o.endless = EndlessTrack{ring.bays / 2};
  return o;
}

inline PackOptions window_options(const Track& track, double dt = 1e-3) {
  PackOptions o;
  o.scheme = generalised_alpha(dt, .6);
  o.endless = EndlessTrack{track.bays / 2};
  return o;
}

}  // namespace railstep
