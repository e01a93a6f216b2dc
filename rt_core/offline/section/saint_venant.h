#pragma once

#include <array>
#include <vector>

#include "offline/math/refuse.h"
#include "offline/section/section.h"

namespace railstep {

/// Cowper's factor of a section is not between 0 and 1.
struct NoShearFactor : Refused {
  NoShearFactor()
      : Refused("E-SECTION-30",
                "Cowper's shear factor of this section is not between 0 and 1; use a Poisson's "
                "ratio of "
                "0, which makes it the factor of the shear energy, or give the shear factors") {}
};

/// Saint-Venant torsion and flexure of a solid section, by quadratic finite elements on its right
/// half. Heights are above the polygon's lowest point, the foot.
///
/// Torsion about the centroid, warping w: lap(w) = 0, dw/dn = n_y z - n_z y, and
///   J = int (w,y - z)^2 + (w,z + y)^2 dA  (from above);
/// stress function p: lap(p) = -2, p = 0 outside, J = 2 int p dA (from below). The mean of the two
/// is returned; the mesh is refined until they agree to 1e-4, so J is proved to 5e-5.
///
/// Shear centre (Trefftz 1935, ZAMM 15, 220: shear and torsion energies uncoupled), above the
/// centroid: z_s = (1/I_z) int w y dA, I_z = int y^2 dA. It does not depend on nu.
///
/// Shear factor (Cowper 1966, J. Appl. Mech. 33, 335), p along the force, q across it:
///   k = 2 (1 + nu) I_p / (nu/2 (I_q - I_p) - (A/I_p) int p (chi + p q^2) dA),
/// with I_p = int p^2 dA, I_q = int q^2 dA and the flexure function chi: lap(chi) = 0,
///   dchi/dn = -n_p (nu/2 p^2 + (1 - nu/2) q^2) - n_q (2 + nu) p q.
///
/// @param polygon  counter-clockwise (y, z) in m, simple, symmetric about y = 0, which it meets
///                 twice; first point not repeated; re-entrant corners allowed
/// @param poisson  nu of the material, -1 < nu <= 0.5
/// @throws Refused when polygon or poisson is not as above;
///         NoShearFactor when Cowper's lateral factor leaves (0, 1], as it can with nu > 0 for
///         sections far from symmetric about their horizontal axis (with nu = 0 it is the energy's
///         factor)
SaintVenant saint_venant(const std::vector<std::array<double, 2>>& polygon, double poisson);

/// Torsion of a section that may be unsymmetric.
struct Twist {
  double torsion;              // J, m4
  double shear_centre_y;       // of the polygon's own coordinates, m
  double shear_centre_height;  // above its lowest point, m
};

/// Torsion constant, as proved as that of saint_venant(), and Trefftz's shear centre of any simple
/// outline, on the whole section. With the warping w about the centroid, I_yz = int y z dA and
/// I_y = int z^2 dA, the warping about the centre, w - z_s y + y_s z, has no moment with y nor z:
///   I_z z_s - I_yz y_s = int w y dA,   I_yz z_s - I_y y_s = int w z dA.
/// There are no shear factors, because Cowper's hold for forces along an axis of symmetry.
/// @throws Refused as saint_venant, except for the symmetry
Twist twist(const std::vector<std::array<double, 2>>& polygon);

}  // namespace railstep
