#pragma once
#include "online/beam/beam.h"
#include "online/math/vector3.h"

namespace railstep {

/// Strain energy of an element, J, at rest 0: beam_force() is its gradient. A step needs forces
/// alone, so only tests sum it.
/// @param q  [27]
inline double beam_energy(const Beam& beam, const double* q) noexcept {
  double energy = 0.;
  for (int g = 0; g < beam.points; ++g) {
    const BeamPoint& p = beam.point[g];
    const auto along = [q](const double* factor, int field) {
      const double* const first = q + 3 * field;
      return factor[0] * vector3(first) + factor[1] * vector3(first + 9) +
             factor[2] * vector3(first + 18);
    };
    const Vector3 V[5] = {along(p.slope, 0), along(p.slope, 1), along(p.slope, 2),
                          along(p.value, 1), along(p.value, 2)};
    double s[kProducts];
    for (int k = 0; k < kProducts; ++k) {
      const int i = kProductOf[k][0], j = kProductOf[k][1];
      s[k] = (i == j ? .5 : 1.) * dot(V[i], V[j]) - p.rest[k];
    }
    for (int k = 0; k < kProducts; ++k) {
      double stress = p.preload[k];
      for (int l = 0; l < kProducts; ++l) stress += p.stiffness[l][k] * s[l];
      energy += .5 * (p.preload[k] + stress) * s[k];
    }
  }
  return energy;
}

}  // namespace railstep
