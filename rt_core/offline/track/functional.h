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
  double part = 1.;  // part that the unknowns have, if they do not have the squeeze
};

/// Factor of the displacements of a track's unknowns in a functional.
double part_in(const Track& track, const Functional& functional);

/// Opening of a pad: displacement of the rail's seat over the sleeper or the ground along the pad's
/// normal, which is the rail's own z; for a pad with a length, its mean. If the unknowns do not
/// have the squeeze of the section, part_of_pad() gives their part of the opening.
Functional pad_gap(const Track& track, int rail, int seat);

/// The two sides of a pad at a place y beside its rail's middle, along its normal: adds `factor`
/// times the displacement of the rail's underside over x, or of the sleeper's top under the seat.
void add_underside(const Track& track, int rail, int seat, double x, double y, double factor,
                   Functional& to);
void add_sleeper_top(const Track& track, int rail, int seat, double y, double factor,
                     Functional& to);

/// Its coefficients over the unknowns of one line.
Eigen::SparseVector<double> functional_row(const Track& track, const Line& line,
                                           const Functional& functional);

}  // namespace railstep
