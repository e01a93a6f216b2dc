#pragma once
#include <vector>

#include "offline/condense/reduction.h"
#include "offline/receptance/receptance.h"

namespace railstep {

/// Receptance of the condensed track: every line that the force moves in its damped modes, the sum
/// of shape shape' / (i omega - rate) / 2 and of the conjugates, and the static error of the modes
/// (residual_statics()).
class CondensedReceptance : public Receptance {
 public:
  /// @param reduction  of each line
  /// @param residual  false leaves out this error
  /// Throws Refused as reduce() does.
  CondensedReceptance(const Track& track, const Transfer& transfer, const Reduction& reduction,
                      bool residual = true);
  Eigen::VectorXcd at(double hz) override;
  /// Coordinates kept, of all lines that the force moves.
  int kept() const;

 private:
  struct Part {
    Eigen::VectorXcd rate;   // [modes]
    Eigen::MatrixXcd gains;  // [reads][modes], read of the shape times its part of the force
    int kept;
  };
  Eigen::VectorXd residual_;  // [reads] m/N
  std::vector<Part> parts_;
};

}  // namespace railstep
