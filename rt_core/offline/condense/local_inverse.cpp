#include "offline/condense/local_inverse.h"

#include <algorithm>

namespace railstep {

LocalInverse::LocalInverse(const Sparse& matrix) : rows_(matrix.rows()) {
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j)
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry)
      band_ = std::max(band_, std::abs(entry.row() - j) + 1);
  const Factor forward(matrix);
  down_ = forward.matrixL().nestedExpression();
  Eigen::PermutationMatrix<Eigen::Dynamic> reversal(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) reversal.indices()[i] = static_cast<int>(rows_ - 1 - i);
  Sparse reversed;
  reversed = matrix.twistedBy(reversal);
  up_ = Factor(reversed).matrixL().nestedExpression();
  invert(forward.vectorD());
}

/// Z = D^-1 L^-1 + (I - L') Z, from the last row to the first: a row needs the entries of later
/// rows within the band.
void LocalInverse::invert(const Eigen::VectorXd& pivots) {
  inverse_.assign(static_cast<std::size_t>(rows_ * band_), 0.);
  for (Eigen::Index j = rows_ - 1; j >= 0; --j)
    for (Eigen::Index i = std::min(j + band_, rows_) - 1; i >= j; --i) {
      double sum = i == j ? 1. / pivots[j] : 0.;
      for (Sparse::InnerIterator entry(down_, j); entry; ++entry)
        sum -= entry.value() * within(entry.row(), i);
      inverse_[static_cast<std::size_t>(j * band_ + i - j)] = sum;
    }
}

double LocalInverse::within(Eigen::Index i, Eigen::Index j) const {
  const Eigen::Index first = std::min(i, j);
  return inverse_[static_cast<std::size_t>(first * band_ + std::max(i, j) - first)];
}

/// Solution for loads whose rows are all within a band of one another.
void LocalInverse::add(const Eigen::SparseVector<double>& load, Stretch& to) const {
  const Eigen::Index lowest = load.innerIndexPtr()[0],
                     highest = load.innerIndexPtr()[load.nonZeros() - 1];
  const Eigen::Index low = std::max<Eigen::Index>(highest - band_ + 1, 0),
                     high = std::min(lowest + band_, rows_);  // of what the inverse shows itself
  const Eigen::Index first = std::min(low, to.first),
                     last = std::max(high, to.first + to.value.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(last - first);
  for (Eigen::Index i = low; i < high; ++i)
    for (Eigen::SparseVector<double>::InnerIterator at(load); at; ++at)
      x[i - first] += at.value() * within(i, at.index());
  for (Eigen::Index j = low - 1; j >= to.first; --j)
    for (Sparse::InnerIterator entry(down_, j); entry; ++entry)
      x[j - first] -= entry.value() * x[entry.row() - first];
  for (Eigen::Index i = high; i < to.first + to.value.size(); ++i)
    for (Sparse::InnerIterator entry(up_, rows_ - 1 - i); entry; ++entry)
      x[i - first] -= entry.value() * x[rows_ - 1 - entry.row() - first];
  to.value += x.segment(to.first - first, to.value.size());
}

Stretch LocalInverse::solve(const Eigen::SparseVector<double>& load, Eigen::Index first,
                            Eigen::Index last) const {
  Stretch sum{first, Eigen::VectorXd::Zero(last - first)};
  Eigen::SparseVector<double> part(rows_);
  for (Eigen::SparseVector<double>::InnerIterator at(load); at; ++at) {
    if (part.nonZeros() > 0 && at.index() - part.innerIndexPtr()[0] >= band_) {
      add(part, sum);
      part.setZero();
    }
    part.insertBack(at.index()) = at.value();
  }
  if (part.nonZeros() > 0) add(part, sum);
  return sum;
}

}  // namespace railstep
