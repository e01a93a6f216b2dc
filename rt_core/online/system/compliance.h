#pragma once
#include <cstdint>

namespace railstep {

/// Factor L U of a matrix that is symmetric, or nearly so. Pivots come from the diagonal. Among the
/// leading rows the one with the largest remaining diagonal comes first; then the others come in
/// their order. A leading row depends on the rows before if less than tolerance times its own
/// diagonal remains; it is left out (its solution is 0). A matrix over rows may be unsymmetric
/// (slope S^-1 gradient'). The remaining part of rows that nearly depend on each other is then
/// still near a positive or a negative definite matrix.
struct Pivoted {
  double* matrix;       // [n][n] in, L under and U on and above the diagonal out
  double* scale;        // [n] diagonal before, its magnitude
  std::int32_t* order;  // [n] row at each place
  std::int32_t n, leading;
  std::int32_t rank;  // of the leading rows
};

/// Fills `order` and `rank`; the matrix in, its factor out. 2 n^3 / 3 flops.
void factor_pivoted(Pivoted& f, double tolerance) noexcept;

/// Solves in place. @param x  [n] @param scratch  [n] @param all  else of the leading rows alone,
/// the others are set 0
void solve_pivoted(const Pivoted& f, bool all, double* x, double* scratch) noexcept;

}  // namespace railstep
