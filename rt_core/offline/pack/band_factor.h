#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "online/math/band.h"

namespace railstep {

/// The arrays behind a Band, and its view.
struct BandFactor {
  int unknowns;  // before padding
  int panels;
  int left;
  std::vector<double> forward, inverse, backward;  // shapes as in Band

  Band view() const { return {panels, left, forward.data(), inverse.data(), backward.data()}; }
};

/// Block LDL' (8x8) of a symmetric positive definite matrix, for solve_band().
///
/// A is padded to a multiple of 8 by a unit diagonal. The width of the band is that of the
/// outermost entry, in whole blocks. Plain loops in a fixed order make the same bits on every
/// machine.
/// @param A  only the lower triangle (row >= column) is read; the upper one may be stored too
/// @throws Refused if A is empty, not square, or not positive definite (the sentence names the
///   unknown whose pivot failed)
BandFactor factor_band(const Eigen::SparseMatrix<double>& A);

}  // namespace railstep
