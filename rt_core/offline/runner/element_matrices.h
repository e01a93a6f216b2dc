#pragma once
#include "offline/runner/suspension.h"

namespace railstep {

// Force elements among the matrices of a suspension.

/// An element over the coordinates. A damper in series with a spring joins the matrices' series.
/// Throws Refused on a stiffness, a curve or a limit out of range.
RunnerMatrices::Element made_element(const Runner& runner, const RunnerForceElement& e,
                                     RunnerMatrices& matrices);

/// Forces of springs that are not linear, and of friction that has come from rest to a displacement
/// in one way, over the coordinates. Brakes have none.
Eigen::VectorXd element_forces(const RunnerMatrices& matrices, const Eigen::VectorXd& u);
/// The stiffness with the slopes of these forces.
Eigen::MatrixXd stiffness_at(const RunnerMatrices& matrices, const Eigen::VectorXd& u);
/// The stiffness and the damping that small motions about a displacement meet: friction that does
/// not slide is a spring, and dampers have the slope at rest. Brakes are left out.
Eigen::MatrixXd sticking_stiffness_at(const RunnerMatrices& matrices, const Eigen::VectorXd& u);
Eigen::MatrixXd damping_at_rest(const RunnerMatrices& matrices);

}  // namespace railstep
