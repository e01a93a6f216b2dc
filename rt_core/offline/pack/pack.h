#pragma once
#include <memory>
#include <string>
#include <vector>

#include "offline/track/track.h"
#include "online/model/state.h"

namespace railstep {

/// A force that runs along a rail, as a scene gives it.
struct MovingLoad {
  int rail = 0;
  double start = 0., speed = 0.;   // m, m/s
  double stop = 0.;                // m; taken off beyond it
  double force = 0.;               // N along z, up positive
  double z = 0.;                   // of the loaded point over the axis, m
  std::vector<double> table = {};  // t (s), factor, t, factor, ...; empty: constant
};

struct PackOptions {
  Scheme scheme;
  int steps_per_frame = 1;
  bool residual_flexibility = true;
  int residual_points = 16;  // intervals per element
};

/// A model with the memory its views look into. Not copied: the views would look into the original.
class PackedModel {
 public:
  PackedModel(const Track& track, const std::vector<MovingLoad>& loads, const PackOptions& options);
  PackedModel(const PackedModel&) = delete;
  PackedModel& operator=(const PackedModel&) = delete;

  const Model& model() const { return model_; }

 private:
  const double* keep(std::vector<double> values);
  const std::int32_t* keep(std::vector<std::int32_t> values);
  Diagonals keep_diagonals(const Eigen::SparseMatrix<double>& A, int padded);
  void add_line(const Track& track, const Line& line);
  void add_load(const Track& track, const std::vector<Line>& lines, const MovingLoad& load,
                const PackOptions& options);

  Model model_{};
  std::vector<std::unique_ptr<std::vector<double>>> reals_;
  std::vector<std::unique_ptr<std::vector<std::int32_t>>> integers_;
};

}  // namespace railstep
