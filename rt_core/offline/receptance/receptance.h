#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "offline/track/functional.h"

namespace railstep {

/// A transfer: the displacements `reads` under a force of 1 N spread by `force`.
struct Transfer {
  Functional force;
  std::vector<Functional> reads;
};

/// Receptances of a track for one transfer: displacement over force, both times e^(+i omega t).
class Receptance {
 public:
  Receptance() = default;
  virtual ~Receptance() = default;
  Receptance(const Receptance&) = delete;
  Receptance& operator=(const Receptance&) = delete;

  /// Receptance of every read at a frequency of 0 Hz or more; [reads], m/N. Throws Failed at a
  /// frequency at which the track swings without damping.
  virtual Eigen::VectorXcd at(double hz) = 0;
};

/// A point of a rail, a functional of its own.
inline Functional rail_point(const RailPoint& at) { return {.rail = {{at, 1.}}}; }

}  // namespace railstep
