#pragma once

namespace railstep {

inline constexpr int kBeamUnknowns = 27;
/// Inner products of the five vectors V = [r', a', b', a, b] of a point of the axis, in this order:
/// r'r' r'a' r'b' a'a' a'b' b'b' r'a r'b a'a a'b b'a b'b aa ab bb; those of a vector with itself
/// are halved.
inline constexpr int kProducts = 15;
inline constexpr int kMostBeamPoints = 10;

/// Vectors of V in each product.
inline constexpr int kProductOf[kProducts][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2},
                                                 {2, 2}, {0, 3}, {0, 4}, {1, 3}, {1, 4},
                                                 {2, 3}, {2, 4}, {3, 3}, {3, 4}, {4, 4}};

/// Part of one point of the axis in the energy of a quadratic 3-node ANCF beam element:
///   U = p0 (s - s0) + (s - s0)' C (s - s0) / 2,  s the inner products.
/// Every Green-Lagrange strain of the section is linear in s, so section, material, rule, preload
/// and shape at rest are in these constants alone.
struct BeamPoint {
  double value[3];                         // shape functions N of Eq. 22
  double slope[3];                         // dN/dx, 1/m
  double rest[kProducts];                  // s0
  double preload[kProducts];               // p0, dU/ds at rest; N m over the unit of s
  double stiffness[kProducts][kProducts];  // C, symmetric; weight and det J in it
};

/// An element; unknowns of nodes 1..3, each r (m), r_y, r_z (1), as positions, not displacements.
struct Beam {
  int points;  // 1 to kMostBeamPoints
  BeamPoint point[kMostBeamPoints];
};

/// Q = dU/dq, elastic force of one element: Eq. 18 with its misprints mended (the
/// symmetric half of the strain, the factor 2 on shears; docs/errata.md). The written order of sums
/// is the same on every machine.
/// @param q      [27]
/// @param force  [27], overwritten; N for r, N m for slopes; must not alias q
/// Cannot fail: NaN in, NaN out. Same work for every q.
void beam_force(const Beam& beam, const double* q, double* force) noexcept;

/// Force, and its derivative K = d2U/dq2, symmetric to the bit.
/// @param tangent  [27][27], overwritten; must not alias q or force
void beam_tangent(const Beam& beam, const double* q, double* force, double* tangent) noexcept;

}  // namespace railstep
