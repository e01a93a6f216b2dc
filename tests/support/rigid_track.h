#pragma once
#include "support/sections.h"

namespace railstep {

/// Rails that hardly move: 800 t/m on seats a million times stiffer than a contact.
inline Track rigid_track() {
  Track t = paper_track();
  t.section.area = 100.;
  t.section.inertia_y = t.section.inertia_z = 10.;
  t.section.torsion = 20.;
  t.section.shear_factor_y = t.section.shear_factor_z = 1.;
  t.section.shear_centre_z = 0.;
  t.support.stiffness = {1e15, 1e15, 1e15};
  t.support.damping = {};
  t.support.roll_stiffness = 1e15;
  t.support.roll_damping = 0.;
  return t;
}

}  // namespace railstep
