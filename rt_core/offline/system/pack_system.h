#pragma once
#include <memory>
#include <optional>

#include "offline/pack/pack.h"
#include "offline/pack/time_schemes.h"
#include "offline/system/multibody.h"
#include "offline/system/rest.h"
#include "online/model/state.h"

namespace railstep {

/// Indices of joints and springs whose forces the trace shows.
struct TracedForces {
  std::vector<int> joints, springs;
};

/// Options for holding joints and solving steps.
struct SystemOptions {
  Scheme scheme = {};
  bool energy_momentum = false;  // with the scheme energy_momentum()
  int steps_per_frame = 1;
  ConstraintMethod constraint_method = ConstraintMethod::augmented_lagrangian;
  Renew renew = Renew::every_step;
  int cap = 20;         // Newton iterations a step
  int projections = 4;  // iterations of a projection of velocities or accelerations
  int keep_steps = 10;  // of Renew::kept
  /// Augmented Lagrangian, over each joint row's own mass at rest / dt^2; 0: 1e9. With the
  /// energy-momentum scheme it acts only while joint rows depend on each other.
  double penalty = 0.;
  double alpha = 0.;  // Baumgarte, 1/s; both 0: alpha = beta = 1 / (5 dt)
  double beta = 0.;
  double tolerance = 1e-8;         // of forces, over the largest kind of force
  double joint_tolerance = 1e-10;  // m, and 1
  std::int64_t steps = 0;          // of the scene's run
  /// true: the start is the static equilibrium under weight, springs, and forces and loads at t =
  /// 0, with drives at s(0) (rest.h). false: all parts are as given and rails are unloaded.
  bool at_rest = false;
  TracedForces traced = {};
};

/// A model of a system, with or without a track, and the memory that its views look into.
class PackedSystem {
 public:
  /// The start has the parts' positions and velocities; accelerations and joint forces are in
  /// balance with them. Velocities that the joints do not allow are removed as by an impulse.
  /// Throws Refused if the system cannot be built: parts without mass, joints of parts that do not
  /// exist, points off their beam, motion out of a planar system, direct joints or joints without
  /// projections with rho_inf = 1, or at_rest without an equilibrium.
  PackedSystem(const System& system, const SystemOptions& options);
  /// A system beside a linear track with ends and all that runs on it. Joints, springs and sensors
  /// of the system may name its rails; the track gives the scheme and the frames. A rail moves only
  /// along the unknowns of its track. The joint forces at the start are those of the first step's
  /// inertia, as a track has unknowns without mass. Beside a condensed track, which holds forces
  /// over a step, the option energy_momentum is expected; the residual flexibility of condensed
  /// rails acts at ports, but not between ports and wheels.
  PackedSystem(const System& system, const SystemOptions& options, const Track& track,
               const Traffic& traffic, const PackOptions& track_options);
  PackedSystem(const PackedSystem&) = delete;
  PackedSystem& operator=(const PackedSystem&) = delete;
  ~PackedSystem();

  const Model& model() const { return model_; }
  /// The track alone, with its matrices; null without a track.
  const PackedModel* track() const;

 private:
  struct Memory;
  Rest rest_on_track(const System& system, const SystemOptions& options, const Track& track,
                     const Traffic& traffic, const PackOptions& track_options);
  void build(const System& system, const SystemOptions& options, const Track* track,
             const std::optional<Rest>& rest);
  Model model_{};
  std::unique_ptr<Memory> memory_;
};

/// Energy-momentum: forces at the mean of a step's ends, elastic ones by the mean stress (Simo and
/// Tarnow 1992). It neither makes nor loses energy; second order. For systems without a track.
Scheme energy_momentum(double dt);

}  // namespace railstep
