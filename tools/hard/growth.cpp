#include "hard/growth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <complex>
#include <limits>

#include "online/step/step.h"

namespace railstep {
namespace {

constexpr double kSmall = 1e-8;  // m: 1e-4 of a wheel's depth in the rail

/// One frame from `start`.
Eigen::VectorXd frame_from(Simulation& run, const Eigen::VectorXd& start, std::int64_t steps,
                           Eigen::Index moved) {
  std::copy(start.data(), start.data() + start.size(), run.state.u);
  run.state.steps = steps;
  Outputs outputs{};
  static_cast<void>(advance_frame(run.model(), run.state, run.workspace, outputs));
  return Eigen::Map<const Eigen::VectorXd>(run.state.u, moved);
}

}  // namespace

double growth_of(Simulation& run) {
  const Model& model = run.model();
  const std::int64_t steps = run.state.steps;
  const Eigen::VectorXd start =
      Eigen::Map<const Eigen::VectorXd>(run.state.u, state_doubles(model));
  const Eigen::Index n = model.unknowns, moved = 4 * n;  // displacements to true accelerations
  const double per_step = 1. / model.scheme.dt;
  const double size[4] = {kSmall, kSmall * per_step, kSmall * per_step * per_step,
                          kSmall * per_step * per_step};
  Eigen::MatrixXd map(moved, moved);
  Eigen::VectorXd at = start;
  for (Eigen::Index i = 0; i < moved; ++i) {
    const double by = size[i / n];
    at[i] = start[i] + by;
    const Eigen::VectorXd ahead = frame_from(run, at, steps, moved);
    at[i] = start[i] - by;
    const Eigen::VectorXd behind = frame_from(run, at, steps, moved);
    at[i] = start[i];
    // the same unit for all, so that no eigenvalue drowns in the rounding of large numbers
    for (Eigen::Index k = 0; k < moved; ++k)
      map(k, i) = (ahead[k] - behind[k]) / (2. * size[k / n]);
  }
  std::copy(start.data(), start.data() + start.size(), run.state.u);
  run.state.steps = steps;
  // The complex solver: the real one divides by zero at some pairs of equal roots.
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(map.cast<std::complex<double>>(), false);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace railstep
