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
  double part = 1.;  // of it that the track's unknowns have, where they lack the section's squeeze
};

/// What the displacements of a track's unknowns count in a functional.
double part_in(const Track& track, const Functional& functional);

/// What opens a pad: its rail's seat over the sleeper, or over the ground, along the pad's normal,
/// which is the rail's own z; the mean of one that has a length. Where the unknowns lack the
/// section's squeeze, their part of it is what part_of_pad() says.
Functional pad_gap(const Track& track, int rail, int seat);

/// The two sides of a pad at a place y beside its rail's middle, along its normal: adds `factor`
/// times what the rail's underside over x does, or the top of the sleeper under the seat.
void add_underside(const Track& track, int rail, int seat, double x, double y, double factor,
                   Functional& to);
void add_sleeper_top(const Track& track, int rail, int seat, double y, double factor,
                     Functional& to);

/// Its coefficients over the unknowns of one line.
Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional);

}  // namespace railstep
