#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

#include "offline/math/sparse.h"

namespace railstep {

/// A part of a vector: its entries from `first` on; entries beyond are read as 0.
struct Stretch {
  Eigen::Index first;
  Eigen::VectorXd value;
  double operator[](Eigen::Index i) const {
    return i >= first && i < first + value.size() ? value[i - first] : 0.;
  }
};

/// Exact solutions of a banded, symmetric, positive definite system around few loads, at a cost
/// that grows with the number of rows that are read. The inverse within the band is by Takahashi's
/// recurrence (Takahashi, Fagan and Chin, 1973; Erisman and Tinney, 1975). From there solutions go
/// outwards along the factor from either end, in the direction in which they fade.
class LocalInverse {
 public:
  /// The matrix with its unknowns in order along the track; factored without pivots, in work and
  /// memory linear in its rows.
  explicit LocalInverse(const Sparse& matrix);

  /// Rows [first, last) of the solution.
  Stretch solve(const Eigen::SparseVector<double>& load, Eigen::Index first,
                Eigen::Index last) const;

 private:
  using Factor = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

  void invert(const Eigen::VectorXd& pivots);
  double within(Eigen::Index i, Eigen::Index j) const;
  void add(const Eigen::SparseVector<double>& load, Stretch& to) const;

  Eigen::Index rows_, band_ = 1;  // |i - j| < band_ where there are entries
  Sparse down_, up_;              // L below its diagonal, of the matrix and of it in reverse order
  std::vector<double> inverse_;   // [rows][band]: of row j and row j + k
};

}  // namespace railstep
