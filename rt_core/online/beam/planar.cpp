#include "online/beam/planar.h"

#include "online/beam/straight_batch.h"

namespace railstep {

void planar_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                   double* force) noexcept {
  straight::batch_forces<straight::Planar>(beam, n, q, half_change, force);
}

void planar_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                     double* force, double* tangent) noexcept {
  straight::batch_tangents<straight::Planar>(beam, n, q, half_change, force, tangent);
}

}  // namespace railstep
