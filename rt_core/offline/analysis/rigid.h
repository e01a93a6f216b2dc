#pragma once
#include <Eigen/SparseCore>

namespace railstep {

/// Whether a shape strains the stiffness by no more than rounding: x* K x <= 1e-13 |x|' |K| |x|.
/// (Rounding leaves some 1e-16; the first bending mode of a free rail of 1000 elements has 5e-11.)
bool is_rigid(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXcd& shape);

/// The free rigid modes, all of frequency 0: shapes R with R' M R = I and K R = 0 to rounding;
/// [unknowns][modes], no column where everything is held. By block inverse iteration, so that
/// equal eigenvalues are found together.
/// @param mass positive definite
Eigen::MatrixXd rigid_modes(const Eigen::SparseMatrix<double>& stiffness,
                            const Eigen::SparseMatrix<double>& mass);

/// The same numbers on every machine: uniform in [-1, 1], a linear congruential sequence.
Eigen::MatrixXd start_block(Eigen::Index rows, Eigen::Index columns);

}  // namespace railstep
