#include "offline/runner/stability.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "offline/math/refuse.h"

namespace railstep {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastHz = .01;

/// Columns x such that q = x p has unit mass and keeps the lengths of all rods.
MatrixXd free_motions(const LinearRunning& l) {
  const Index n = l.mass.size();
  const VectorXd scale = l.mass.cwiseSqrt().cwiseInverse();
  if (l.rods.cols() == 0) return scale.asDiagonal();
  const Eigen::ColPivHouseholderQR<MatrixXd> held(scale.asDiagonal() * l.rods);
  const MatrixXd all = held.householderQ() * MatrixXd::Identity(n, n);
  return scale.asDiagonal() * all.rightCols(n - held.rank());
}

/// Eigenvalues of q'' = -M^-1 (C q' + K q + row' force), force' = k (row q' - force / c), in
/// coordinates free_motions() and with forces over sqrt(k).
Eigen::VectorXcd eigenvalues(const LinearRunning& l) {
  const MatrixXd x = free_motions(l);
  std::vector<RunnerMatrices::Series> damped;  // one that does not damp at rest has no force
  for (const RunnerMatrices::Series& own : l.series)
    if (own.damping > 0.) damped.push_back(own);
  const Index n = x.cols(), series = static_cast<Index>(damped.size());
  MatrixXd A = MatrixXd::Zero(2 * n + series, 2 * n + series);
  A.block(0, n, n, n).setIdentity();
  A.block(n, 0, n, n) = -(x.transpose() * l.stiffness * x);
  A.block(n, n, n, n) = -(x.transpose() * l.damping * x);
  for (Index i = 0; i < series; ++i) {
    const RunnerMatrices::Series& s = damped[static_cast<std::size_t>(i)];
    const VectorXd row = std::sqrt(s.stiffness) * (x.transpose() * s.row);
    A.block(n, 2 * n + i, n, 1) = -row;
    A.block(2 * n + i, n, 1, n) = row.transpose();
    A(2 * n + i, 2 * n + i) = -s.stiffness / s.damping;
  }
  return Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues();
}

bool counts(const std::complex<double>& s) {
  return s.imag() >= 0. && std::abs(s) > 2. * std::numbers::pi * kLeastHz;
}

LinearRunning running_at(const Runner& runner, const RunnerMatrices& m,
                         const RollingContact& contact, double speed, const RunningOn& on) {
  const Running here = running_on(on, runner, m, contact, speed);
  return linear_running(runner, here.matrices, contact, speed,
                        steady_running(runner, here.matrices, contact, speed, here.rails),
                        {here.rails, on.track});
}

/// The mode that grows most.
std::complex<double> least_damped(const Runner& runner, const RunnerMatrices& m,
                                  const RollingContact& contact, double speed,
                                  const RunningOn& on) {
  std::complex<double> most = -1e300;
  for (const std::complex<double>& s : eigenvalues(running_at(runner, m, contact, speed, on)))
    if (counts(s) && s.real() > most.real()) most = s;
  return most;
}

}  // namespace

std::vector<RunningMode> running_modes(const LinearRunning& linear) {
  std::vector<RunningMode> modes;
  for (const std::complex<double>& s : eigenvalues(linear))
    if (counts(s))
      modes.push_back({std::abs(s) / (2. * std::numbers::pi), -s.real() / std::abs(s)});
  std::sort(modes.begin(), modes.end(),
            [](const RunningMode& a, const RunningMode& b) { return a.frequency < b.frequency; });
  return modes;
}

std::optional<CriticalRunning> critical_running_speed(const Runner& runner, const RunnerMatrices& m,
                                                      const RollingContact& contact,
                                                      SpeedRange& range, const RunningOn& on) {
  const auto [from, to] = range;
  const auto mode_at = [&](double speed) { return least_damped(runner, m, contact, speed, on); };
  const int steps = static_cast<int>(std::ceil(std::max(100., (to - from) / 2.)));
  std::optional<double> low;
  for (int i = 0; i <= steps; ++i) {
    double high = from + (to - from) * i / steps;
    std::complex<double> s;
    try {
      s = mode_at(high);
    } catch (const Failed&) {
      if (low) break;
      if (i == steps) throw;
      continue;
    }
    if (!low) range.from = high;
    range.to = high;
    if (s.real() >= 0. && !low) return std::nullopt;
    if (s.real() < 0.) {
      low = high;
      continue;
    }
    while (high - *low > 1e-10 * high) {
      const double middle = .5 * (*low + high);
      const std::complex<double> there = mode_at(middle);
      if (there.real() < 0.)
        low = middle;
      else {
        high = middle;
        s = there;
      }
    }
    return CriticalRunning{high, std::abs(s) / (2. * std::numbers::pi)};
  }
  return std::nullopt;
}

}  // namespace railstep
