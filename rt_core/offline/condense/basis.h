#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "offline/condense/shapes.h"
#include "offline/track/track.h"

namespace railstep {

/// A line in fewer coordinates: u = shapes y, with shapes' M shapes = I and
/// shapes' K shapes = diag(omega^2).
struct Basis {
  Eigen::VectorXd omega;  // [kept] rad/s, above 0, ascending
  Shapes shapes;          // [unknowns of the line][kept]
  /// Static flexibility of the stepped model, [kept][kept]; empty where that is omega^-2, as of all
  /// but truncated damped modes.
  Eigen::MatrixXd flexibility = {};
  /// Velocity that a force has at once beside the rate of the modes, [kept][kept], 1/kg; empty
  /// beside an empty flexibility.
  Eigen::MatrixXd at_once = {};

  /// The y under forces shapes' f that stand still; [kept][any].
  Eigen::MatrixXd static_response(const Eigen::MatrixXd& forces) const;
  /// The stepped model's part of y = omega^-2 p, the static displacement in all coordinates: y
  /// itself, or where modes are truncated static_response(p).
  Eigen::VectorXd modelled(const Eigen::VectorXd& y) const;
};

/// The same coordinates where springs are closed that were open as they were chosen: the
/// flexibility is (omega^2 + shapes' springs shapes)^-1.
/// @param springs  [unknowns][unknowns] of the line, N/m, symmetric, none below 0
/// @param basis    whose flexibility is omega^-2
Basis with_springs(Basis basis, const Eigen::SparseMatrix<double>& springs);

/// Throws Refused where the lowest mode of a line is rigid (below 1e-3 Hz): it has no
/// static answer.
void refuse_free_mode(double lowest_hz);

/// Galerkin's coordinates over all that some shapes span; what nearly depends on others is dropped.
/// Real shapes over symmetric matrices: no energy is made, whatever is left out.
/// @param shapes [unknowns][any]
/// Throws Refused on a free rigid mode, and where nothing is left.
Basis ritz_basis(const Line& line, const Eigen::MatrixXd& shapes);

/// What the static shapes K^-1 f of forces add to shapes that are kept; orthonormal over the mass.
/// @param kept    [unknowns][kept], orthonormal over the mass
/// @param forces  [unknowns][any]
Eigen::MatrixXd added_static_shapes(const Line& line, const Eigen::MatrixXd& kept,
                                    const Eigen::MatrixXd& forces);

/// Forces of the dampers of seats, one column each; those spread over zones at the ends are left
/// out, as they are many and each too weak to have a shape of its own.
Eigen::MatrixXd damper_forces(const Line& line);

/// Columns of a matrix that hold anything.
/// @param rows  of the result, whose argument may have no entries at all
Eigen::MatrixXd filled_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index rows);

}  // namespace railstep
