#include "offline/condense/rational_krylov.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "offline/analysis/krylov.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// Where on the section a wheel's forces meet the rail, near enough: beside the middle of a head,
/// so that they turn it too, m.
constexpr double kBeside = .01, kAbove = .1;
constexpr double kDependent = 1e-14;  // of the largest eigenvalue of the Gram matrix

/// Unit forces over every seat and in the middle of every bay, of every rail of the line.
Eigen::MatrixXd wheel_forces(const Track& track, const Line& line) {
  std::vector<Eigen::VectorXd> forces;
  for (int rail = 0; rail < track.rails; ++rail) {
    if (line.mirrored && rail == 1) continue;  // the other's but for signs
    for (int half = 0; half <= 2 * track.bays; ++half)
      for (int direction = 0; direction < 3; ++direction) {
        const RailPoint at{rail, .5 * half * track.bay_length, kBeside, kAbove, direction};
        Eigen::VectorXd force(point_row(track, line, at, false));
        if (force.norm() > 0.) forces.push_back(std::move(force));
      }
  }
  Eigen::MatrixXd all(line.unknowns(), static_cast<Eigen::Index>(forces.size()));
  for (std::size_t j = 0; j < forces.size(); ++j) all.col(static_cast<Eigen::Index>(j)) = forces[j];
  return all;
}

Eigen::MatrixXcd response(const Line& line, const Eigen::MatrixXd& forces, double hz) {
  const Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>> factor(
      dynamic_stiffness(line, {0., 2. * M_PI * hz}));
  if (factor.info() != Eigen::Success)
    refuse("E-CONDENSE-18", "the track resonates without damping at the expansion point of " +
                                std::to_string(hz) +
                                " Hz; expected another condense.expansion_hz, or damping");
  return factor.solve(forces.cast<std::complex<double>>().eval());
}

}  // namespace

Eigen::MatrixXd rational_krylov_shapes(const Track& track, const Line& line,
                                       const std::vector<double>& hz, int most) {
  Eigen::MatrixXd forces = wheel_forces(track, line);
  if (forces.cols() == 0) return forces;  // no wheel moves this line
  const Eigen::Index each = forces.cols(), points = static_cast<Eigen::Index>(hz.size());
  Eigen::MatrixXd all(line.unknowns(), 2 * each * points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::MatrixXcd moved = response(line, forces, hz[static_cast<std::size_t>(i)]);
    all.middleCols(2 * i * each, each) = moved.real();
    all.middleCols((2 * i + 1) * each, each) = moved.imag();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(all.transpose() *
                                                            (line.stiffness * all));
  const auto independent =
      (gram.eigenvalues().array() > kDependent * gram.eigenvalues().maxCoeff()).count();
  const Eigen::Index count = std::min<Eigen::Index>(independent, most);
  return all * gram.eigenvectors().rightCols(count);
}

}  // namespace railstep
