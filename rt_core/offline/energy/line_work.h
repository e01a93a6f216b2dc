#pragma once
#include <Eigen/Core>
#include <vector>

#include "online/runner/force_elements.h"

namespace railstep {

/// Displacements and forces of a runner's force elements in a state.
std::vector<StandingElement> standing_elements(const Model& model, const RunnerModel& runner,
                                               const State& at);

/// Forces of the design line over a runner's coordinates in a state, [size], N and N m; 0 without
/// a line.
Eigen::VectorXd line_forces(const Model& model, const RunnerModel& runner, const State& at);

/// Work of the frames on a runner in a step, J: by the forces of the design line, and by moving
/// force elements and rods in place of the bodies.
/// @param du  [size] motion of the step
double frames_work(const Model& model, const RunnerModel& runner, const State& from,
                   const State& to, const Eigen::VectorXd& du);

}  // namespace railstep
