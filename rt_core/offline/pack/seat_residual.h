#pragma once
#include <vector>

#include "offline/condense/flexibility.h"
#include "offline/pack/pack.h"
#include "online/contact/wheel_seat.h"

namespace railstep {

/// Residual flexibility of the seats under the wheels of all runners, ResidualModel::seat.
/// @param residual  that takes load points along y
/// @param wheel     load points of the model, to which those of the runners refer
std::vector<double> seat_residual(const ResidualFlexibility& residual, const Model& model,
                                  const std::vector<LoadPoint>& wheel);

/// The part of a track's flexibility under the seats of runners that its mesh misses. It does not
/// depend on how the model condenses the track.
class MeshResidual {
 public:
  /// @param track  at rest  @param lines  of it, those of the model
  MeshResidual(const PackedModel& packed, const Track& track, const std::vector<Line>& lines);
  MeshResidual(const MeshResidual&) = delete;
  MeshResidual& operator=(const MeshResidual&) = delete;

  SeatFlexibility under(std::int32_t runner, int side, const RailForce& place) const {
    return seat_flexibility(model_, model_.runner[runner], side, place);
  }

 private:
  Model model_;  // with these tables
  std::vector<double> under_, seats_;
};

}  // namespace railstep
