#pragma once
#include "offline/track/track.h"
#include "support/sections.h"

namespace railstep {

/// R6 of hard-cases.md: one rail of section F, k_z .472, on springs of 3e7 N/m, 40 bays of 0.6 m.
inline Track r6_track(double damping = 0.) {
  Track t;
  t.section = section_f();
  t.section.shear_factor_z = .472;
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.bays = 40;
  t.support.stiffness = {0., 0., 3e7};
  t.support.damping = {0., 0., damping};
  return t;
}

/// rail-data.md, set S1: one rail R60, pad 200 MN/m and 20 kN s/m, ballast 50 and 80.
inline Track s1_rail(int bays = 40) {
  Track t;
  t.rails = 1;
  t.unknowns = Unknowns::vertical;
  t.section = r60_section();
  t.bays = bays;
  t.support.stiffness = {0., 0., 200e6};
  t.support.damping = {0., 0., 20e3};
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}};
  return t;
}

}  // namespace railstep
