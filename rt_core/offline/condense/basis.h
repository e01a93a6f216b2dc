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
  /// Static flexibility of the stepped model, [kept][kept]; empty if it is omega^-2, as for all
  /// kinds except truncated damped modes.
  Eigen::MatrixXd flexibility = {};
  /// Velocity that a force causes at once, beyond the rate of the modes, [kept][kept], 1/kg; empty
  /// if flexibility is empty.
  Eigen::MatrixXd at_once = {};

  /// Static y under constant forces shapes' f; [kept][any].
  Eigen::MatrixXd static_response(const Eigen::MatrixXd& forces) const;
  /// The stepped model's part of the static displacement y = omega^-2 p in all coordinates: y
  /// itself, or static_response(p) if modes are truncated.
  Eigen::VectorXd modelled(const Eigen::VectorXd& y) const;
};

/// The same coordinates with springs closed that were open when the coordinates were chosen: the
/// flexibility is (omega^2 + shapes' springs shapes)^-1.
/// @param springs  [unknowns][unknowns] of the line, N/m, symmetric, none below 0
/// @param basis    whose flexibility is omega^-2
Basis with_springs(Basis basis, const Eigen::SparseMatrix<double>& springs);

/// Throws Refused if the lowest mode of a line is rigid (below 1e-3 Hz): it has no static answer.
void refuse_free_mode(double lowest_hz);

/// Galerkin's coordinates over the span of some shapes; shapes that nearly depend on others are
/// dropped. Real shapes over symmetric matrices make no energy, whatever is left out.
/// @param shapes [unknowns][any]
/// Throws Refused on a free rigid mode, and if nothing is left.
Basis ritz_basis(const Line& line, const Eigen::MatrixXd& shapes);

/// Part of the static shapes K^-1 f of forces that kept shapes do not span; orthonormal over the
/// mass.
/// @param kept    [unknowns][kept], orthonormal over the mass
/// @param forces  [unknowns][any]
Eigen::MatrixXd added_static_shapes(const Line& line, const Eigen::MatrixXd& kept,
                                    const Eigen::MatrixXd& forces);

/// Forces of the dampers of seats, one column each; those spread over zones at the ends are left
/// out, as they are many and each too weak to have a shape of its own.
Eigen::MatrixXd damper_forces(const Line& line);

/// Columns of a matrix that are not 0.
/// @param rows  of the result, whose argument may have no entries at all
Eigen::MatrixXd filled_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index rows);

}  // namespace railstep
