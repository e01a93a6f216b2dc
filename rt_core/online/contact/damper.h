#pragma once
#include "online/contact/ports.h"
#include "online/model/scheme.h"

namespace railstep {

// A spring and a damper c at a port over a step give a force slope d + jump (PortLaw), because the
// speed of the depth is linear in the depth:
// - if forces act at the step's end, d is the depth there, and the scheme has
//   v1 = v* + kv (u1 - u*);
// - if forces are held over the step, the depth is D = theta d1 + (1 - theta) d0, and the
//   mean speed is (d1 - d0)/dt = (D - d0)/(theta dt). So the damper dissipates c (d1 - d0)^2/dt,
//   and for theta >= 1/2 the work on the spring is at least what it stores, while the port stays
//   closed.

/// Speed of a port's depth d over a step: per_metre d + before.
struct DepthSpeed {
  double per_metre, before;  // 1/s, m/s
};

/// Speed at the step's end. @param depth, speed  by u* and v*, m, m/s
inline DepthSpeed speed_at_end(const Scheme& scheme, double depth, double speed) noexcept {
  return {scheme.kv, speed - scheme.kv * depth};
}

/// Mean speed over a step whose forces are held. @param depth  at its start, m
inline DepthSpeed mean_speed(const Scheme& scheme, double depth) noexcept {
  const double per_metre = mean_rate(scheme);
  return {per_metre, -per_metre * depth};
}

/// Adds a damper to the spring of a law.
inline void add_damper(double damping, const DepthSpeed& speed, PortLaw& law) noexcept {
  law.slope += damping * speed.per_metre;
  law.jump = damping * speed.before;
}

}  // namespace railstep
