#pragma once
#include <Eigen/SparseCore>

#include "offline/pack/pack.h"

namespace railstep {

/// A line's coordinates in one state, and the products that its energies need. The coordinates of a
/// banded line are its unknowns, M u'' + C u' + K u = f. Those of a condensed line are y of
/// u = shapes y, with M = I, C = D, K = Omega^2.
struct LineMotion {
  Eigen::VectorXd u, v, g;     // [coordinates] displacement, velocity, true acceleration
  Eigen::VectorXd Mv, Mg, Cv;  // [coordinates]
  double kinetic = 0.;         // v' M v / 2, J
  double strain = 0.;          // u' K u / 2, J
  double power = 0.;           // v' C v, W: dissipation by dampers
};

/// Energies of one line of a model, by the matrices that the model was packed from.
class LineEnergy {
 public:
  /// @param line  the line in the model that is stepped
  LineEnergy(const PackedLine& own, const Model& model, const LineModel& line);

  LineMotion motion(const State& state) const;
  /// Work of constant forces (the track's weight), J; exact.
  double constant_work(const LineMotion& before, const LineMotion& after) const;
  /// Energy that the scheme takes out of the line in a step, J. With bars for means over the step
  /// and the loads' work as fbar' du, the identity
  ///   d(T + V) = fbar' du - dt/2 (v0' C v0 + v1' C v1) - loss,
  ///   loss = eu' (M gbar + C vbar) - vbar' M ev - dt/4 dv' C dv,
  ///   eu = du - dt vbar,  ev = dv - dt gbar
  /// is exact for every scheme that satisfies M g + C v + K u = f at both ends of a step. Condensed
  /// lines are solved exactly: 0.
  double loss(const LineMotion& before, const LineMotion& after, double dt) const;
  /// f - M g - C v - K u, N: the forces that are out of balance at a start.
  /// @param force  [unknowns of the model] on banded lines
  Eigen::VectorXd unbalanced(const LineMotion& at, const double* force) const;

 private:
  bool condensed_;
  Eigen::Index first_;  // of its unknowns among the state's
  Eigen::SparseMatrix<double> mass_, damping_, stiffness_;
  Eigen::VectorXd constant_;                  // N; empty: 0
  Eigen::SparseMatrix<double> shape_, rate_;  // [kept][2 modes] y and y' of [u, v]
};

}  // namespace railstep
