#include "online/patch/creep.h"

#include "online/math/scalar.h"
#include "online/patch/fastsim.h"

namespace railstep {

namespace {

using Rate = Dual<3>;

template <class Real>
CreepPair<Real> pair_of(CreepLaw law, const CreepPatch& patch, const Creepages<Real>& c) noexcept {
  if (law == CreepLaw::linear) return creep::linear(patch, c);
  return law == CreepLaw::she ? creep::she(patch, c) : creep::polach(patch, c);
}

}  // namespace

CreepForce creep_force(CreepLaw law, int strips, const CreepPatch& patch,
                       const Creepages<double>& creepages, CreepWanted wanted) noexcept {
  if (law == CreepLaw::fastsim) return fastsim(patch, creepages, strips, wanted);
  if (wanted == CreepWanted::force) {
    const CreepPair<double> force = pair_of(law, patch, creepages);
    return {force.x, force.y, {}};
  }
  const Creepages<Rate> c{Rate::along(0, creepages.along), Rate::along(1, creepages.across),
                          Rate::along(2, creepages.spin)};
  const CreepPair<Rate> force = pair_of(law, patch, c);
  CreepForce found{force.x.value, force.y.value, {}};
  for (int k = 0; k < 3; ++k) {
    found.slope[0][k] = force.x.slope[k];
    found.slope[1][k] = force.y.slope[k];
  }
  return found;
}

CreepPatch normalised_patch(double ratio, const Kalker& kalker) noexcept {
  const double root = square_root(ratio);
  return {root, 1. / root, 1., 1., kalker};
}

Creepages<double> normalised_creepages(double x, double e, double p) noexcept {
  return {.25 * x, .25 * e, .5 * p};
}

}  // namespace railstep
