#pragma once
#include "offline/beam/structure.h"
#include "offline/track/track.h"

namespace railstep {

/// Eq. 24: dU/dq near a configuration q_s, f_s + K_r (q - q_s).
struct Linearised {
  Eigen::VectorXd force;                  // f_s, [unknowns]
  Eigen::SparseMatrix<double> stiffness;  // K_r, both triangles
};
Linearised linearised(const Structure& structure, const Eigen::VectorXd& q_s);

/// The track with the stiffness of the nonlinear element in its equilibrium under its own weight
/// and the preload of its rails, instead of that at rest. Throws Refused if no such equilibrium is
/// found (a free rigid mode, a buckled rail), and as TrackStructure does.
Track linearised_under_weight(Track track, double gravity);

}  // namespace railstep
