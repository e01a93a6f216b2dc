#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "online/beam/beam.h"

namespace railstep {

/// Nonlinear beams between nodes of nine unknowns, and linear springs between points of them.
/// Unknowns q are positions and slopes, node after node; others (of sleepers, say) follow.
struct Structure {
  struct Element {
    int law;                  // among `laws`
    std::array<int, 3> node;  // at xi = -1, 0, +1
  };
  /// Energy k d^2 / 2 of d = row (q - rest).
  struct Spring {
    Eigen::SparseVector<double> row;  // [unknowns]
    double stiffness;                 // N/m, or N m/rad
  };
  Eigen::VectorXd rest;    // [unknowns]
  std::vector<bool> held;  // [unknowns]
  std::vector<Beam> laws;
  std::vector<Element> elements;
  std::vector<Spring> springs = {};
  double slope_length =
      .1;  // m, half a section's height: what makes a slope comparable to a length

  int unknowns() const { return static_cast<int>(rest.size()); }
  int nodes() const;  // those of the elements
};

/// Nodes of a chain of `elements` alike elements in a row, n of the first being 2 n.
std::vector<Structure::Element> chain(int elements, int first_node = 0, int law = 0);

/// dU/dq, [unknowns].
Eigen::VectorXd internal_force(const Structure& structure, const Eigen::VectorXd& q);

/// d2U/dq2, both triangles. Its sparsity is the same for every q.
Eigen::SparseMatrix<double> tangent(const Structure& structure, const Eigen::VectorXd& q);

/// The rows and columns of the unknowns that are not held.
Eigen::SparseMatrix<double> free_part(const Structure& structure,
                                      const Eigen::SparseMatrix<double>& matrix);
Eigen::VectorXd free_part(const Structure& structure, const Eigen::VectorXd& vector);

}  // namespace railstep
