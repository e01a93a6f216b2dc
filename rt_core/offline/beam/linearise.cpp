#include "offline/beam/linearise.h"

#include "offline/analysis/statics.h"
#include "offline/beam/equilibrium.h"
#include "offline/beam/track_structure.h"
#include "offline/math/refuse.h"

namespace railstep {

Linearised linearised(const Structure& structure, const Eigen::VectorXd& q_s) {
  return {internal_force(structure, q_s), tangent(structure, q_s)};
}

Track linearised_under_weight(Track track, double gravity) {
  track.state.reset();
  const Statics held(track);  // refuses a free rigid mode by its name
  const TrackStructure rails(track);
  const Equilibrium found = equilibrium(rails.structure(), {rails.weight(gravity)});
  if (!found.converged)
    refuse("E-NONLINEAR-01",
           "no equilibrium of the track was found under its own weight and preload; expected less "
           "axial force, or stiffer supports");
  if (!is_stable(rails.structure(), found.q))
    refuse("E-NONLINEAR-02",
           "the track buckles under its own weight and preload; expected less axial force, or "
           "stiffer supports");
  track.state = rails.state(found.q);
  track.state->gravity = gravity;
  return track;
}

}  // namespace railstep
