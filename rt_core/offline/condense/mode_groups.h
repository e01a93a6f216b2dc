#pragma once
#include <Eigen/SparseCore>
#include <vector>

#include "offline/condense/modal.h"

namespace railstep {

/// Damped modes of a line whose coordinates fall into groups that do not couple: the waves of a
/// ring, or a single group for any other line. Coordinates and modes of the groups follow one
/// another.
class ModeGroups {
 public:
  ModeGroups() = default;
  ModeGroups(std::vector<DampedModes> groups);  // NOLINT: a list of them is one
  ModeGroups(DampedModes all) : ModeGroups(std::vector<DampedModes>{std::move(all)}) {}  // NOLINT

  const Eigen::VectorXcd& rate() const { return rate_; }  // [modes] 1/s
  /// shape' f, [modes], of forces over the coordinates.
  Eigen::VectorXcd project(const Eigen::VectorXd& force) const;
  /// y = Re shape z, [coordinates].
  Eigen::VectorXd displacement(const Eigen::VectorXcd& z) const;
  /// The z of the static y under forces, and of y', as in DampedModes.
  Eigen::VectorXcd from(const Eigen::VectorXd& force, const Eigen::VectorXd& velocity) const;
  Eigen::SparseMatrix<std::complex<double>> shape() const;  // [coordinates][modes]
  Eigen::SparseMatrix<double> damping() const;              // [coordinates][coordinates] 1/s

 private:
  std::vector<DampedModes> groups_;
  Eigen::VectorXcd rate_;
  Eigen::Index coordinates_ = 0;
};

}  // namespace railstep
