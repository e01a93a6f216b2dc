#pragma once
#include <Eigen/SparseLU>
#include <memory>
#include <vector>

#include "offline/receptance/receptance.h"

namespace railstep {

/// Receptance of the track as it stands: (K + i omega C - omega^2 M) u = f solved for each line
/// that the force moves, sparse and complex, ordered once; and the static error of the elements at
/// point forces inside them (residual_statics()).
class FullOrderReceptance : public Receptance {
 public:
  /// @param residual  false leaves out this error
  /// Throws Refused on an invalid track and on points off it.
  FullOrderReceptance(const Track& track, const Transfer& transfer, bool residual = true);
  Eigen::VectorXcd at(double hz) override;

 private:
  using Matrix = Eigen::SparseMatrix<std::complex<double>>;
  struct Part {
    Line line;
    Eigen::VectorXcd force;
    Eigen::MatrixXd reads;  // [reads][unknowns]
    Eigen::SparseLU<Matrix> factor;
  };
  Eigen::VectorXd residual_;  // [reads] m/N
  std::vector<std::unique_ptr<Part>> parts_;
};

/// Rows of the reads over the unknowns of a line; [reads][unknowns].
Eigen::MatrixXd read_rows(const Track& track, const Line& line, const Transfer& transfer);

}  // namespace railstep
