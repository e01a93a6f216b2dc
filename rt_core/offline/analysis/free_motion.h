#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

#include "offline/track/fixed_port.h"

namespace railstep {

/// Whether a factored stiffness holds everything: all pivots are above 1e-12 of their diagonal.
/// (Those of a long beam fall with the cube of its elements; round-off leaves 1e-15.)
bool is_held(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factor,
             const Eigen::SparseMatrix<double>& stiffness);

/// Lines of a track one behind the other.
struct JoinedLines {
  std::vector<Eigen::Index> first;        // [lines + 1] where a line's unknowns begin
  Eigen::SparseMatrix<double> stiffness;  // without one-sided springs
  Eigen::SparseMatrix<double> closing;    // [unknowns][ports] how far each port closes
};
JoinedLines join(const Track& track, const std::vector<Line>& lines,
                 const std::vector<FixedPort>& ports);

/// Throws Refused if lines of a track have a free rigid mode with all ports closed. Names the
/// rails, how they move and where, and the keys of a scene that would hold them; if no key is
/// found, the unknown that nothing holds.
/// @param ports  empty: one-sided springs are open, as in a condensed track
void refuse_free_modes(const Track& track, const std::vector<Line>& lines,
                       const std::vector<FixedPort>& ports);

}  // namespace railstep
