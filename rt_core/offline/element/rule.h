#pragma once
#include "offline/math/constants.h"

namespace railstep {

/// Isotropic linear elastic material.
struct Material {
  double young = kSteelYoung;      // E, Pa
  double poisson = kSteelPoisson;  // nu
  double density = kSteelDensity;  // kg/m3
  double shear_modulus() const { return young / (2. * (1. + poisson)); }
};

/// Where the Poisson coupling Dv of the normal strains acts.
enum class Coupling {
  centroid,  // on the axis through the centroid, wherever the reference line lies
  axis,      // on the reference line, as Eq. 18 reads
  section,   // over the section: the unsplit law, which locks (Poisson locking)
  none       // left out: for sections that cannot strain, which it would stiffen
};

/// How the shear strains 2E12 and 2E13 are weighted over the section.
enum class Shear {
  twist,      // mean strains by the shear factors, J on the twist alone
  factors,    // the shear factors over the whole section: torsional stiffness of order G(Iy + Iz)
  offset,     // as twist, but 2E13 at the height of the shear centre, which couples it to b'b
  published,  // as published: all factors 1
};

/// How an element's energy is integrated and which strains are separated. The default neither locks
/// nor has spurious zero modes; the others serve comparisons.
struct ElementRule {
  int axial_points = 2;     // Gauss points along xi for D0, 1 to 5
  int coupling_points = 0;  // for Dv, 1 to 5; 0: those of D0
  Coupling coupling = Coupling::centroid;
  Shear shear = Shear::twist;
};

}  // namespace railstep
