#pragma once
#include <cstdint>

namespace railstep {

/// Coefficients of a one-step scheme with constant matrices, made offline. With g the true
/// acceleration (M g + C v + K u = f at every step) and a the algorithmic one (Arnold and Bruls
/// 2007):
///   u* = u + uv v + ua a + ug g,   v* = v + va a + vg g,   (K + kv C + kg M) u1 = f + M kg u* +
///   C (kv u* - v*),   v1 = v* + kv (u1 - u*),   g1 = kg (u1 - u*),   a1 = ag g1 + a0 g + aa a.
struct Scheme {
  double dt;  // s
  double uv, ua, ug, va, vg, kv, kg, ag, a0, aa;
  double theta;  // contact forces follow the penetration theta d1 + (1 - theta) d0; 1: at the end
  /// With two stages of the same matrix, the first, as above, ends at `stage_fraction` of the step
  /// (0: there is one stage). From the values 0 and p at its ends the second continues with
  ///   v* = v0 + w (vp - v0),   u* = u0 + w (up - u0) + v* / kv,   w = stage_weight.
  double stage_fraction, stage_weight;
  /// 1: the force of a Hertz contact is the mean of its law over the change of penetration in the
  /// step (PortLaw::mean); forces are then held over the step with theta = 1.
  std::int32_t mean;
};

/// Where forces are held over the step, the mean rate of a motion is this times D - d0, 1/s, with
/// D = theta d1 + (1 - theta) d0.
inline double mean_rate(const Scheme& scheme) noexcept { return 1. / (scheme.theta * scheme.dt); }

/// One solve within a step: it covers `span` seconds and ends `before` seconds before the end of
/// `step`.
struct Stage {
  std::int64_t step;
  double before, span;  // s
};
inline double time_of(const Scheme& scheme, const Stage& at) noexcept {
  return static_cast<double>(at.step) * scheme.dt - at.before;
}
/// The last stage of a step, or its only one.
inline Stage last_stage(const Scheme& scheme, std::int64_t step) noexcept {
  return {step, 0., scheme.dt - scheme.stage_fraction * scheme.dt};
}
inline Stage first_stage(const Scheme& scheme, std::int64_t step) noexcept {
  return {step, scheme.dt - scheme.stage_fraction * scheme.dt, scheme.stage_fraction * scheme.dt};
}

}  // namespace railstep
