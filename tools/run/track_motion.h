#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "offline/pack/pack.h"
#include "online/model/state.h"

namespace railstep {

/// Displacements of rails and sleepers in a state, by the lines alone.
class TrackMotion {
 public:
  TrackMotion(const Track& track, const PackedModel& packed, const Model& model,
              const State& state);
  /// Change of [r, a, b] of a rail's node from rest: m, and slopes.
  std::array<double, 9> node(int rail, int node) const;
  /// Displacement x, y, z of a sleeper's end, m, and its turn about y, rad.
  std::array<double, 4> sleeper(int rail, int seat) const;

 private:
  const Track& track_;
  const std::vector<PackedLine>& lines_;
  std::vector<Eigen::VectorXd> u_;  // of each line's unknowns
};

}  // namespace railstep
