#pragma once
#include <memory>
#include <string>
#include <vector>

#include "offline/track/track.h"
#include "online/model/state.h"

namespace railstep {

class ResidualFlexibility;

/// A force that runs along a rail, as a scene gives it.
struct MovingLoad {
  int rail = 0;
  double start = 0., speed = 0.;   // m, m/s
  double stop = 0.;                // m; taken off beyond it
  double force = 0.;               // N along z, up positive
  double z = 0.;                   // of the loaded point over the axis, m
  std::vector<double> table = {};  // t (s), factor, t, factor, ...; empty: constant
};

/// A rigid wheelset on both rails, as a scene gives it. Rolls without friction on cylinders.
struct Wheelset {
  double mass = 0., inertia_roll = 0., inertia_spin = 0., inertia_yaw = 0.;  // kg, kg m2
  double weight = 0.;              // N, down; own and carried
  double radius = .46;             // m
  double tread_half_width = .065;  // m
  double start = 0., speed = 0.;   // m, m/s
  Guide guide = Guide::augmented_lagrangian;
  int cap = 20;
  double tolerance = 1e-10;      // m, rad
  double alpha = 0., beta = 0.;  // of Baumgarte, 1/s
  struct Force {
    int direction;              // 0 x, 1 y, 2 z
    std::vector<double> table;  // t (s), N, t, N, ...
  };
  std::vector<Force> forces = {};
};

/// The railhead that wheels meet.
struct Railhead {
  double top_z = 0.;         // over the axis, m
  double crown_radius = .3;  // m
  double half_width = .035;  // m; a contact beyond it is off the rail
};

struct PackOptions {
  Scheme scheme;
  int steps_per_frame = 1;
  bool residual_flexibility = true;
  int residual_points = 16;  // intervals per element
  double gravity = 0.;       // m/s2 on rails and sleepers; 0: their weight is left off
};

/// A model with the memory its views look into. Not copied: the views would look into the original.
class PackedModel {
 public:
  PackedModel(const Track& track, const std::vector<MovingLoad>& loads, const PackOptions& options);
  PackedModel(const Track& track, const std::vector<MovingLoad>& loads,
              const std::vector<Wheelset>& wheelsets, const Railhead& head,
              const PackOptions& options);
  PackedModel(const PackedModel&) = delete;
  PackedModel& operator=(const PackedModel&) = delete;

  const Model& model() const { return model_; }

 private:
  const double* keep(std::vector<double> values);
  const std::int32_t* keep(std::vector<std::int32_t> values);
  Diagonals keep_diagonals(const Eigen::SparseMatrix<double>& A, int padded);
  void add_line(const Track& track, const Line& line);
  /// @param residual null where PackOptions leave it out
  void add_load(const Track& track, const ResidualFlexibility* residual, const MovingLoad& load);
  void add_wheelset(const Track& track, const ResidualFlexibility* residual,
                    const Wheelset& wheelset, const Railhead& head);

  Model model_{};
  std::vector<std::unique_ptr<std::vector<double>>> reals_;
  std::vector<std::unique_ptr<std::vector<std::int32_t>>> integers_;
};

}  // namespace railstep
