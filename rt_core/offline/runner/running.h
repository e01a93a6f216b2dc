#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/runner/suspension.h"
#include "online/runner/rolling_contact.h"

namespace railstep {

/// A vehicle that runs steadily on straight, level, rigid rails.
struct SteadyRunning {
  Eigen::VectorXd displacement;  // [n] of its motions; 0 for spins
  Eigen::VectorXd rate;          // [n] 0 but for spins, beyond speed / radius
  double resistance;             // force ahead that keeps the speed, N
};

/// Small motions about it, M q'' + C q' + K q + sum of row' force of `series` = 0, gyroscopic
/// moments of the wheelsets included. C and K are not symmetric.
struct LinearRunning {
  Eigen::VectorXd mass;
  Eigen::MatrixXd damping, stiffness;
  std::vector<RunnerMatrices::Series> series;
};

/// By Newton's method with exact derivatives. The first body is held along x.
/// @param speed  m/s
/// @param rails  under each wheelset; empty: straight and level
/// Throws Failed if no steady motion is found.
SteadyRunning steady_running(const Runner& runner, const RunnerMatrices& matrices,
                             const RollingContact& contact, double speed,
                             const std::vector<RailsUnder>& rails = {});

LinearRunning linear_running(const Runner& runner, const RunnerMatrices& matrices,
                             const RollingContact& contact, double speed,
                             const SteadyRunning& steady);

/// Forces of the rails on the wheels, [wheelsets][left, right].
std::vector<std::array<WheelForce, 2>> wheel_forces(const Runner& runner,
                                                    const RollingContact& contact, double speed,
                                                    const SteadyRunning& steady,
                                                    const std::vector<RailsUnder>& rails = {});

}  // namespace railstep
