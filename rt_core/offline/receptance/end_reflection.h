#pragma once
#include <Eigen/Core>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Reflection of a wave that runs along a uniform track towards its far end.
struct Reflection {
  double decay;  // of the wave over a bay, |e^(-gamma bay)|, far from the end
  double back;   // amplitude that returns over amplitude that arrives, at the end's zone
};

/// Reflection at the far end of one line of a track, by the line's own matrices. Bays far from the
/// end, joined without end, make the dynamic stiffness Z of an endless track at its border nodes (a
/// half seat at each border). The bays of the zone make that of the end, Z_e. Displacements u that
/// arrive and v that go back add up, and their forces balance,
///   (Z_e + S Z S) v = (Z - Z_e) u,   S the mirror along x,
/// and the waves are the eigenvectors of the map of u over one bay. The wave that a point force
/// sends farthest is taken.
class EndReflection {
 public:
  /// @param direction  of the force that sends the wave: 1 y, 2 z
  /// Throws Refused on a track that is not uniform (seats, rails, pads with lengths)
  /// or bent by its weight, on a line that does not carry the direction, and on a far end that is
  /// held.
  EndReflection(const Track& track, const Line& line, int direction);
  /// @param hz above 0. Throws Failed if waves run undamped.
  Reflection at(double hz) const;

 private:
  /// Forces over displacements at both borders of a part of the rail; [2d][2d].
  Eigen::MatrixXcd bay(double omega, int number) const;
  Eigen::MatrixXcd half_seat(double omega) const;
  Eigen::MatrixXcd end(double omega, const Eigen::MatrixXcd& half) const;

  Track track_;
  Line line_;
  std::vector<int> carried_;  // unknowns of a node
  Eigen::VectorXd mirror_;    // their signs in S
  Eigen::Index driven_;       // among carried_
  ElementMatrices element_;
  int zone_;  // first bay beyond the place where the wave is taken
};

}  // namespace railstep
