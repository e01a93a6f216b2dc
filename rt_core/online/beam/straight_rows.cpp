#include "online/beam/planar.h"
#include "online/beam/straight_batch.h"

namespace RAILSTEP_KERNELS {

using straight::Planar, straight::Spatial;

void straight_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                     double* force) noexcept {
  straight::batch_forces<Spatial>(beam, n, q, half_change, force);
}

void straight_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                       double* force, double* tangent) noexcept {
  straight::batch_tangents<Spatial>(beam, n, q, half_change, force, tangent);
}

void planar_forces(const StraightBeam& beam, int n, const double* q, const double* half_change,
                   double* force) noexcept {
  straight::batch_forces<Planar>(beam, n, q, half_change, force);
}

void planar_tangents(const StraightBeam& beam, int n, const double* q, const double* half_change,
                     double* force, double* tangent) noexcept {
  straight::batch_tangents<Planar>(beam, n, q, half_change, force, tangent);
}

}  // namespace RAILSTEP_KERNELS
