#pragma once
#include <Eigen/Cholesky>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Equal elements in a row, over d unknowns per node, seen from their two end nodes: the inner
/// nodes, with no force on them, follow the ends.
class Superelement {
 public:
  /// Displacements at some places of the chain.
  struct Rows {
    Eigen::MatrixXd ends;   // [places][2d] under unit displacements of the ends, inner nodes free
    Eigen::MatrixXd inner;  // [places][inner unknowns] coefficients of the inner nodes alone
  };

  /// One element of a rail of the track divided into `parts`.
  /// @param track  must outlive it
  /// @param carried unknowns of a node, 0 to 8, ascending; d of them. Where sections do not
  ///                strain, 5 is their roll, and 7 is not among them
  Superelement(const Track& track, int rail, std::vector<int> carried, int parts);

  int parts() const { return parts_; }
  const std::vector<int>& carried() const { return carried_; }
  /// Stiffness between the unknowns of the two end nodes, N/m; [2d][2d].
  const Eigen::MatrixXd& stiffness() const { return stiffness_; }

  /// Coefficients over all unknowns of the chain of a material point's displacement.
  /// @param place  0 to parts, from the first end
  /// @param cant   of the point's rail, which may be this one's mirror image
  /// @param y,z    over the section, from the axis, m
  /// @param direction 0 x, 1 y, 2 z of the track
  Eigen::VectorXd row(double place, const Cant& cant, double y, double z, int direction) const;
  /// @param rows [places][unknowns of the chain], each as row() gives it
  Rows condense(const Eigen::MatrixXd& rows) const;
  /// Flexibility between places with both ends held, m/N; [places of a][places of b].
  Eigen::MatrixXd held(const Rows& a, const Rows& b) const;

 private:
  const Track& track_;
  int parts_;
  std::vector<int> carried_, ends_, inner_;
  Eigen::LDLT<Eigen::MatrixXd> factor_;  // of the inner nodes' stiffness
  Eigen::MatrixXd follow_;               // [inner][2d] inner nodes under unit end displacements
  Eigen::MatrixXd stiffness_;
};

}  // namespace railstep
