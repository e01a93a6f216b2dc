#include "offline/condense/selected_inverse.h"

#include <algorithm>
#include <stdexcept>

namespace railstep {

SelectedInverse::SelectedInverse(const Eigen::SimplicialLDLT<Sparse>& factor)
    : place_(factor.permutationP().indices()),
      below_(factor.matrixL().nestedExpression()),
      diagonal_(factor.vectorD().cwiseInverse()) {
  const Sparse L = below_;
  Eigen::VectorXd column;
  // Z = D^-1 L^-1 + (I - L') Z, from the last column to the first: what a column asks of the later
  // ones is where its own rows meet.
  for (int j = static_cast<int>(L.cols()) - 1; j >= 0; --j) {
    const int first = L.outerIndexPtr()[j], count = L.outerIndexPtr()[j + 1] - first;
    const int* const rows = L.innerIndexPtr() + first;
    const double* const factors = L.valuePtr() + first;
    column.setZero(count);
    for (int a = 0; a < count; ++a)
      for (int b = 0; b <= a; ++b) {
        const double z = in_factor(rows[a], rows[b]);
        column[a] -= z * factors[b];
        if (a != b) column[b] -= z * factors[a];
      }
    for (int a = 0; a < count; ++a) diagonal_[j] -= factors[a] * column[a];
    std::copy_n(column.data(), count, below_.valuePtr() + first);
  }
}

double SelectedInverse::in_factor(int row, int column) const {
  if (row == column) return diagonal_[row];
  const int* const rows = below_.innerIndexPtr();
  const int* const end = rows + below_.outerIndexPtr()[column + 1];
  const int* const found = std::lower_bound(rows + below_.outerIndexPtr()[column], end, row);
  if (found == end || *found != row)
    throw std::out_of_range("an inverse is asked where its factor has no entry");
  return below_.valuePtr()[found - rows];
}

double SelectedInverse::at(int i, int j) const {
  const int a = place_[i], b = place_[j];
  return in_factor(std::max(a, b), std::min(a, b));
}

Eigen::SparseMatrix<double> grouped(const Eigen::SparseMatrix<double>& matrix,
                                    const std::vector<std::vector<int>>& groups) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::vector<int>& group : groups)
    for (const int i : group)
      for (const int j : group)
        if (i >= 0 && j >= 0) entries.emplace_back(i, j, 0.);
  Eigen::SparseMatrix<double> more(matrix.rows(), matrix.cols());
  more.setFromTriplets(entries.begin(), entries.end());
  return more + matrix;
}

}  // namespace railstep
