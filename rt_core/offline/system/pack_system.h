#pragma once
#include <memory>
#include <vector>

#include "offline/pack/scheme.h"
#include "offline/system/system.h"
#include "online/model/state.h"

namespace railstep {

/// How a system's joints are held and its steps are solved.
struct SystemOptions {
  Scheme scheme;
  int steps_per_frame = 1;
  Hold hold = Hold::augmented_lagrangian;
  Tangent tangent = Tangent::every_step;
  int cap = 12;               // Newton iterations a step
  int projections = 4;        // iterations of a projection of velocities or accelerations
  int keep_steps = 10;        // of Tangent::kept
  double penalty = 1e9;       // augmented Lagrangian, over each joint row's own mass at rest / dt^2
  double alpha = 0., beta = 0.;  // Baumgarte, 1/s; 0: from the step, 1 / (5 dt)
  double tolerance = 1e-8;       // of the forces, over the largest kind of force
  double joint_tolerance = 1e-10;  // m, and 1
  std::int64_t steps = 0;          // of the scene's run
};

/// A model of a system alone, and the memory its views look into.
class PackedSystem {
 public:
  /// The start is that of the parts' positions and velocities, accelerations and joint forces in
  /// balance with them. Throws std::invalid_argument on what cannot be built (massless parts, joints
  /// that name parts that do not exist, points off their beam, motion out of a planar system).
  PackedSystem(const System& system, const SystemOptions& options);
  PackedSystem(const PackedSystem&) = delete;
  PackedSystem& operator=(const PackedSystem&) = delete;
  ~PackedSystem();

  const Model& model() const { return model_; }

 private:
  struct Memory;
  Model model_{};
  std::unique_ptr<Memory> memory_;
};

/// Energy-momentum: forces at the mean of a step's ends, elastic ones by the mean stress, which
/// makes and loses no energy; second order.
Scheme energy_momentum(double dt);

}  // namespace railstep
