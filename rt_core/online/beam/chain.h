#pragma once
#include <cstdint>

#include "online/beam/planar.h"
#include "online/beam/straight.h"

namespace railstep {

/// A beam of alike straight elements in a row: element e has the nodes 2e, 2e + 1, 2e + 2. In space
/// a node has W = 9 unknowns, in the plane x-z W = 5; every call below is there for both.
struct Chain {
  StraightBeam beam;
  double mass[4];  // rho times the section's integrals of 1, y2, z2, z: kg/m, kg m, kg m, kg
  const std::int32_t* held;  // [held_count] unknowns W node + i that are 0, each once
  std::int32_t held_count;
  std::int32_t elements;  // n, at least 1
};

constexpr int chain_nodes(int elements) noexcept { return 2 * elements + 1; }
/// Right-hand sides that chain_solve() takes side by side.
inline constexpr int kChainSides = 4;

/// Doubles of the tangents of a batch: straight_tangents() for W = 9, planar_tangents() for W = 5.
template <int W>
constexpr std::int64_t chain_tangent_doubles(int elements) noexcept {
  return std::int64_t{straight_groups(elements)} * kStraightPairs * W * W * kStraightLanes;
}
/// Doubles of a row of an end node in the factor: its own columns and the next end node's, padded.
template <int W>
inline constexpr int kChainRow = (2 * W + 3) / 4 * 4;
/// Doubles of a factor: mid nodes [group][row W][column 3W][lane], end nodes [n + 1][W][kChainRow].
template <int W>
constexpr std::int64_t chain_factor_doubles(int elements) noexcept {
  return std::int64_t{straight_groups(elements)} * W * 3 * W * kStraightLanes +
         (std::int64_t{elements} + 1) * W * kChainRow<W>;
}

/// force += M g, the consistent mass of Eq. 12: P (x) Q (x) I of each element, P[i][j] the integral
/// of N_i N_j over its length, Q the section's, of [r, a, b].
/// @param g, force  [2n + 1][W]; no alias. Held unknowns count too.
template <int W>
void chain_inertia(const Chain& chain, const double* g, double* force) noexcept;

/// L D L' = S = k_factor K + mass_factor M, without pivoting; rows and columns of held unknowns are
/// those of a diagonal matrix. Mid nodes first, four elements in lanes, then end node after end
/// node.
/// @param mass_factor  at least 0; 1/s2 if k_factor is a number
/// @param k_factor     at least 0; with 0 the tangents need not be set
/// @param tangents     [chain_tangent_doubles<W>(n)], overwritten with nothing of use
/// @param factor       [chain_factor_doubles<W>(n)], overwritten; no alias
/// @returns how many of D's numbers are not above 0: for a regular S as many as it has eigenvalues
///          below 0. The factor is made in any case; an exact 0 or a NaN makes it useless.
template <int W>
[[nodiscard]] int chain_factor(const Chain& chain, double mass_factor, double k_factor,
                               double* tangents, double* factor) noexcept;

/// x := S^-1 x of four right-hand sides, held unknowns := 0. Each side is solved as if alone.
/// @param x  [2n + 1][W][kChainSides]
template <int W>
void chain_solve(const Chain& chain, const double* factor, double* x) noexcept;

/// The same of one right-hand side; the bits are those of a side of four.
/// @param x  [2n + 1][W]
template <int W>
void chain_solve_one(const Chain& chain, const double* factor, double* x) noexcept;

}  // namespace railstep
