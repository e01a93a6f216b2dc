#pragma once

#include "offline/element/rule.h"
#include "offline/element/shape.h"
#include "offline/section/moments.h"
#include "online/beam/beam.h"

namespace railstep {

/// Constants of the section in the energy of an element; z and moments about the reference line.
struct BeamLaw {
  SectionMoments moments;      // as integrated: those of a rule with too few points are not exact
  double torsion = 0.;         // J of Saint-Venant, m4
  double shear_factor_y = 1.;  // lateral, on 2E12
  double shear_factor_z = 1.;  // vertical, on 2E13
  double shear_centre_z = 0.;  // m
  Material material;
  ElementRule rule;
  double axial_force = 0.;  // of the element at rest, N, tension positive: a uniform stress
};

/// Nodes of a straight element of this length along x, from the origin, with unit slopes.
Vector27 straight_nodes(double length);

/// The energy of one element, ready to be evaluated.
///
/// Green-Lagrange strain over the shape at rest q0, whose lines j = [r', a', b' ...] may be curved,
/// twisted and skew: E = J0^-T (j'j - j0'j0) J0^-1 / 2, in the frame of the section at rest, along
/// its normal, a0, and across both. Energy per length, g12 = 2E12 and g13 = 2E13:
///   int (E (E11^2 + E22^2 + E33^2) + G (2E23)^2) dA / 2 + A n' Dv n / 2, n = (E11, E22, E33) at
///   the centroid, Dv = E nu/((1 + nu)(1 - 2 nu)) [2 nu 1 1; 1 2 nu 1; 1 1 2 nu],
///   + G/2 [A (k_y g12(s)^2 + k_z g13(c)^2) + Iz (d_y g12)^2 + Iy (d_z g13)^2
///          + (Iz + Iys) m^2 + J t^2],
/// with gradients at the centroid c, g12 at the shear centre s, t = (d_y g13 - d_z g12)/2 the
/// twist, m = (d_y g13 + d_z g12)/2, Iys = Iy + A (z_s - z_c)^2. Only the twist carries J. 2E13 is
/// taken at the centroid: the shear centre is on the axis of symmetry, so vertical shear has no
/// lever; with it there (Shear::offset) one element under an end load is not Timoshenko's beam.
///
/// On a curved element strains are not polynomials over the section; they and their squares are
/// cut at degree 4. With h half the height and R the radius of curvature, bending errs by 0.4
/// (h/R)^4 for a rectangle, by 0.2 (h/R)^3 for a rail about its centroid (3e-4 at h/R = 0.1) and by
/// 13 (h/R)^3 about its foot; energies of finite strain lose a term of first order, 2e-6 of them at
/// h/R = 0.003 and strains of 0.1. A curve of 100 m errs by 1e-8.
/// @param rest  nodes at rest, as the unknowns
/// @throws Refused on a rule out of its range, nodes that do not form a section (slopes of
///         one direction, no length) and a curvature radius under twice the section's extent
Beam beam_element(const BeamLaw& law, const Vector27& rest);

/// Rest, preload and stiffness at a point of a straight axis along x with unit slopes, free of the
/// round-off of shape functions; values and slopes are left 0.
/// @param weight  of the Gauss point times det J, m
BeamPoint straight_point(const BeamLaw& law, double weight);

}  // namespace railstep
