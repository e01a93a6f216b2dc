#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

namespace railstep {

/// Entries of the inverse of a symmetric matrix, where its factor has any: Takahashi's recurrence
/// (Takahashi, Fagan and Chin, 1973; Erisman and Tinney, 1975). What is wanted of elements along a
/// track so costs as the factor does, linearly in their number.
class SelectedInverse {
 public:
  using Sparse = Eigen::SparseMatrix<double>;

  explicit SelectedInverse(const Eigen::SimplicialLDLT<Sparse>& factor);

  /// Throws std::out_of_range where the factor has no entry: at rows that no group of grouped()
  /// brought together.
  double at(int i, int j) const;

 private:
  double in_factor(int row, int column) const;  // row >= column

  Eigen::VectorXi place_;  // of each row in the factor
  Sparse below_;           // the diagonal, as the factor has it
  Eigen::VectorXd diagonal_;
};

/// The matrix with an entry, 0 if it has none, wherever two rows of a group meet; rows < 0 are
/// passed over.
Eigen::SparseMatrix<double> grouped(const Eigen::SparseMatrix<double>& matrix,
                                    const std::vector<std::vector<int>>& groups);

}  // namespace railstep
