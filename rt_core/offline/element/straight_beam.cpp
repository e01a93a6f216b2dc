#include "offline/element/straight_beam.h"

#include <string>

#include "offline/math/refuse.h"

namespace railstep {

StraightBeam straight_beam(const BeamLaw& law, double length) {
  if (!(length > 0.))
    refuse("E-ELEMENT-04", "the length of a straight element is " + std::to_string(length) +
                               " m; expected above 0");
  const int coupling_points = law.rule.coupling_points;
  if (law.rule.axial_points != 2 || (coupling_points != 0 && coupling_points != 2))
    refuse("E-ELEMENT-05",
           "the straight element has two points for all strains; expected axial_points = 2 and "
           "coupling_points = 0 or 2");
  const BeamPoint point = straight_point(law, length / 2.);

  StraightBeam beam{};
  beam.per_length = 1. / length;
  for (int k = 0; k < kProducts; ++k) {
    const int p = straight_preload(k);
    if (p >= 0) beam.preload[p] = point.preload[k];
    bool fits = p >= 0 || point.preload[k] == 0.;
    for (int l = 0; l < kProducts; ++l) {
      const int c = straight_constant(k, l);
      if (c >= 0) beam.stiffness[c] = point.stiffness[k][l];
      fits = fits && (c >= 0 || point.stiffness[k][l] == 0.);
    }
    if (!fits)
      refuse("E-ELEMENT-06",
             "the section of a straight element is not symmetric about y = 0; expected a symmetric "
             "section");
  }
  return beam;
}

std::array<double, 4> chain_mass(const BeamSection& section, const BeamLaw& law) {
  const double z = law.moments.centroid_z(), density = law.material.density;
  return {density * section.area, density * section.inertia_z,
          density * (section.inertia_y + z * z * section.area), density * z * section.area};
}

}  // namespace railstep
