#pragma once
#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <complex>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Q(rate) = rate^2 M + rate C + K: the forces that sustain a motion Re (shape e^(rate t)).
Eigen::SparseMatrix<std::complex<double>> dynamic_stiffness(const Line& line,
                                                            std::complex<double> rate);

/// Arnoldi's method for the damped motions of a line whose rates lie nearest to a shift, over
/// [u, v/|shift|] in first-order form: u' = v, M v' = -K u - C v. One factorisation of Q(shift);
/// M may be singular.
class Krylov {
 public:
  struct Ritz {
    std::complex<double> rate;  // 1/s
    Eigen::VectorXcd shape;     // [unknowns], of Euclidean norm 1
    double error;               // estimated, of the rate over its size
  };

  /// Throws Failed if Q(shift) is singular.
  Krylov(const Line& line, std::complex<double> shift);

  /// Adds vectors up to `size` of them; fewer where the space is exhausted.
  void grow(Eigen::Index size);
  /// Whether the space holds every finite rate.
  bool complete() const { return complete_; }
  /// Ritz pairs of the space with rates within `radius` of the shift.
  std::vector<Ritz> within(double radius) const;

 private:
  Eigen::VectorXcd apply(const Eigen::VectorXcd& state) const;  // (A - shift)^-1

  const Line& line_;
  std::complex<double> shift_;
  double scale_;  // 1/s
  Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>> factor_;
  Eigen::MatrixXcd basis_, projection_;  // [2 unknowns][size + 1], [size + 1][size]
  Eigen::Index size_ = 0;
  bool complete_ = false;
};

}  // namespace railstep
