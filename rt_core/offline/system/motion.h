#pragma once
#include <vector>

#include "offline/system/multibody.h"
#include "online/model/system.h"

namespace railstep {

/// A motion as pieces of polynomials: starts [pieces], coefficients [pieces][kMotionCoefficients].
struct MotionPieces {
  std::vector<double> start, coefficient;
};

/// Throws Refused unless there is either a polynomial of 1 to 6 coefficients or a
/// table of 2 rows or more with rising times.
MotionPieces motion_pieces(const Motion& motion);

}  // namespace railstep
