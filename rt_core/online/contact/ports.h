#pragma once

#include <cstdint>

#include "online/model/caps.h"

namespace railstep {

enum class PortStatus : std::uint8_t {
  converged,    // residual within kPortTolerance
  cap_reached,  // the forces are the best found; the residual says how good
  indefinite,  // W is not positive semidefinite: couplings were neglected in a step, the forces are
               // the best found and may not be the only ones
  bad_input,   // a number is not finite, a law is invalid, W_ii < 0 or n is out of range: forces 0
};

/// Force of a port over its penetration d; it never falls. A bilateral port has slope d + jump at
/// every d. Another has 0 for d <= 0, and for d > 0
///   hertz d^1.5                                    of a contact (hertz > 0), else
///   max(0, slope d + jump)                         of a spring and a damper over one step.
/// A damper c that works while d > 0 has the velocity kv d + v0 at the end of a step: the slope is
/// then k + c kv and the jump c v0. A jump above 0 is jump min(1, d / kJumpDepth), so that the law
/// is continuous; a jump below 0 leaves it continuous. Without velocity the force is the spring's.
///
/// For a contact whose law is a mean (Gonzalez's discrete gradient) the force is
///   [V(d) - V(from)] / (d - from),  V(d) = 2/5 hertz max(d, 0)^2.5:
/// its work over the step is the gain of V. It never falls with d either, and is above 0 if one of
/// both ends is.
struct PortLaw {
  double hertz;  // N/m^1.5
  double slope;  // N/m, > 0 unless hertz > 0
  double jump;   // N; below 0 for a port that opens
  bool bilateral = false;
  bool mean = false;
  double from = 0.;  // m, of a mean: the penetration at the step's start
};
inline constexpr double kJumpDepth = 1e-6;  // m

/// The force of a port alone at a penetration, and its slope over it; port_depth() is the inverse,
/// for a force > 0 or any force of a bilateral port.
struct PortForce {
  double force, slope;  // N, N/m
};
PortForce port_force(const PortLaw& law, double d) noexcept;
double port_depth(const PortLaw& law, double force) noexcept;

struct PortResult {
  PortStatus status;
  int iterations;   // Newton iterations taken, 0 to cap
  double residual;  // max |d + W f - d_free|, m
};

/// Target of the residual, over the largest |d_free_i| + sum_j |W_ij| f_j. The rounding of the sum
/// itself is up to n eps = 3.6e-15 of that, so that a factor of a few hundred is left.
inline constexpr double kPortTolerance = 1e-12;

/// Coupled one-sided ports: d + W f(d) = d_free, f_i(d_i) by the laws.
///
/// f minimises the convex f'Wf/2 + sum of integrals of d_i(f_i) - d_free'f over f >= 0 of one-sided
/// ports and any f of bilateral ones. As d_i(f_i) rises for all, f is unique. Newton's method works
/// on the active set. Its step is taken partly in d and partly in f, weighted so that a single
/// contact converges cubically, and shortened if it ends far beyond the minimum on its line. A
/// single spring with damper is solved in one step.
/// @param n       ports, 0 to kPorts
/// @param W       [n][n] compliance, m/N, symmetric, positive semidefinite
/// @param law     [n]
/// @param d_free  [n] penetrations without port forces, m
/// @param f       [n] in: forces of the last step (a start; of one-sided ports anything not a
///                positive number counts as none); out: forces, N, finite, >= 0 of one-sided ones
/// @param d       [n] out: penetrations, m; negative is a gap. It may be d_free
/// @param cap     most iterations, clipped to 0..8
/// Work: at most 8 iterations of one n x n solve and four products. Always finite.
[[nodiscard]] PortResult solve_ports(int n, const double* W, const PortLaw* law,
                                     const double* d_free, double* f, double* d,
                                     int cap = kPortSweeps) noexcept;

}  // namespace railstep
