#pragma once

#include <cstdint>

namespace railstep {

inline constexpr int kPorts = 16;      // most ports of one solve
inline constexpr int kPortSweeps = 8;  // most Newton iterations

enum class PortStatus : std::uint8_t {
  converged,    // residual within kPortTolerance
  cap_reached,  // the forces are the best found, the residual says how good
  bad_input,    // a number is not finite, C <= 0, W_ii < 0 or n out of range: all forces 0
};

struct PortResult {
  PortStatus status;
  int iterations;   // Newton iterations taken, 0 to cap
  double residual;  // max |d + W f - d_free|, m
};

/// Residual wanted, over the largest |d_free_i| + sum_j |W_ij| f_j: the rounding of the sum itself
/// is up to n eps = 3.6e-15 of that, so this leaves a factor of a few hundred.
inline constexpr double kPortTolerance = 1e-12;

/// Coupled unilateral Hertz ports: d + W f(d) = d_free, f_i = C_i d_i^1.5 if d_i > 0, else 0.
///
/// f minimises the convex f'Wf/2 + sum 3/5 C_i^(-2/3) f_i^(5/3) - d_free'f over f >= 0, so it is
/// unique. Newton on the active set; its step is taken partly in d and partly in f, weighted so
/// that a lone port converges cubically, and shortened if it runs far past the minimum on its line.
/// @param n       ports, 0 to 16
/// @param W       [n][n] compliance, m/N, symmetric, positive semidefinite
/// @param C       [n] Hertz constants, N/m^1.5, > 0
/// @param d_free  [n] penetrations without port forces, m
/// @param f       [n] in: forces of the last step (a start; anything not a positive number counts
///                as none); out: forces, N, finite and >= 0
/// @param d       [n] out: penetrations, m; negative is a gap
/// @param cap     most iterations, clipped to 0..8
/// Work: at most 8 iterations of one 16x16 solve and four products. Always finite.
[[nodiscard]] PortResult solve_ports(int n, const double* W, const double* C, const double* d_free,
                                     double* f, double* d, int cap = kPortSweeps) noexcept;

}  // namespace railstep
