#pragma once
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// A weighted sum of displacements of rail points and sleepers.
struct Functional {
  struct OnRail {
    RailPoint at;
    double factor;
  };
  struct OnSleeper {
    int rail, seat, direction;  // the sleeper's end under that rail; 0 x, 1 y, 2 z, 3 turn about y
    double factor;
  };
  std::vector<OnRail> rail = {};
  std::vector<OnSleeper> sleeper = {};
};

/// What opens a pad: its rail's seat over the sleeper's end, or over the ground, along z; the mean
/// of one that has a length.
Functional pad_gap(const Track& track, int rail, int seat);

/// Its coefficients over the unknowns of one line.
Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional);

}  // namespace railstep
