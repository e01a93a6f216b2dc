#pragma once

namespace railstep {

/// Area properties of a section symmetric about its vertical axis; z from the foot's underside.
template <typename T>
struct AreaProperties {
  T area;             // A, m2
  T centroid_height;  // above the foot, m
  T inertia_y;        // about the horizontal centroidal axis (vertical bending), m4
  T inertia_z;        // about the vertical axis (lateral bending), m4
};

/// Constants that need the solution of a Saint-Venant problem on the section.
struct SaintVenant {
  double torsion;              // J, m4
  double shear_factor_y;       // k_y, lateral, Cowper (1966)
  double shear_factor_z;       // k_z, vertical, Cowper (1966)
  double shear_centre_height;  // above the foot, m; Trefftz's definition
};

/// Properties of a section that a linear element needs; the reference line is the centroid.
struct Section {
  AreaProperties<double> area;
  SaintVenant shear;
  double height;  // foot to head top, m
};

}  // namespace railstep
