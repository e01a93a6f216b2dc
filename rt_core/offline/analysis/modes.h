#pragma once
#include <Eigen/Core>

#include "offline/track/track.h"

namespace railstep {

/// Undamped modes of one line: K phi = omega^2 M phi, phi' M phi = 1, lowest first.
struct Modes {
  Eigen::VectorXd frequency;  // Hz; free rigid modes come as 0
  Eigen::MatrixXd shape;      // [unknowns][modes], sign fixed: the largest entry is positive
};

/// All modes by a dense solution; for lines of up to some thousand unknowns. Unknowns without mass
/// follow the others: there are fewer modes by their number.
Modes modes(const Line& line);

/// The lowest modes, at most `count` of them, by shift-invert Lanczos beside the rigid ones. The
/// signs of the pivots of K - omega^2 M show whether a mode was missed; then a dense solution takes
/// over. Throws Failed if the line is too long for that.
Modes lowest_modes(const Line& line, int count);

/// How many modes of a held line lie below a frequency, Hz: by the same count.
int modes_below(const Line& line, double frequency);

}  // namespace railstep
