#pragma once
#include <Eigen/Core>

#include "offline/track/track.h"

namespace railstep {

enum class BeamTheory { euler_bernoulli, timoshenko };

/// Vertical bending of a rail per metre.
struct BendingBeam {
  double stiffness;       // EI, N m2
  double shear_softness;  // 1/(k_z G A), 1/N; 0: Euler-Bernoulli
  double mass;            // kg/m
  double rotary_inertia;  // rho I, kg m; 0: Euler-Bernoulli
};

BendingBeam bending_beam(const Track& track, BeamTheory theory);

/// Dynamic stiffness of a beam between its ends over [w, theta] at x = 0 and at x = length, w up,
/// theta = w' without shear; N/m, N, N m. Exact: of the four waves e^(kappa x) with
/// EI kappa^4 + (EI b + rho I omega^2) kappa^2 + (rho I b - m) omega^2 = 0, b = m omega^2/(k_z G
/// A), theta = (kappa + b/kappa) w, each counted from the end from which it decays.
/// @param omega  rad/s, above 0
Eigen::Matrix4cd beam_dynamic_stiffness(const BendingBeam& beam, double length, double omega);

}  // namespace railstep
