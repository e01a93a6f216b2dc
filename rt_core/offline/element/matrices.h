#pragma once
#include <Eigen/Core>
#include <array>

namespace railstep {

using Matrix27 = Eigen::Matrix<double, 27, 27>;
using Vector27 = Eigen::Matrix<double, 27, 1>;

/// Isotropic linear elastic material.
struct Material {
  double young = 210e9;    // E, Pa
  double poisson = 0.3;    // nu
  double density = 7850.;  // kg/m3
  double shear_modulus() const { return young / (2. * (1. + poisson)); }
};

/// Constants of a section symmetric about its vertical axis, about its centroid, which is the
/// reference line of the element.
struct BeamSection {
  double area;                 // A, m2
  double inertia_y;            // about the horizontal axis: vertical bending, m4
  double inertia_z;            // about the vertical axis: lateral bending, m4
  double torsion;              // J of Saint-Venant, m4
  double shear_factor_y = 1.;  // lateral, on 2E12
  double shear_factor_z = 1.;  // vertical, on 2E13
  double shear_centre_z = 0.;  // of the shear centre above the centroid, m
};

/// How shear strains are weighted over the section.
enum class ElasticLaw {
  corrected,  // shear factors, J on the twist alone, shear at the shear centre
  paper       // as published: all factors 1, no split; torsional stiffness G(Iy + Iz)
};

/// Constant matrices of the straight quadratic 3-node ANCF element at its reference state.
/// Unknowns: nodes at xi = -1, 0, +1, each [r, a, b] = [position, slope in y, slope in z].
struct ElementMatrices {
  Matrix27 mass;       // kg, kg m, kg m2
  Matrix27 stiffness;  // N/m, N, N m
  Vector27 line_load;  // nodal forces of 1 N/m in +z on the axis, m
};

/// Shape functions N1, N2, N3 of Eq. 22 at xi in [-1, 1], and their derivatives by xi.
std::array<double, 3> shape(double xi);
std::array<double, 3> shape_slope(double xi);

/// Mass matrix (Eq. 12) and tangent stiffness (Eq. 18, 24) at the unstrained straight state.
///
/// Energy per length, with e = r_x', g12 = 2E12, g13 = 2E13 and gradients over the section:
///   E (A e^2 + Iz a_x'^2 + Iy b_x'^2 + A a_y^2 + A b_z^2)/2 + G A (a_z + b_y)^2/2
///   + G/2 [A (k_y g12(s)^2 + k_z g13(s)^2) + Iz (d_y g12)^2 + Iys (d_z g13)^2
///          + (Iz + Iys) m^2 + J t^2]  + A/2 n' Dv n,  n = (e, a_y, b_z),
/// with t = (d_y g13 - d_z g12)/2 the twist, m = (d_y g13 + d_z g12)/2, Iys = Iy + A z_s^2 and
/// g(s) taken at the shear centre. Only the twist carries J. Dv, the Poisson coupling, acts at
/// the centroid.
/// @param length m, > 0
/// @param axial_points Gauss points along xi for D0 and Dv alike, 1..5; two neither locks nor
///   leaves spurious zero modes
ElementMatrices element_matrices(const BeamSection& section, const Material& material,
                                 double length, ElasticLaw law = ElasticLaw::corrected,
                                 int axial_points = 2);

/// The 27 coefficients that give component `direction` (0 x, 1 y, 2 z) of the displacement of the
/// material point (xi, y, z), y and z in m from the axis.
Vector27 point_row(double xi, double y, double z, int direction);

}  // namespace railstep
