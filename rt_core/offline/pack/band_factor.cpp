#include "offline/pack/band_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "offline/math/refuse.h"

namespace railstep {
namespace {

constexpr int kBlock = kLanes * kLanes;
using Block = std::array<double, kBlock>;  // row-major

int at(int row, int column) { return row * kLanes + column; }

/// The lower block band: block(i, j) for i - j = 0..wide, zero where A has no entry.
struct BlockBand {
  int panels, wide;
  std::vector<Block> blocks;

  Block& operator()(int i, int j) {
    return blocks[static_cast<std::size_t>(i) * static_cast<std::size_t>(wide + 1) +
                  static_cast<std::size_t>(i - j)];
  }
};

template <typename Visit>
void visit_lower(const Eigen::SparseMatrix<double>& A, Visit visit) {
  for (int outer = 0; outer < A.outerSize(); ++outer)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(A, outer); entry; ++entry)
      if (entry.row() >= entry.col())
        visit(static_cast<int>(entry.row()), static_cast<int>(entry.col()), entry.value());
}

BlockBand gather(const Eigen::SparseMatrix<double>& A) {
  const int n = static_cast<int>(A.rows());
  BlockBand band{(n + kLanes - 1) / kLanes, 0, {}};
  visit_lower(A, [&](int row, int column, double) {
    band.wide = std::max(band.wide, row / kLanes - column / kLanes);
  });
  band.blocks.assign(
      static_cast<std::size_t>(band.panels) * static_cast<std::size_t>(band.wide + 1), Block{});
  visit_lower(A, [&](int row, int column, double value) {
    auto& block = band(row / kLanes, column / kLanes);
    block[static_cast<std::size_t>(at(row % kLanes, column % kLanes))] += value;
    if (row / kLanes == column / kLanes && row != column)
      block[static_cast<std::size_t>(at(column % kLanes, row % kLanes))] += value;
  });
  for (int i = n; i < band.panels * kLanes; ++i)
    band(i / kLanes, i / kLanes)[static_cast<std::size_t>(at(i % kLanes, i % kLanes))] = 1.0;
  return band;
}

/// C -= A B', entry after entry.
void subtract_product(Block& C, const Block& A, const Block& B) {
  for (int i = 0; i < kLanes; ++i)
    for (int j = 0; j < kLanes; ++j) {
      double sum = 0.0;
      for (int k = 0; k < kLanes; ++k)
        sum += A[static_cast<std::size_t>(at(i, k))] * B[static_cast<std::size_t>(at(j, k))];
      C[static_cast<std::size_t>(at(i, j))] -= sum;
    }
}

/// Lower Cholesky factor of a diagonal block.
Block cholesky(const Block& D, int panel) {
  Block G{};
  for (int j = 0; j < kLanes; ++j)
    for (int i = j; i < kLanes; ++i) {
      double sum = D[static_cast<std::size_t>(at(i, j))];
      for (int k = 0; k < j; ++k)
        sum -= G[static_cast<std::size_t>(at(i, k))] * G[static_cast<std::size_t>(at(j, k))];
      if (i == j && !(sum > 0.0 && std::isfinite(sum)))
        refuse("E-PACK-02", "the matrix is not positive definite at unknown " +
                                std::to_string(panel * kLanes + j) +
                                "; expected masses and stiffnesses of fewer orders of magnitude");
      G[static_cast<std::size_t>(at(i, j))] =
          i == j ? std::sqrt(sum) : sum / G[static_cast<std::size_t>(at(j, j))];
    }
  return G;
}

/// Each row b of B becomes b (G G')^-1, two triangular solves.
Block divide(Block B, const Block& G) {
  for (int row = 0; row < kLanes; ++row) {
    double* b = B.data() + row * kLanes;
    for (int j = 0; j < kLanes; ++j) {
      for (int k = 0; k < j; ++k) b[j] -= G[static_cast<std::size_t>(at(j, k))] * b[k];
      b[j] /= G[static_cast<std::size_t>(at(j, j))];
    }
    for (int j = kLanes - 1; j >= 0; --j) {
      for (int k = j + 1; k < kLanes; ++k) b[j] -= G[static_cast<std::size_t>(at(k, j))] * b[k];
      b[j] /= G[static_cast<std::size_t>(at(j, j))];
    }
  }
  return B;
}

Block identity() {
  Block I{};
  for (int i = 0; i < kLanes; ++i) I[static_cast<std::size_t>(at(i, i))] = 1.0;
  return I;
}

/// Turns the blocks of A into those of L (below) and D^-1 (diagonal), column after column.
void factor(BlockBand& band) {
  for (int j = 0; j < band.panels; ++j) {
    const Block G = cholesky(band(j, j), j);
    const int last = std::min(band.panels - 1, j + band.wide);
    std::vector<Block> L;
    for (int i = j + 1; i <= last; ++i) L.push_back(divide(band(i, j), G));
    // Update the blocks to the right with A_ij D^-1 A_kj' = L_ij A_kj', before A_kj is overwritten.
    for (int i = j + 1; i <= last; ++i)
      for (int k = j + 1; k <= i; ++k)
        subtract_product(band(i, k), L[static_cast<std::size_t>(i - j - 1)], band(k, j));
    for (int i = j + 1; i <= last; ++i) band(i, j) = L[static_cast<std::size_t>(i - j - 1)];
    band(j, j) = divide(identity(), G);
  }
}

}  // namespace

BandFactor factor_band(const Eigen::SparseMatrix<double>& A) {
  if (A.rows() == 0 || A.rows() != A.cols())
    refuse("E-PACK-03", "the band matrix is " + std::to_string(A.rows()) + " by " +
                            std::to_string(A.cols()) +
                            "; expected a square matrix that is not empty");
  BlockBand band = gather(A);
  factor(band);

  BandFactor out{static_cast<int>(A.rows()), band.panels, band.wide * kLanes, {}, {}, {}};
  const auto panels = static_cast<std::size_t>(out.panels);
  const auto panel = static_cast<std::size_t>(out.left) * kLanes;
  out.forward.assign(panels * panel, 0.0);
  out.backward.assign(panels * panel, 0.0);
  out.inverse.resize(panels * kBlock);
  for (int p = 0; p < out.panels; ++p) {
    for (int k = 0; k < kLanes; ++k)
      for (int l = 0; l < kLanes; ++l)
        out.inverse[static_cast<std::size_t>(p) * kBlock + static_cast<std::size_t>(at(k, l))] =
            band(p, p)[static_cast<std::size_t>(at(l, k))];
    for (int q = std::max(0, p - band.wide); q < p; ++q) {
      const Block& L = band(p, q);
      for (int row = 0; row < kLanes; ++row)
        for (int column = 0; column < kLanes; ++column) {
          const double value = L[static_cast<std::size_t>(at(row, column))];
          const int left = at(q - p + band.wide, column), right = at(p - q - 1, row);
          out.forward[static_cast<std::size_t>(p) * panel +
                      static_cast<std::size_t>(at(left, row))] = value;
          out.backward[static_cast<std::size_t>(q) * panel +
                       static_cast<std::size_t>(at(right, column))] = value;
        }
    }
  }
  return out;
}

}  // namespace railstep
