#pragma once
#include "offline/section/rectangles.h"
#include "offline/track/track.h"

namespace railstep {

/// Section F of the reference numbers: the exact three-rectangle fit for H = 185.7375 mm.
inline BeamSection section_f() {
  return {.area = 8700e-6,
          .inertia_y = 39.0e-6,
          .inertia_z = 6.0e-6,
          .torsion = 1.9514e-6,
          .shear_factor_y = .4796,
          .shear_factor_z = .4721,
          .shear_centre_z = -.0391};
}

/// Rectangles of section F, m.
inline const Rectangles<double> kSectionF = {{.1380985536, .02522171327, .07720505094},
                                             {.020996636, .13308941227, .03165145173}};

/// R60 as in the benchmarks of rail-data.md, section 3.
inline BeamSection r60_section() {
  return {.area = 7670e-6,
          .inertia_y = 3038.3e-8,
          .inertia_z = 512e-8,
          .torsion = 221e-8,
          .shear_factor_y = .4,
          .shear_factor_z = .4};
}

/// Rectangle of the peers' moving-load scene, 231.9 mm high and 37.5 mm wide, k = .8497 for both
/// directions, J by the series of Saint-Venant.
inline BeamSection peers_rectangle() {
  const double h = .2319, b = .0375;
  return {.area = h * b,
          .inertia_y = b * h * h * h / 12.,
          .inertia_z = h * b * b * b / 12.,
          .torsion = h * b * b * b / 3. * (1. - .63 * b / h),
          .shear_factor_y = .8497,
          .shear_factor_z = .8497};
}

/// The track of the paper's Table 3, with the additions of reference.md: seats on the axis, free
/// ends.
inline Track paper_track() {
  Track t;
  t.section = section_f();
  t.rail_spacing = 1.;
  t.bays = 4;
  t.bay_length = 1.6;
  t.elements_per_bay = 1;
  t.support.stiffness = {3e6, 1.4e9, 3e6};
  t.support.damping = {3e4, 29e6, 3e4};
  t.support.roll_stiffness = 1e6;
  t.support.roll_damping = 1e3;
  return t;
}

}  // namespace railstep
