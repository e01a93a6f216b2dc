#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "offline/runner/curving.h"
#include "online/runner/rolling_contact.h"

namespace railstep {

/// A vehicle that runs steadily on straight, level, rigid rails.
struct SteadyRunning {
  Eigen::VectorXd displacement;  // [n] of its motions; 0 for spins
  Eigen::VectorXd rate;          // [n] 0 but for spins, beyond speed / radius
  double resistance;             // force ahead that keeps the speed, N
  Eigen::VectorXd tension;       // of each rod, N
};

/// Small motions about it, M q'' + C q' + K q + sum of row' force of `series` = 0, gyroscopic
/// moments of the wheelsets included. C and K are not symmetric. Rails that give way add the modes
/// of their seats to q.
struct LinearRunning {
  Eigen::VectorXd mass;
  Eigen::MatrixXd damping, stiffness;
  std::vector<RunnerMatrices::Series> series;
  Eigen::MatrixXd rods;  // as of RunnerMatrices
};

/// Rails that give way under a vehicle as they stand: y, z and roll of the seats under each of its
/// wheels, left and right of each wheelset in turn, as masses, dampers and springs.
struct StandingTrack {
  Eigen::MatrixXd mass, damping, stiffness;  // [6 wheelsets][6 wheelsets], symmetric
  /// Derivatives along x of the displacements in each seat by the displacements of all: the rail
  /// under a wheel moves at the rate of its seat less speed times this.
  Eigen::MatrixXd slope;
};
struct RunningOn {
  std::vector<RailsUnder> rails = {};  // under each wheelset; empty: straight and level
  std::optional<StandingTrack> track = std::nullopt;  // empty: rigid
  DesignLine line = {};
  double place = 0.;    // of the first body on it, m
  double gravity = 0.;  // m/s2
};
/// The matrices of a vehicle and the rails under it at a speed, with what a design line does there
/// in steady motion.
struct Running {
  RunnerMatrices matrices;
  std::vector<RailsUnder> rails;
};
/// Throws Failed if no steady motion is found.
Running running_on(const RunningOn& on, const Runner& runner, const RunnerMatrices& matrices,
                   const RollingContact& contact, double speed);

/// By Newton's method with exact derivatives. The first body is held along x.
/// @param speed  m/s
/// @param rails  under each wheelset; empty: straight and level
/// Throws Failed if no steady motion is found.
SteadyRunning steady_running(const Runner& runner, const RunnerMatrices& matrices,
                             const RollingContact& contact, double speed,
                             const std::vector<RailsUnder>& rails = {});

LinearRunning linear_running(const Runner& runner, const RunnerMatrices& matrices,
                             const RollingContact& contact, double speed,
                             const SteadyRunning& steady, const RunningOn& on = {});

/// Forces of the rails on the wheels, [wheelsets][left, right].
std::vector<std::array<WheelForce, 2>> wheel_forces(const Runner& runner,
                                                    const RollingContact& contact, double speed,
                                                    const SteadyRunning& steady,
                                                    const std::vector<RailsUnder>& rails = {});

}  // namespace railstep
