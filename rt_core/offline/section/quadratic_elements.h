#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "offline/section/section_mesh.h"

namespace railstep {

/// Conforming six-node (quadratic) triangles with straight edges on half a section.
struct QuadraticElements {
  Eigen::Matrix2Xd nodes;                    // y, z per node, m
  std::vector<std::array<int, 6>> elements;  // 3 corners, then the middles of edges 01, 12, 20
  std::vector<bool> on_axis;                 // per node: y = 0
  std::vector<bool> on_outline;              // per node: on the stress-free boundary
};

/// Adds the edges' middles.
QuadraticElements make_quadratic(const SectionMesh& mesh);

/// One integration point of one element.
struct QuadraturePoint {
  double y, z, area;                  // m, m, m2 (weight times the triangle's area)
  Eigen::Matrix<double, 6, 1> shape;  // 1
  Eigen::Matrix<double, 6, 2> slope;  // d shape/dy, d shape/dz, 1/m
};

/// The six points of a triangle that integrate polynomials of degree 4 exactly (Dunavant 1985,
/// Int. J. Numer. Meth. Eng. 21, 1129).
std::array<QuadraturePoint, 6> quadrature(const QuadraticElements& mesh, std::size_t element);

/// int grad N_i . grad N_j dA, [nodes x nodes].
Eigen::SparseMatrix<double> laplacian(const QuadraticElements& mesh);

/// Solves K u = load with u = 0 at the fixed nodes (their rows are left out).
/// @throws Refused when the remaining matrix is singular
Eigen::MatrixXd solve_fixed(const Eigen::SparseMatrix<double>& K, const std::vector<bool>& fixed,
                            const Eigen::MatrixXd& load);

}  // namespace railstep
