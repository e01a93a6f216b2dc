#include "offline/element/matrices.h"

#include <cmath>

#include "offline/element/shape.h"
#include "offline/math/gauss.h"

namespace railstep {

namespace {

/// A nodal field at one point of the axis, as a row over the 27 unknowns: the first of the three
/// components of r (0), a (3) or b (6).
Vector27 field_row(const std::array<double, 3>& n, int unknown) {
  Vector27 row = Vector27::Zero();
  for (int i = 0; i < 3; ++i) row[9 * i + unknown] = n[static_cast<std::size_t>(i)];
  return row;
}

/// K += w * row row', plain loops: Eigen's blocked products change bits with the processor.
void add_square(Matrix27& K, const Vector27& row, double w) {
  for (int j = 0; j < 27; ++j)
    if (row[j] != 0.)
      for (int i = 0; i < 27; ++i) K(i, j) += w * (row[i] * row[j]);  // exactly symmetric
}

}  // namespace

BeamLaw beam_law(const BeamSection& section, const Material& material, const ElementRule& rule,
                 double axis_z, double axial_force) {
  SectionMoments m;
  m.of[0][0] = section.area;
  m.of[2][0] = section.inertia_z;
  m.of[0][2] = section.inertia_y;
  const double up = section.shear_centre_z - axis_z;
  return {.moments = raised(section.moments.value_or(m), axis_z),
          .torsion = section.torsion,
          .shear_factor_y = section.shear_factor_y,
          .shear_factor_z = section.shear_factor_z,
          .shear_centre_z = up,
          .material = material,
          .rule = rule,
          .axial_force = axial_force};
}

ElementMatrices element_matrices(const BeamSection& section, const BeamLaw& law, double length) {
  ElementMatrices result{Matrix27::Zero(), Matrix27::Zero(), Vector27::Zero()};
  const Vector27 rest = straight_nodes(length);
  Vector27 force;  // of the preload; balanced by the next element's, or held
  beam_tangent(beam_element(law, rest), rest.data(), force.data(), result.stiffness.data());
  const double z = law.moments.centroid_z();
  for (const GaussPoint& p : gauss(3)) {  // degree 4: exact
    const auto n = shape(p.xi);
    const double w = p.weight * length / 2., density = law.material.density;
    for (int k = 0; k < 3; ++k) {
      const Vector27 r = field_row(n, k), a = field_row(n, 3 + k), b = field_row(n, 6 + k);
      add_square(result.mass, r + z * b, w * density * section.area);
      add_square(result.mass, a, w * density * section.inertia_z);
      add_square(result.mass, b, w * density * section.inertia_y);
    }
    result.line_load += w * (field_row(n, 2) + z * field_row(n, 8));
  }
  return result;
}

}  // namespace railstep
