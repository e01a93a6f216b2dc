#pragma once
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Picks unknowns: [unknowns][chosen] with a 1 in each column.
Eigen::SparseMatrix<double> picks(int unknowns, const std::vector<int>& chosen);

/// A line's undamped motion over the unknowns that carry mass; the others (a sleeper of 0 kg)
/// follow them without inertia, which leaves out no mode.
struct MassiveLine {
  Eigen::SparseMatrix<double> mass, stiffness;  // symmetric, both triangles stored
  Eigen::SparseMatrix<double> follow;           // [unknowns of the line][unknowns kept]
};

/// Condenses unknowns without mass exactly: u_s = -K_ss^-1 K_sr u_r. A line without such unknowns
/// is returned unchanged. Throws Refused if nothing holds such an unknown.
MassiveLine without_massless(const Line& line);

}  // namespace railstep
