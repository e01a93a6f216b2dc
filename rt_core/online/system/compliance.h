#pragma once
#include <cstdint>

namespace railstep {

/// Factor of a symmetric matrix, L D L', pivots taken where most of a diagonal is left: first among
/// the leading rows, then the others as they come. What is left of the leading ones below
/// tolerance times its own diagonal depends on the rows before and is left out (its solution is 0).
struct Pivoted {
  double* matrix;       // [n][n] in, L under and D on the diagonal out
  double* scale;        // [n] diagonal before
  std::int32_t* order;  // [n] row at each place
  std::int32_t n, leading;
  std::int32_t rank;  // of the leading rows
};

/// Fills `order` and `rank`, and the matrix's both triangles in, its factor out. n^3 / 3 flops.
void factor_pivoted(Pivoted& f, double tolerance) noexcept;

/// Solves in place. @param x  [n] @param scratch  [n] @param all  else of the leading rows alone,
/// the others are set 0
void solve_pivoted(const Pivoted& f, bool all, double* x, double* scratch) noexcept;

}  // namespace railstep
