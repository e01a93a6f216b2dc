#include "offline/analysis/rigid.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

constexpr double kRounding = 1e-13;
constexpr Eigen::Index kBlock = 12;  // more than the six rigid motions of one body
constexpr int kIterations = 4;       // the shift lies far below the modes beyond the block

/// Ritz vectors of K over M in the span of the block; M-orthonormal, lowest first. Rigid motions
/// dwarf the others in a block that inverse iteration leaves: it is made orthonormal before.
Eigen::MatrixXd ritz(const Eigen::SparseMatrix<double>& K, const Eigen::SparseMatrix<double>& M,
                     const Eigen::MatrixXd& found) {
  const Eigen::MatrixXd block = Eigen::HouseholderQR<Eigen::MatrixXd>(found).householderQ() *
                                Eigen::MatrixXd::Identity(found.rows(), found.cols());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      block.transpose() * (K * block), block.transpose() * (M * block));
  if (solver.info() != Eigen::Success)
    refuse("E-MODES-16",
           "the mass of a part of the track is not positive; expected masses above 0");
  return block * solver.eigenvectors();
}

}  // namespace

bool is_rigid(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXcd& shape) {
  const Eigen::VectorXd size = shape.cwiseAbs();
  const double strain = shape.dot(stiffness.cast<std::complex<double>>() * shape).real();
  return std::abs(strain) <= kRounding * size.dot(stiffness.cwiseAbs() * size);
}

Eigen::MatrixXd start_block(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd block(rows, columns);
  std::uint64_t state = 1;
  for (double& value : block.reshaped()) {
    state = state * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1.;
  }
  return block;
}

Eigen::MatrixXd rigid_modes(const Eigen::SparseMatrix<double>& stiffness,
                            const Eigen::SparseMatrix<double>& mass) {
  const Eigen::Index n = stiffness.rows();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  const double highest = Eigen::VectorXd(stiffness.diagonal())
                             .cwiseQuotient(Eigen::VectorXd(mass.diagonal()))
                             .maxCoeff();
  // Above the rounding of K, below all modes that are not rigid.
  const double shift = std::max(1e-12 * highest, 1e-300);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(
      Eigen::SparseMatrix<double>(stiffness + shift * mass));
  if (factor.info() != Eigen::Success)
    refuse("E-TRACK-37",
           "the stiffness of the track cannot be factored; expected stiffnesses that differ by "
           "fewer orders of magnitude");
  Eigen::MatrixXd block = start_block(n, std::min(kBlock, n));
  for (int iteration = 0; iteration < kIterations; ++iteration)
    block = ritz(stiffness, mass, factor.solve(mass * block));
  Eigen::Index rigid = 0;
  while (rigid < block.cols() && is_rigid(stiffness, block.col(rigid).cast<std::complex<double>>()))
    ++rigid;
  return block.leftCols(rigid);
}

}  // namespace railstep
