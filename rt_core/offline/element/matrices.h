#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "offline/element/energy.h"
#include "offline/element/shape.h"

namespace railstep {

using Matrix27 = Eigen::Matrix<double, 27, 27>;

/// Constants of a section symmetric about its vertical axis, about its centroid.
struct BeamSection {
  double area;                 // A, m2
  double inertia_y;            // about the horizontal axis: vertical bending, m4
  double inertia_z;            // about the vertical axis: lateral bending, m4
  double torsion;              // J of Saint-Venant, m4
  double shear_factor_y = 1.;  // lateral, on 2E12
  double shear_factor_z = 1.;  // vertical, on 2E13
  double shear_centre_z = 0.;  // of the shear centre above the centroid, m
  /// To degree 4, about the centroid, as the rule integrates them. The linear element at rest does
  /// not need degrees 3 and 4.
  std::optional<SectionMoments> moments = std::nullopt;
};

/// The law of an element whose reference line lies `axis_z` (m) above the centroid. A section
/// without moments of its own has none above degree 2, which suits the linear element only.
BeamLaw beam_law(const BeamSection& section, const Material& material, const ElementRule& rule = {},
                 double axis_z = 0., double axial_force = 0.);

/// Constant matrices of the straight quadratic 3-node ANCF element at its reference state.
/// Unknowns: nodes at xi = -1, 0, +1, each [r, a, b] = [position, slope in y, slope in z].
struct ElementMatrices {
  Matrix27 mass;       // Eq. 12; kg, kg m, kg m2
  Matrix27 stiffness;  // K_r of Eq. 24 at the straight state, preload in it; N/m, N, N m
  Vector27 line_load;  // nodal forces of 1 N/m in +z on the centroid, m
};

/// @param length  m, > 0
ElementMatrices element_matrices(const BeamSection& section, const BeamLaw& law, double length);

}  // namespace railstep
