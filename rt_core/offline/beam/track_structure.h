#pragma once
#include <array>
#include <vector>

#include "offline/beam/structure.h"
#include "offline/math/constants.h"
#include "offline/track/functional.h"
#include "offline/track/track.h"

namespace railstep {

/// A track as a nonlinear structure in plain coordinates: positions and slopes of the left rail's
/// nodes along its own axes, then of the right rail's, then the displacements of the sleepers' ends
/// along the track's. Springs act between material points of rail and sleeper (or ground) and keep
/// their directions, as the supports of assemble() do: at rest the tangent is the stiffness of its
/// lines.
class TrackStructure {
 public:
  /// Throws Refused as assemble() does, and if the track's unknowns are not Unknowns::full: a rail
  /// that shortens as it bends moves along x too. An axial force needs ends that hold it, or the
  /// rail would not be in equilibrium at rest.
  explicit TrackStructure(const Track& track);

  const Structure& structure() const { return structure_; }
  /// Coefficients of the displacement of a material point, or of a weighted sum of them, over the
  /// changes of the unknowns from rest. Transposed, they spread a unit force.
  /// Throws Refused off the rail.
  Eigen::SparseVector<double> row(const RailPoint& point) const;
  Eigen::SparseVector<double> row(const Functional& functional) const;
  /// Positions of rails and sleepers. In a symmetric track both sides take those of the left one;
  /// without a cant they stay in its upright plane. Sections sag straight down there, and a lateral
  /// position by round-off would couple vertical and lateral motion.
  TrackState state(const Eigen::VectorXd& q) const;
  /// Nodal forces of the rails' and sleepers' own weight. @param gravity m/s2, > 0 down
  Eigen::VectorXd weight(double gravity = kGravity) const;

 private:
  Track track_;
  Structure structure_;
  /// [seats] of each rail; x, y, z of the sleeper's end under it and its turn about y, -1 where
  /// held. y and the turn are one for both.
  std::array<std::vector<std::array<int, 4>>, 2> sleeper_;

  int place(int rail, int node, int k) const { return 9 * (rail * track_.nodes() + node) + k; }
  int number_sleepers(int first);
  void lay_rails();
  void add_seat(int rail, int seat);
  void add_ballast(int seat);
};

}  // namespace railstep
