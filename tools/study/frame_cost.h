#pragma once
#include <cstdint>
#include <memory>

#include "run/simulation.h"

namespace railstep {

/// The cost of a frame, by clock and by count.
struct FrameCost {
  double us = 0.;                     // median of the repeats' medians
  double least = 0., most = 0.;       // of these medians, us
  std::int64_t flops = 0, bytes = 0;  // the model's bound, Model::cost
};

/// Times models in turn with one that stays the same, so that a machine that slows down for a while
/// slows down both: what a model takes is its ratio to that one, times what that one took at first.
class Timing {
 public:
  /// @param steady  of the scene as it stands
  explicit Timing(std::unique_ptr<Simulation> steady);
  /// kRepeats times from the start, kWindow of it each. Leaves the run at its start.
  FrameCost cost_of(Simulation& run);

  static constexpr int kRepeats = 5;
  static constexpr double kWindow = 4e3;  // us, more where a frame takes longer

 private:
  std::unique_ptr<Simulation> steady_;
  double first_ = 0.;  // us a frame
};

}  // namespace railstep
