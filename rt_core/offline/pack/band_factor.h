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
/// Padded to a multiple of 8 by a unit diagonal; the band is as wide as the outermost entry asks,
/// in whole blocks. Plain loops in a written order, so the bits are the same on every machine.
/// @param A  both triangles may be stored, only the lower one (row >= column) is read
/// @throws std::invalid_argument if A is empty, not square, or not positive definite (the sentence
///   names the unknown whose pivot failed)
BandFactor factor_band(const Eigen::SparseMatrix<double>& A);

}  // namespace railstep
