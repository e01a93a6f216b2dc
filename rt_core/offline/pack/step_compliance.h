#pragma once
#include <vector>

#include "offline/condense/local_inverse.h"
#include "offline/pack/pack.h"

namespace railstep {

/// Compliance of the lines of a packed model within a step, to forces at load points: theta row
/// S^-1 row' for banded lines, theta Re row held_force row for condensed ones.
class StepCompliance {
 public:
  StepCompliance(const Model& model, const std::vector<PackedLine>& lines);
  /// At places along the first elements, on a ring those in which the traffic stands, m/N;
  /// [elements][points + 1].
  std::vector<double> table(const LoadPoint& load_point, int points, std::int32_t elements) const;

 private:
  const Model& model_;
  const std::vector<PackedLine>& lines_;
  std::vector<LocalInverse> inverse_;  // of banded lines
};

}  // namespace railstep
