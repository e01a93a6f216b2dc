#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <cmath>
#include <vector>

#include "offline/beam/structure.h"
#include "offline/element/matrices.h"

namespace railstep {

inline std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

/// A straight beam along x from the origin that stays in the x-z plane, 5 unknowns per node: r_x,
/// r_z, the section's b_x, b_z, and its width a_y.
struct PlanarBeam {
  Structure structure;
  Eigen::SparseMatrix<double> mass;  // [unknowns] square, constant
  BeamSection section;
  Material material;
  double length;
};

inline PlanarBeam planar_beam(const BeamSection& section, const Material& material, double length,
                              int elements) {
  const double part = length / elements;
  const BeamLaw law = beam_law(section, material);
  PlanarBeam b{{}, {}, section, material, length};
  Structure& s = b.structure;
  s.elements = chain(elements);
  s.laws = {beam_element(law, straight_nodes(part))};
  const int nodes = 2 * elements + 1;
  s.rest = Eigen::VectorXd::Zero(9 * nodes);
  s.held.assign(index_of(9 * nodes), false);
  for (int n = 0; n < nodes; ++n) {
    s.rest[9 * n] = .5 * part * n;
    s.rest[9 * n + 4] = s.rest[9 * n + 8] = 1.;
    for (const int out : {1, 3, 5, 7}) s.held[index_of(9 * n + out)] = true;
  }
  const Matrix27 element = element_matrices(section, law, part).mass;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Structure::Element& e : s.elements)
    for (int i = 0; i < 27; ++i)
      for (int j = 0; j < 27; ++j)
        if (element(i, j) != 0.)
          entries.emplace_back(9 * e.node[0] + i, 9 * e.node[0] + j, element(i, j));
  b.mass.resize(9 * nodes, 9 * nodes);
  b.mass.setFromTriplets(entries.begin(), entries.end());
  return b;
}

/// Holds the first node's position and, if clamped, its section.
inline PlanarBeam hubbed(PlanarBeam b, bool clamped) {
  for (const int i : {0, 2}) b.structure.held[index_of(i)] = true;
  if (clamped)
    for (const int i : {4, 6, 8}) b.structure.held[index_of(i)] = true;
  return b;
}

/// Section and material of the spin-up beam: by its A and I a rectangle 36.8 mm x 1.99 mm that
/// rotates in its stiff plane. It is the standard scene of Wu and Haug (1988) after Kane, Ryan and
/// Banerjee (1987). nu and the shear factor are not given; here they are 0.3 and Cowper's .8497, as
/// the beam is 754 radii of gyration long.
inline constexpr double kSpinUpLength = 8.;  // m
inline PlanarBeam spin_up_beam(int elements) {
  const BeamSection section = {.area = 7.299e-5,
                               .inertia_y = 8.218e-9,
                               .inertia_z = std::pow(7.299e-5, 4) / (144. * 8.218e-9),
                               .torsion = 9.3e-11,
                               .shear_factor_y = .8497,
                               .shear_factor_z = .8497};
  const Material material = {.young = 6.895e10, .poisson = .3, .density = 2766.67};
  return planar_beam(section, material, kSpinUpLength, elements);
}

/// Unknowns that are not held.
inline std::vector<int> free_list(const Structure& s) {
  std::vector<int> free;
  for (int i = 0; i < s.unknowns(); ++i)
    if (!s.held[index_of(i)]) free.push_back(i);
  return free;
}

/// Nodal forces of gravity (m/s2, in the plane): M times a uniform acceleration.
inline Eigen::VectorXd gravity_load(const PlanarBeam& b, const Eigen::Vector2d& gravity) {
  Eigen::VectorXd uniform = Eigen::VectorXd::Zero(b.structure.unknowns());
  for (int i = 0; i < uniform.size(); i += 9) {
    uniform[i] = gravity[0];
    uniform[i + 2] = gravity[1];
  }
  return b.mass * uniform;
}

/// Elastic modes of a planar beam at rest as it is held: the lowest in bending, then the lowest
/// along the axis. Nodal, [unknowns][bending + axial], of unit modal mass.
inline Eigen::MatrixXd planar_modes(const PlanarBeam& b, int bending, int axial) {
  const Structure& s = b.structure;
  const std::vector<int> free = free_list(s);
  const Eigen::MatrixXd M(free_part(s, b.mass)), K(free_part(s, tangent(s, s.rest)));
  // Largest eigenvalues of M x = (K + shift M) x / (w^2 + shift), so the lowest frequencies keep
  // their digits.
  const double shift = b.material.young * b.section.inertia_y /
                       (b.material.density * b.section.area * std::pow(b.length, 4));
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> found(M, K + shift * M);
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(s.unknowns(), bending + axial);
  int at[2] = {0, bending};
  const int end[2] = {bending, bending + axial};
  for (Eigen::Index k = M.rows() - 1; k >= 0; --k) {
    const double inverse = found.eigenvalues()[k];
    if (1. / inverse < 2. * shift) continue;  // rigid; the lowest bending mode has 12.4 and more
    Eigen::VectorXd mode = Eigen::VectorXd::Zero(s.unknowns());
    for (std::size_t i = 0; i < free.size(); ++i)
      mode[free[i]] = found.eigenvectors()(static_cast<int>(i), k) / std::sqrt(inverse);
    double along = 0., across = 0.;
    for (int i = 0; i < mode.size(); i += 9) {
      along += mode[i] * mode[i];
      across += mode[i + 2] * mode[i + 2];
    }
    const int kind = along > across ? 1 : 0;
    if (at[kind] < end[kind]) modes.col(at[kind]++) = mode;
  }
  return modes;
}

}  // namespace railstep
